# SPDX-License-Identifier: BSD-3-Clause
"""GPS receiver: a fix is taken at its rate and reaches the reader late; integers as in MAVLink's HIL_GPS.

Position error: white noise + slow drift (first-order Gauss-Markov: atmosphere, multipath); velocity: white
noise.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ....core.algebra import by_component
from ....core.border import GpsReading, Sensors
from ....core.constants import TICK_S
from ....core.elementary import sin
from ....core.geodesy import add_offset
from ....core.kernels import law
from ....core.mavlink import GpsFixType
from ....core.rng import Rng, normal_vector, uniform
from ....core.vectors import Vec3
from ....vehicles.properties.body import Sensors as SensorProperties
from ..records import GPS_RING, Body, Derived, Fix, GpsFault, GpsReceiver, Origin, Physics
from ..tick import Clock

UNKNOWN_DOP = 9999
"""HDOP * 100 of a receiver without a fix."""
EXACT = 0.02
"""A receiver with a smaller error than this [m] has fixed the carrier's phase, and says so."""
"""Of MAVLink's GPS_FIX_TYPE."""

JAM_SILENT_TICKS, JAM_SILENT_MORE_TICKS = 400, 2000
JAM_CHANGES = 0.3
"""Chance that a number of a jammed receiver changes from fix to fix."""
JAM_POSITION, JAM_SPEED = 500.0, 150.0
"""Standard deviations of each axis [m, m/s]."""
JAM_SATELLITES, LEAST_SATELLITES = 17, 4
JAM_DOP = 60000.0
"""Greatest dilution * 100."""


class Measured(NamedTuple):
    """What a receiver makes of the true position and velocity."""

    pos: Vec3  # NED [m]
    vel: Vec3  # NED [m/s]


@law
def _nearest(x: float) -> int:
    return math.floor(x + 0.5)


@law
def _axes(horizontal: float, vertical: float) -> Vec3:
    return Vec3(horizontal, horizontal, vertical)


@law
def measure(r: GpsReceiver, body: Body, a: SensorProperties, d: Derived, rng: Rng) -> Measured:
    """Position and velocity with drift and noise."""
    scale = a.noise_scale
    r.drift = d.gps_drift_decay * r.drift + d.gps_drift_step * normal_vector(rng)
    slow = _axes(scale * a.gps_drift_horizontal, scale * a.gps_drift_vertical)
    noise = _axes(scale * a.gps_noise_horizontal, scale * a.gps_noise_vertical)
    pos = body.pos + by_component(slow, r.drift) + by_component(noise, normal_vector(rng))
    noise = _axes(scale * a.gps_velocity_noise_horizontal, scale * a.gps_velocity_noise_vertical)
    return Measured(pos, body.vel + by_component(noise, normal_vector(rng)))


@law
def send(r: GpsReceiver, origin: Origin, found: Measured, due: int, fix_type: int) -> None:
    """Send a fix on its way, to be delivered at tick ``due``."""
    pos, vel = found.pos, found.vel
    lat, lon = add_offset(origin.lat, origin.lon, pos.x, pos.y)
    fix = r.fixes[r.head % GPS_RING]
    r.head += 1
    fix.due, fix.type, fix.jammed = due, fix_type, r.jammed
    fix.lat, fix.lon = _nearest(lat), _nearest(lon)
    fix.alt = _nearest((origin.alt - pos.z) * 1000.0)
    fix.vel = Vec3(_nearest(vel.x * 100.0), _nearest(vel.y * 100.0), _nearest(vel.z * 100.0))


@law
def drift_jammed(r: GpsReceiver, tick: int, rng: Rng) -> int:
    """A jammed receiver's next fix, as ArduPilot's simulator has it: its type.

    At first nothing is received for one to six seconds; then satellites come and go, and position, speed and dilutions
    jump now and again.
    """
    if r.jam_end == 0:
        r.jam_end = tick + JAM_SILENT_TICKS + int(uniform(rng) * JAM_SILENT_MORE_TICKS)
    if tick < r.jam_end:
        return GpsFixType.NO_FIX
    jam = r.jam
    if uniform(rng) < JAM_CHANGES:
        jam.pos = JAM_POSITION * normal_vector(rng)
    if uniform(rng) < JAM_CHANGES:
        jam.vel = JAM_SPEED * normal_vector(rng)
    if uniform(rng) < JAM_CHANGES:
        jam.satellites = int(uniform(rng) * JAM_SATELLITES)
        jam.eph = int(uniform(rng) * JAM_DOP)
        jam.epv = int(uniform(rng) * JAM_DOP)
    return GpsFixType.FIX_3D if jam.satellites >= LEAST_SATELLITES else GpsFixType.NO_FIX


FAST_WAVE, SLOW_WAVE = 0.5, 0.02
"""Of the altitude (SIM_GPS1_NOISE, SIM_GPS1_DRFTALT) [rad/s], in time since power-on."""


@law
def spoil(fix: Fix, fault: GpsFault, time: float) -> None:
    """Add what is wrong to a fix taken ``time`` [s] after power-on."""
    fix.lat += fault.lat
    fix.lon += fault.lon
    wave = fault.noise * sin(FAST_WAVE * time) + fault.drift * sin(SLOW_WAVE * time)
    fix.alt += _nearest(1000.0 * (fault.alt + wave))
    vel = fault.vel
    fix.vel += Vec3(_nearest(100.0 * vel.x), _nearest(100.0 * vel.y), _nearest(100.0 * vel.z))


@law
def take(p: Physics, r: GpsReceiver, tick: int, rng: Rng) -> None:
    """Take a fix of the true position and send it on its way; while GPS_RING fixes are on their way it takes none."""
    d, fault = p.derived, r.fault
    if r.head - r.tail >= GPS_RING:
        return
    if fault.is_on and fault.loss > 0.0 and uniform(rng) < fault.loss:
        return
    found = measure(r, p.body, p.airframe, d, rng)
    is_exact = p.airframe.gps_noise_horizontal + p.airframe.gps_drift_horizontal < EXACT
    best = GpsFixType.RTK_FIXED if is_exact else GpsFixType.FIX_3D
    fix_type: int = best if tick >= d.gps_fix else GpsFixType.NO_FIX
    if r.jammed:
        fix_type = drift_jammed(r, tick, rng)
        found = Measured(found.pos + r.jam.pos, r.jam.vel)
    else:
        r.jam_end = 0
    delay = fault.delay if fault.is_on and fault.delay >= 0 else d.gps_delay
    send(r, p.origin, found, tick + delay, fix_type)
    if fault.is_on:
        spoil(r.fixes[(r.head - 1) % GPS_RING], fault, tick * TICK_S)


@law
def deliver(r: GpsReceiver, shown: GpsReading, now: Clock, airframe: SensorProperties) -> None:
    """Hand the oldest fix to the reader when its time has come."""
    if r.tail == r.head:
        return
    fix = r.fixes[r.tail % GPS_RING]
    if fix.due > now.tick:
        return
    r.tail += 1
    shown.gps_count += 1
    shown.gps_time_us = now.time_us
    shown.gps_fix = fix.type
    if fix.type >= GpsFixType.FIX_3D:
        shown.gps_lat, shown.gps_lon, shown.gps_alt = fix.lat, fix.lon, fix.alt
        shown.gps_vel = fix.vel
        shown.gps_eph = _nearest(100.0 * airframe.gps_hdop)
        shown.gps_epv = _nearest(100.0 * airframe.gps_vdop)
        shown.gps_satellites = int(airframe.gps_satellites)
        if r.fault.is_on and r.fault.satellites >= 0:
            shown.gps_satellites = r.fault.satellites
        if fix.jammed:
            shown.gps_eph, shown.gps_epv = r.jam.eph, r.jam.epv
    else:
        shown.gps_eph = UNKNOWN_DOP
        shown.gps_epv = UNKNOWN_DOP
    if fix.jammed:
        shown.gps_satellites = r.jam.satellites


@law
def receive(p: Physics, r: GpsReceiver, shown: GpsReading, now: Clock, rng: Rng) -> None:
    """Take and deliver fixes as they fall due; a receiver that is switched off is missed at once."""
    d = p.derived
    if r.off:
        r.tail = r.head
        shown.gps_fix = 0
        shown.gps_satellites = 0
        return
    if now.tick >= d.gps_start and (now.tick - d.gps_start) % d.gps_period == 0:
        take(p, r, now.tick, rng)
    deliver(r, shown, now, p.airframe)


@law
def sample(p: Physics, sensors: Sensors, now: Clock, rng: Rng) -> None:
    """The receiver, and a second one where there is one."""
    receivers = p.sensors.gps
    receive(p, receivers[0], sensors, now, rng)
    if receivers[1].present:
        receive(p, receivers[1], sensors.gps2, now, rng)
