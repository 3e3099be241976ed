# SPDX-License-Identifier: BSD-3-Clause
"""The origin of the estimate's NED frame, beginning and end of aiding by GPS, and the jumps that go with them."""

from __future__ import annotations

from typing import NamedTuple

from ...core.algebra import ZERO2, horizontal, with_down
from ...core.geodesy import offset_ne
from ...core.kernels import law
from ...core.vectors import Vec2
from ..events import Events, emit
from ..gps_receivers import Fix
from ..state import Estimate
from . import noise
from .covariance import clear
from .estimator_events import EKF_ORIGIN_SET, EKF_STOPPED_GPS, EKF_USES_GPS
from .history import shift
from .magnetometer import learn_field
from .state import POS, VEL, Ekf


class Origin(NamedTuple):
    """Where the position is zero."""

    lat: int  # [degE7]
    lon: int  # [degE7]
    alt: float  # above mean sea level [m]


@law
def write_origin(ekf: Ekf, estimate: Estimate, log: Events, origin: Origin) -> None:
    """Set the origin."""
    estimate.origin_lat, estimate.origin_lon, estimate.origin_alt = origin.lat, origin.lon, origin.alt
    estimate.origin_set = True
    learn_field(ekf, estimate, origin.lat, origin.lon)
    emit(log, ekf.now_us, EKF_ORIGIN_SET, float(ekf.imu), 0.0)


@law
def set_origin(ekf: Ekf, estimate: Estimate, log: Events, origin: Origin) -> bool:
    """Origin given by a ground station (SET_GPS_GLOBAL_ORIGIN); whether it is taken: not when there is one already."""
    if estimate.origin_set or abs(origin.lat) > 900000000 or abs(origin.lon) > 1800000000 or not abs(origin.alt) < 1e5:
        return False
    write_origin(ekf, estimate, log, origin)
    return True


@law
def reset_ne(ekf: Ekf, estimate: Estimate, pos: Vec2, vel: Vec2) -> None:
    """Jump to a horizontal position [m] and velocity [m/s]."""
    dp, dv = pos - horizontal(ekf.pos), vel - horizontal(ekf.vel)
    shift(ekf, with_down(dp, 0.0), with_down(dv, 0.0))
    ekf.pos = with_down(pos, ekf.pos.z)
    ekf.vel = with_down(vel, ekf.vel.z)
    ekf.lag_pos = with_down(ZERO2, ekf.lag_pos.z)
    ekf.lag_vel = with_down(ZERO2, ekf.lag_vel.z)
    clear(ekf.P, POS, 2, noise.INITIAL_POSITION * noise.INITIAL_POSITION)
    clear(ekf.P, VEL, 2, noise.INITIAL_VELOCITY * noise.INITIAL_VELOCITY)
    estimate.reset_pos = with_down(pos - horizontal(estimate.pos), estimate.reset_pos.z)
    estimate.reset_vel = with_down(vel - horizontal(estimate.vel), estimate.reset_vel.z)
    estimate.reset_ne_count += 1


@law
def fix_ne(estimate: Estimate, fix: Fix) -> Vec2:
    """Horizontal position [m] of the fix."""
    return offset_ne(estimate.origin_lat, estimate.origin_lon, fix.gps_lat, fix.gps_lon)


@law
def reset_to_fix(ekf: Ekf, estimate: Estimate, fix: Fix, age: float) -> None:
    """Jump to the fix, which is ``age`` [s] old."""
    vel = 0.01 * horizontal(fix.gps_vel)
    reset_ne(ekf, estimate, fix_ne(estimate, fix) + age * vel, vel)


@law
def start_using(ekf: Ekf, estimate: Estimate, log: Events, fix: Fix, age: float) -> None:
    """From holding the position to GPS, whose fix is ``age`` [s] old."""
    reset_to_fix(ekf, estimate, fix, age)
    ekf.absolute = True
    ekf.relative = False
    ekf.gps_used_before = True
    ekf.pos_fused_us = ekf.now_us
    ekf.vel_fused_us = ekf.now_us
    ekf.gps_passed_us = ekf.now_us
    ekf.gps_glitch = False
    emit(log, ekf.now_us, EKF_USES_GPS, float(ekf.imu), 0.0)


@law
def stop_using(ekf: Ekf, estimate: Estimate, log: Events) -> None:
    """From GPS to holding the position."""
    ekf.absolute = False
    ekf.hold_pos = horizontal(ekf.pos)
    estimate.variance_pos = 0.0
    estimate.variance_vel = 0.0
    reset_ne(ekf, estimate, ekf.hold_pos, ZERO2)
    emit(log, ekf.now_us, EKF_STOPPED_GPS, float(ekf.imu), 0.0)
