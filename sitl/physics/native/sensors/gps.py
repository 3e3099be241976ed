# SPDX-License-Identifier: BSD-3-Clause
"""GPS receiver: a fix is taken at its rate and reaches the reader late; integers as in MAVLink's HIL_GPS.

Position error: white noise + slow drift (first-order Gauss-Markov: atmosphere, multipath); velocity: white
noise.
"""

from __future__ import annotations

import math

from ....core.geodesy import add_offset
from ....core.kernels import law
from ....core.rng import normal
from ....core.vectors import Vec3
from ..records import GPS_RING

UNKNOWN_DOP = 9999
"""HDOP * 100 of a receiver without a fix."""


@law
def _nearest(x):
    return math.floor(x + 0.5)


@law
def take(p, tick, rng):
    """Take a fix of the true position and send it on its way."""
    a, s, b, d = p.airframe, p.sensors, p.body, p.derived
    drift = s.gps_drift
    for j in range(3):
        drift[j] = float(d.gps_drift_decay) * float(drift[j]) + float(d.gps_drift_step) * normal(rng)
    scale = float(a.noise_scale)
    h, v = scale * float(a.gps_noise_horizontal), scale * float(a.gps_noise_vertical)
    slow_h, slow_v = scale * float(a.gps_drift_horizontal), scale * float(a.gps_drift_vertical)
    north = float(b.pos[0]) + slow_h * float(drift[0]) + h * normal(rng)
    east = float(b.pos[1]) + slow_h * float(drift[1]) + h * normal(rng)
    down = float(b.pos[2]) + slow_v * float(drift[2]) + v * normal(rng)
    h, v = scale * float(a.gps_velocity_noise_horizontal), scale * float(a.gps_velocity_noise_vertical)
    vel_n = float(b.vel[0]) + h * normal(rng)
    vel_e = float(b.vel[1]) + h * normal(rng)
    vel_d = float(b.vel[2]) + v * normal(rng)
    lat, lon = add_offset(float(p.place.lat), float(p.place.lon), north, east)
    k = int(s.gps_head) % GPS_RING
    s.gps_head += 1
    s.gps_due[k] = tick + int(d.gps_delay)
    s.gps_fix[k] = 3 if tick >= int(d.gps_fix) else 1
    s.gps_lat[k], s.gps_lon[k] = _nearest(lat), _nearest(lon)
    s.gps_alt[k] = _nearest((float(p.place.alt) - down) * 1000.0)
    s.gps_vel_n[k], s.gps_vel_e[k] = _nearest(vel_n * 100.0), _nearest(vel_e * 100.0)
    s.gps_vel_d[k] = _nearest(vel_d * 100.0)


@law
def deliver(p, sensors, tick, time_us):
    """Hand the oldest fix to the reader when its time has come."""
    s, a = p.sensors, p.airframe
    if int(s.gps_tail) == int(s.gps_head):
        return
    k = int(s.gps_tail) % GPS_RING
    if int(s.gps_due[k]) > tick:
        return
    s.gps_tail += 1
    sensors.gps_count += 1
    sensors.gps_time_us = time_us
    fix = int(s.gps_fix[k])
    sensors.gps_fix = fix
    if fix >= 3:
        sensors.gps_lat, sensors.gps_lon = int(s.gps_lat[k]), int(s.gps_lon[k])
        sensors.gps_alt = int(s.gps_alt[k])
        sensors.gps_vel = Vec3(int(s.gps_vel_n[k]), int(s.gps_vel_e[k]), int(s.gps_vel_d[k]))
        sensors.gps_eph = _nearest(100.0 * float(a.gps_hdop))
        sensors.gps_epv = _nearest(100.0 * float(a.gps_vdop))
        sensors.gps_satellites = int(a.gps_satellites)
    else:
        sensors.gps_eph = UNKNOWN_DOP
        sensors.gps_epv = UNKNOWN_DOP


@law
def update(p, sensors, tick, time_us, rng):
    """Take and deliver fixes as they fall due; a receiver that is switched off is missed at once."""
    d = p.derived
    if int(p.sensors.gps_off) != 0:
        p.sensors.gps_tail = p.sensors.gps_head
        sensors.gps_fix = 0
        sensors.gps_satellites = 0
        return
    if tick >= int(d.gps_start) and (tick - int(d.gps_start)) % int(d.gps_period) == 0:
        take(p, tick, rng)
    deliver(p, sensors, tick, time_us)
