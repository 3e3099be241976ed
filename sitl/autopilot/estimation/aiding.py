# SPDX-License-Identifier: BSD-3-Clause
"""Beginning and end of aiding by GPS, and the jumps of the horizontal state that go with them."""

from __future__ import annotations

from ...core.geodesy import offset_ne
from ...core.kernels import law
from ...core.vectors import Vec3
from .. import events
from . import noise
from .covariance import clear
from .history import shift
from .state import POS, VEL


@law
def reset_ne(ap, n, e, vn, ve):
    """Jump to a horizontal position [m] and velocity [m/s]."""
    ekf, estimate = ap.ekf, ap.estimate
    dn, de = n - ekf.pos[0], e - ekf.pos[1]
    dvn, dve = vn - ekf.vel[0], ve - ekf.vel[1]
    ekf.pos[0], ekf.pos[1], ekf.vel[0], ekf.vel[1] = n, e, vn, ve
    shift(ekf, 0, dn, dvn)
    shift(ekf, 1, de, dve)
    clear(ekf, POS, 2, noise.INITIAL_POSITION * noise.INITIAL_POSITION)
    clear(ekf, VEL, 2, noise.INITIAL_VELOCITY * noise.INITIAL_VELOCITY)
    for k in range(2):
        ekf.lag_pos[k] = 0.0
        ekf.lag_vel[k] = 0.0
    pos, vel = estimate.pos, estimate.vel
    estimate.reset_pos = Vec3(ekf.pos[0] - pos.x, ekf.pos[1] - pos.y, estimate.reset_pos.z)
    estimate.reset_vel = Vec3(ekf.vel[0] - vel.x, ekf.vel[1] - vel.y, estimate.reset_vel.z)
    estimate.reset_ne_count += 1


@law
def reset_to_fix(ap, sensors, age):
    """Jump to a fix of the given age [s]."""
    estimate = ap.estimate
    n, e = offset_ne(estimate.origin_lat, estimate.origin_lon, int(sensors.gps_lat), int(sensors.gps_lon))
    vn, ve = 0.01 * int(sensors.gps_vel[0]), 0.01 * int(sensors.gps_vel[1])
    reset_ne(ap, n + age * vn, e + age * ve, vn, ve)


@law
def start_using(ap, sensors, age, now_us):
    """From holding the position to GPS."""
    ekf = ap.ekf
    reset_to_fix(ap, sensors, age)
    ekf.gps_in_use = 1
    ekf.gps_used_before = 1
    ekf.gps_pos_fused_us = now_us
    ekf.gps_vel_fused_us = now_us
    events.emit(ap.events, now_us, events.EKF_USES_GPS, 0.0, 0.0)


@law
def stop_using(ap, now_us):
    """From GPS to holding the position."""
    ekf, estimate = ap.ekf, ap.estimate
    ekf.gps_in_use = 0
    ekf.hold_pos[0], ekf.hold_pos[1] = ekf.pos[0], ekf.pos[1]
    estimate.variance_pos = 0.0
    estimate.variance_vel = 0.0
    reset_ne(ap, ekf.pos[0], ekf.pos[1], 0.0, 0.0)
    events.emit(ap.events, now_us, events.EKF_STOPPED_GPS, 0.0, 0.0)
