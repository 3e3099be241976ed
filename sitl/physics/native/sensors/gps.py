# SPDX-License-Identifier: BSD-3-Clause
"""GPS receiver: a fix is taken at its rate and reaches the reader late; integers as in MAVLink's HIL_GPS.

Position error: white noise + slow drift (first-order Gauss-Markov: atmosphere, multipath); velocity: white
noise.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ....core.algebra import by_component
from ....core.border import Sensors
from ....core.geodesy import add_offset
from ....core.kernels import law
from ....core.rng import Rng, normal_vector, uniform
from ....core.vectors import Vec3
from ....vehicles.figures.body import Sensors as SensorFigures
from ..records import GPS_RING, Body, Derived, Fix, GpsFault, Physics, Place, SensorState
from ..tick import TICK_S, Clock

UNKNOWN_DOP = 9999
"""HDOP * 100 of a receiver without a fix."""
NO_FIX, FIX_3D = 1, 3
"""Of MAVLink's GPS_FIX_TYPE."""

JAM_SILENT_TICKS, JAM_SILENT_MORE_TICKS = 400, 2000
JAM_CHANGES = 0.3
"""Chance that a figure of a jammed receiver changes from fix to fix."""
JAM_PLACE, JAM_SPEED = 500.0, 150.0
"""Standard deviations of each axis [m, m/s]."""
JAM_SATELLITES, LEAST_SATELLITES = 17, 4
JAM_DOP = 30000.0
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
def measure(s: SensorState, body: Body, a: SensorFigures, d: Derived, rng: Rng) -> Measured:
    """Position and velocity with drift and noise."""
    scale = a.noise_scale
    s.gps_drift = d.gps_drift_decay * s.gps_drift + d.gps_drift_step * normal_vector(rng)
    slow = _axes(scale * a.gps_drift_horizontal, scale * a.gps_drift_vertical)
    noise = _axes(scale * a.gps_noise_horizontal, scale * a.gps_noise_vertical)
    pos = body.pos + by_component(slow, s.gps_drift) + by_component(noise, normal_vector(rng))
    noise = _axes(scale * a.gps_velocity_noise_horizontal, scale * a.gps_velocity_noise_vertical)
    return Measured(pos, body.vel + by_component(noise, normal_vector(rng)))


@law
def send(s: SensorState, place: Place, found: Measured, due: int, fix_type: int) -> None:
    """Send a fix on its way, to be delivered at tick ``due``."""
    pos, vel = found.pos, found.vel
    lat, lon = add_offset(place.lat, place.lon, pos.x, pos.y)
    fix = s.gps_fixes[s.gps_head % GPS_RING]
    s.gps_head += 1
    fix.due, fix.type, fix.jammed = due, fix_type, s.gps_jammed
    fix.lat, fix.lon = _nearest(lat), _nearest(lon)
    fix.alt = _nearest((place.alt - pos.z) * 1000.0)
    fix.vel = Vec3(_nearest(vel.x * 100.0), _nearest(vel.y * 100.0), _nearest(vel.z * 100.0))


@law
def drift_jammed(s: SensorState, tick: int, rng: Rng) -> int:
    """A jammed receiver's next fix, as ArduPilot's simulator has it: its type.

    At first nothing is received for one to six seconds; then satellites come and go, and place, speed and dilutions
    jump now and again.
    """
    if s.gps_jam_end == 0:
        s.gps_jam_end = tick + JAM_SILENT_TICKS + int(uniform(rng) * JAM_SILENT_MORE_TICKS)
    if tick < s.gps_jam_end:
        return NO_FIX
    jam = s.gps_jam
    if uniform(rng) < JAM_CHANGES:
        jam.pos = JAM_PLACE * normal_vector(rng)
    if uniform(rng) < JAM_CHANGES:
        jam.vel = JAM_SPEED * normal_vector(rng)
    if uniform(rng) < JAM_CHANGES:
        jam.satellites = int(uniform(rng) * JAM_SATELLITES)
        jam.eph = int(uniform(rng) * JAM_DOP)
        jam.epv = int(uniform(rng) * JAM_DOP)
    return FIX_3D if jam.satellites >= LEAST_SATELLITES else NO_FIX


FAST_WAVE, SLOW_WAVE = 0.5, 0.02
"""Of the altitude (SIM_GPS1_NOISE, SIM_GPS1_DRFTALT) [rad/s], in time since power-on."""


@law
def spoil(fix: Fix, fault: GpsFault, time: float) -> None:
    """Add what is wrong to a fix taken ``time`` [s] after power-on."""
    fix.lat += fault.lat
    fix.lon += fault.lon
    wave = fault.noise * math.sin(FAST_WAVE * time) + fault.drift * math.sin(SLOW_WAVE * time)
    fix.alt += _nearest(1000.0 * (fault.alt + wave))
    vel = fault.vel
    fix.vel += Vec3(_nearest(100.0 * vel.x), _nearest(100.0 * vel.y), _nearest(100.0 * vel.z))


@law
def take(p: Physics, tick: int, rng: Rng) -> None:
    """Take a fix of the true position and send it on its way; while GPS_RING fixes are on their way it takes none."""
    s, d, fault = p.sensors, p.derived, p.sensors.gps_fault
    if s.gps_head - s.gps_tail >= GPS_RING:
        return
    if fault.is_on and fault.loss > 0.0 and uniform(rng) < fault.loss:
        return
    found = measure(s, p.body, p.airframe, d, rng)
    fix_type = FIX_3D if tick >= d.gps_fix else NO_FIX
    if s.gps_jammed:
        fix_type = drift_jammed(s, tick, rng)
        found = Measured(found.pos + s.gps_jam.pos, s.gps_jam.vel)
    else:
        s.gps_jam_end = 0
    delay = fault.delay if fault.is_on and fault.delay >= 0 else d.gps_delay
    send(s, p.place, found, tick + delay, fix_type)
    if fault.is_on:
        spoil(s.gps_fixes[(s.gps_head - 1) % GPS_RING], fault, tick * TICK_S)


@law
def deliver(s: SensorState, sensors: Sensors, now: Clock, figures: SensorFigures) -> None:
    """Hand the oldest fix to the reader when its time has come."""
    if s.gps_tail == s.gps_head:
        return
    fix = s.gps_fixes[s.gps_tail % GPS_RING]
    if fix.due > now.tick:
        return
    s.gps_tail += 1
    sensors.gps_count += 1
    sensors.gps_time_us = now.time_us
    sensors.gps_fix = fix.type
    if fix.type >= FIX_3D:
        sensors.gps_lat, sensors.gps_lon, sensors.gps_alt = fix.lat, fix.lon, fix.alt
        sensors.gps_vel = fix.vel
        sensors.gps_eph = _nearest(100.0 * figures.gps_hdop)
        sensors.gps_epv = _nearest(100.0 * figures.gps_vdop)
        sensors.gps_satellites = int(figures.gps_satellites)
        if s.gps_fault.is_on and s.gps_fault.satellites >= 0:
            sensors.gps_satellites = s.gps_fault.satellites
        if fix.jammed:
            sensors.gps_eph, sensors.gps_epv = s.gps_jam.eph, s.gps_jam.epv
    else:
        sensors.gps_eph = UNKNOWN_DOP
        sensors.gps_epv = UNKNOWN_DOP
    if fix.jammed:
        sensors.gps_satellites = s.gps_jam.satellites


@law
def sample(p: Physics, sensors: Sensors, now: Clock, rng: Rng) -> None:
    """Take and deliver fixes as they fall due; a receiver that is switched off is missed at once."""
    s, d = p.sensors, p.derived
    if s.gps_off:
        s.gps_tail = s.gps_head
        sensors.gps_fix = 0
        sensors.gps_satellites = 0
        return
    if now.tick >= d.gps_start and (now.tick - d.gps_start) % d.gps_period == 0:
        take(p, now.tick, rng)
    deliver(s, sensors, now, p.airframe)
