# SPDX-License-Identifier: BSD-3-Clause
"""How physics and autopilot of a vehicle go on together, tick by tick, until something needs Python.

A kind of vehicle has two entries made of these laws. ``advance(fleet, index, ticks)`` advances one vehicle by up to
``ticks`` ticks of 2500 us. It returns early, at the end of a tick in which something happened (``autopilot.events``),
or in which the vehicle came to the end of its list of solids. The border is crossed once a tick: physics writes
``sensors``, the autopilot reads them and writes ``actuators``. ``fly(fleet, index)`` is the autopilot's part of one
tick alone, behind other physics. With ``--estimator truth`` the simulator's truth stands in place of the Kalman
filter's output, for work on controllers.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

from ..autopilot.events import emit
from ..autopilot.hits import HIT_OBSTACLE
from ..autopilot.inertial_ring import remember
from ..autopilot.vibration import update_vibration
from ..core.kernels import inlined, law
from ..core.memory import fetch_ahead
from .landing_beacon import look
from .record import Vehicle

# EKF_STATUS_FLAGS: attitude, horizontal and vertical velocity, relative and absolute position, vertical position,
# predicted relative and absolute position.
_ALL_WELL = 1 | 2 | 4 | 8 | 16 | 32 | 256 | 512


@law
def observe(v: Vehicle) -> None:
    """Copy attitude, rates, velocity, position and acceleration of the body into the autopilot's estimate."""
    body, origin, e = v.physics.body, v.physics.origin, v.autopilot.estimate
    e.rates, e.vel, e.pos, e.acc_ned, e.q = body.rates, body.vel, body.pos, body.acc_ned, body.q
    e.origin_lat, e.origin_lon, e.origin_alt = origin.lat, origin.lon, origin.alt
    e.origin_set = True
    e.attitude_ok = True
    e.position_ok = True
    e.status_flags = _ALL_WELL


_LINE, _PART, _PARTS = 64, 22 * 64, 40
"""Bytes that come nearer at once, that do in a tick, and ticks until all have: 56 kB, about what a record has."""
V = TypeVar("V", bound=Vehicle)
Tick = Callable[[Sequence[V], int], None]
"""A unit or law that does its part of one tick of vehicle ``fleet[index]``."""


@law
def advance_ticks(fleet: Sequence[V], index: int, ticks: int, step: Tick[V], fly: Tick[V]) -> None:
    """Up to ``ticks`` ticks of physics (``step``) and of what follows (``fly``); back early when Python is needed."""
    v, events, following = fleet[index], fleet[index].autopilot.events, min(index + 1, len(fleet) - 1)
    before = events.count
    for _ in range(ticks):
        if following != index:
            fetch_part(fleet[following], v.tick)
        step(fleet, index)
        fly(fleet, index)
        if events.attention != 0 or events.count != before:
            break


@inlined
def fetch_part(v: Vehicle, tick: int) -> None:
    """Bring a part of a vehicle's record nearer, another one each tick: in a large fleet it lies in memory far away."""
    first = tick % _PARTS * _PART
    for k in range(first, first + _PART, _LINE):
        fetch_ahead(v, k)


@inlined
def fly_tick(fleet: Sequence[V], index: int, control: Tick[V]) -> None:
    """What follows a tick of physics: obstacles are reported, the firmware (``control``) goes from sensors to
    actuators."""
    vehicle = fleet[index]
    watch_obstacles(vehicle)
    if vehicle.autopilot.ekf.use_external != 0:
        observe(vehicle)
    if vehicle.autopilot.params.PLND.ENABLED != 0.0:
        look(vehicle)
    control(fleet, index)
    ap = vehicle.autopilot
    update_vibration(ap.vibration, ap.calibrated.acc)
    remember(ap.inertial, vehicle.time_us, ap.calibrated.acc, ap.calibrated.gyro, ap.estimate.q)


@inlined
def watch_obstacles(vehicle: Vehicle) -> None:
    """HIT_OBSTACLE when the vehicle ran into a solid in this tick; back to the shell for a new list of solids."""
    obstacles = vehicle.physics.obstacles
    if obstacles.hit_count > 0 and obstacles.hit_time_us == vehicle.time_us:
        emit(vehicle.autopilot.events, vehicle.time_us, HIT_OBSTACLE, float(obstacles.hit_speed), 0.0)
    if obstacles.wanted != 0:
        vehicle.autopilot.events.attention = True
