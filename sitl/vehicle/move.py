# SPDX-License-Identifier: BSD-3-Clause
"""A prepared vehicle is put elsewhere, at another speed, in another wind, with other properties, within one instant.

Body, estimator, controllers, home and origin move as one: what the autopilot believes of the vehicle is as true as it
was. Time, modes, biases and what is learnt of them stay. The laws here put together what each subsystem has for itself
(``physics.native.displaced_body``, ``autopilot.displacement``, ``autopilot.estimation.displaced_filter``,
``autopilot.copter.displaced_targets`` ...).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple, TypeVar

from ..autopilot.state import Estimate
from ..core.algebra import euler_of, horizontal
from ..core.displacement import Displacement, displacement, goes_anywhere, moved_ne, turned
from ..core.geodesy import add_offset, offset_ne
from ..core.kernels import law
from ..core.memory import record_at
from ..core.records import Record
from ..core.scalars import wrap_pi
from ..core.vectors import Vec2, Vec3
from ..physics.native.displaced_body import is_inside, move_physics, set_wind
from ..physics.native.ranging import Ranging, list_around, look_again
from ..physics.native.records import Origin
from ..physics.native.tick import Clock
from .record import Vehicle

DONE, IN_SOLID, NO_HOVER = 0, 1, 2


class MoveOrder(Record):
    """Where one vehicle is put and how it is then; what is not said stays."""

    vehicle: int  # number in the fleet
    says_position: bool
    position: Vec2  # of the body's origin, from the world's origin or home, NE [m]
    says_height: bool
    height: float  # over the floor [m]
    says_heading: bool
    heading: float  # [rad]
    says_velocity: bool
    velocity: Vec3  # NED [m/s]
    says_wind: bool
    wind_speed: float  # [m/s]
    wind_direction: float  # where it comes from [deg]
    wind_turbulence: float  # standard deviation [m/s]
    other_properties: bool  # the airframe's properties have been changed in its record
    other_world: bool  # what the record says of solids and lidar readings is of another world
    result: int  # DONE, IN_SOLID or NO_HOVER: then the record is of no use


ORDER_SIZE = MoveOrder.dtype.itemsize
V = TypeVar("V", bound=Vehicle)


class Local(NamedTuple):
    """What becomes of the estimate's frame."""

    lat: int
    """Of its origin [degE7]."""
    lon: int
    displacement: Displacement
    """Of positions in it."""


@law
def ordered(v: Vehicle, order: MoveOrder) -> Displacement:
    """The displacement of positions in the world that an order asks for."""
    body = v.physics.body
    angle = wrap_pi(order.heading - euler_of(body.q).yaw) if order.says_heading else 0.0
    there = order.position if order.says_position else horizontal(body.pos)
    down = -order.height if order.says_height else body.pos.z
    still = Vec3(0.0, 0.0, 0.0)
    turn = displacement(angle, still, still)
    from_here = turned(turn, body.pos)
    shift = Vec3(there.x - from_here.x, there.y - from_here.y, down - from_here.z)
    velocity = order.velocity - turned(turn, body.vel) if order.says_velocity else still
    return displacement(angle, shift, velocity)


@law
def _nearest(x: float) -> int:
    return math.floor(x + 0.5)


@law
def of_estimate(ground: Origin, e: Estimate, d: Displacement) -> Local:
    """The displacement of the frame of an estimate: its origin goes along, on whole 1e-7 degrees."""
    origin = offset_ne(ground.lat, ground.lon, e.origin_lat, e.origin_lon)
    to = moved_ne(d, origin)
    found = add_offset(ground.lat, ground.lon, to.x, to.y)
    lat, lon = _nearest(found.lat), _nearest(found.lon)
    left = to - offset_ne(ground.lat, ground.lon, lat, lon)
    shift = Vec3(left.x, left.y, d.shift.z)
    return Local(lat, lon, Displacement(d.angle, d.cosine, d.sine, d.turn, shift, d.velocity))


@law
def move_frame(v: Vehicle, d: Displacement) -> Displacement:
    """Move the origin of the estimate, if it has one; the displacement of positions in its frame."""
    ap = v.autopilot
    e = ap.estimate
    if ap.ekf.use_external:
        return d
    if not e.origin_set:
        return displacement(d.angle, Vec3(0.0, 0.0, d.shift.z), d.velocity)
    local = of_estimate(v.physics.origin, e, d)
    e.origin_lat, e.origin_lon = local.lat, local.lon
    if ap.second_lane.runs != 0:
        ap.second_lane.estimate.origin_lat, ap.second_lane.estimate.origin_lon = local.lat, local.lon
    return local.displacement


@law
def change_wind(v: Vehicle, order: MoveOrder) -> None:
    """Set the wind, and the parameters that say it."""
    sim, wind = v.autopilot.params.SIM, v.physics.wind
    was = wind.turbulence
    sim.WIND_SPD, sim.WIND_DIR, sim.WIND_TURB = order.wind_speed, order.wind_direction, order.wind_turbulence
    wind.speed, wind.direction, wind.turbulence = sim.WIND_SPD, sim.WIND_DIR, sim.WIND_TURB
    set_wind(v.physics, was, v.rng)


@law
def is_calm(v: Vehicle) -> bool:
    """Whether no steady wind blows."""
    steady = v.physics.wind.steady
    return steady.x == 0.0 and steady.y == 0.0


@law
def look_around(v: Vehicle, ranging: int, order: MoveOrder, d: Displacement) -> bool:
    """List the solids near the vehicle and take its scans anew; False: it is in a solid."""
    if ranging == 0 or not (order.other_world or goes_anywhere(d)):
        return True
    r = record_at(Ranging, ranging)
    if v.physics.obstacles.present:
        list_around(v, r)
        if is_inside(v.physics.obstacles, v.physics.body, v.physics):
            return False
    look_again(v, r)
    return True


@law
def displace(v: V, order: MoveOrder, move_firmware: Callable[[V, Displacement], None]) -> Displacement:
    """Move physics and autopilot; says how positions in the world moved."""
    d = ordered(v, order)
    local = move_frame(v, d)
    move_physics(v.physics, v.sensors, d, Clock(v.tick, v.time_us))
    move_firmware(v, local)
    if order.says_wind:
        change_wind(v, order)
    return d
