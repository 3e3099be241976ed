# SPDX-License-Identifier: BSD-3-Clause
"""The body is put elsewhere, with all that its sensors have on the way.

Errors of the receiver turn with the vehicle, as what the autopilot has made of them does; biases are the body's.
"""

from __future__ import annotations

import math

from ...core.algebra import rotate_inverse
from ...core.border import GpsReading, Sensors
from ...core.constants import TICK_S
from ...core.displacement import Displacement, faster, moved, turned, turned_attitude
from ...core.geodesy import add_offset, offset_ne
from ...core.kernels import law
from ...core.mavlink import GpsFixType
from ...core.rng import Rng, normal_vector
from ...core.vectors import Quat, Vec2, Vec3
from . import wind
from .atmosphere import pressure, set_air
from .obstacles import nearest
from .records import GPS_RING, Body, Fix, GpsReceiver, Obstacles, Origin, Physics
from .tick import Clock

INSIDE = 1e-6
"""A vehicle that overlaps a solid by this stands in it [m]."""


@law
def move_body(body: Body, d: Displacement) -> None:
    """Truth."""
    body.pos, body.vel, body.q = moved(d, body.pos), faster(d, body.vel), turned_attitude(d, body.q)
    body.acc_ned = turned(d, body.acc_ned)


@law
def _nearest(x: float) -> int:
    return math.floor(x + 0.5)


@law
def moved_fix(origin: Origin, d: Displacement, lat: float, lon: float, age: float) -> Vec2:
    """Latitude (x) and longitude (y) [degE7] of a fix that is ``age`` [s] old, in a frame with its origin at home."""
    there = offset_ne(origin.lat, origin.lon, lat, lon)
    to = moved(d, Vec3(there.x, there.y, 0.0)) - age * d.velocity
    found = add_offset(origin.lat, origin.lon, to.x, to.y)
    return Vec2(_nearest(found.lat), _nearest(found.lon))


@law
def moved_velocity(d: Displacement, vel: Vec3) -> Vec3:
    """Of a fix [cm/s], whole."""
    found = turned(d, vel) + 100.0 * d.velocity
    return Vec3(_nearest(found.x), _nearest(found.y), _nearest(found.z))


@law
def rise(d: Displacement, age: float) -> int:
    """How much higher a fix that is ``age`` [s] old is [mm]."""
    return _nearest(1000.0 * (age * d.velocity.z - d.shift.z))


@law
def move_fix(fix: Fix, origin: Origin, d: Displacement, age: float) -> None:
    """A fix on its way to the reader, ``age`` [s] old."""
    to = moved_fix(origin, d, fix.lat, fix.lon, age)
    fix.lat, fix.lon = int(to.x), int(to.y)
    fix.alt += rise(d, age)
    fix.vel = moved_velocity(d, fix.vel)


@law
def move_fixes(r: GpsReceiver, origin: Origin, d: Displacement, tick: int, delay: int) -> None:
    """All fixes on their way; ``delay`` of the receiver [ticks]."""
    r.drift = turned(d, r.drift)
    for n in range(r.tail, r.head):
        fix = r.fixes[n % GPS_RING]
        if fix.type >= GpsFixType.FIX_3D:
            move_fix(fix, origin, d, TICK_S * (tick - fix.due + delay))


@law
def move_delivered(shown: GpsReading, origin: Origin, d: Displacement, age: float) -> None:
    """The fix that the reader has, ``age`` [s] old."""
    if shown.gps_fix < GpsFixType.FIX_3D:
        return
    to = moved_fix(origin, d, shown.gps_lat, shown.gps_lon, age)
    shown.gps_lat, shown.gps_lon = int(to.x), int(to.y)
    shown.gps_alt += rise(d, age)
    shown.gps_vel = moved_velocity(d, shown.gps_vel)


@law
def move_receiver(r: GpsReceiver, shown: GpsReading, p: Physics, d: Displacement, now: Clock) -> None:
    """A receiver's fixes, delivered and on their way."""
    delay = p.derived.gps_delay
    move_fixes(r, p.origin, d, now.tick, delay)
    move_delivered(shown, p.origin, d, 1e-6 * (now.time_us - shown.gps_time_us) + TICK_S * delay)


@law
def move_air(p: Physics, sensors: Sensors, before: float) -> None:
    """Air and pressure of another height; ``before`` it was at so much above mean sea level [m]."""
    after = p.origin.alt - p.body.pos.z
    change = 0.01 * (pressure(after) - pressure(before))
    sensors.abs_pressure += change
    sensors.abs_pressure2 += change
    set_air(p.air, after)


@law
def move_physics(p: Physics, sensors: Sensors, d: Displacement, now: Clock) -> None:
    """Body and sensors are put elsewhere; solids are to be listed anew."""
    before = p.origin.alt - p.body.pos.z
    move_body(p.body, d)
    if d.shift.z != 0.0:
        move_air(p, sensors, before)
    receivers = p.sensors.gps
    move_receiver(receivers[0], sensors, p, d, now)
    if receivers[1].present:
        move_receiver(receivers[1], sensors.gps2, p, d, now)
    o = p.obstacles
    o.impulse = turned(d, o.impulse)
    o.wanted = o.present
    o.clear = 0.0


@law
def show_field(p: Physics, sensors: Sensors, before: Quat) -> None:
    """The magnetometers' last sample, after the attitude ``before`` has changed."""
    field = p.origin.field
    change = rotate_inverse(p.body.q, field) - rotate_inverse(before, field)
    sensors.mag += change
    sensors.mag2 += change
    sensors.mag3 += change


@law
def set_wind(p: Physics, turbulence_was: float, rng: Rng) -> None:
    """The wind blows as it is set, since long: gusts of another strength are drawn."""
    w = p.wind
    w.steady = wind.aim(w, -p.body.pos.z)
    if w.turbulence <= 0.0:
        w.gust = Vec3(0.0, 0.0, 0.0)
    elif w.turbulence != turbulence_was:
        w.gust = w.turbulence * normal_vector(rng)
    w.vel = w.steady + w.gust


@law
def is_inside(o: Obstacles, body: Body, p: Physics) -> bool:
    """Whether the vehicle overlaps one of the solids listed."""
    for k in range(p.airframe.contact_discs):  # noqa: SIM110 - laws know no generators
        if nearest(body, o, p.airframe, k).distance < -INSIDE:
            return True
    return False
