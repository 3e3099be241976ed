# SPDX-License-Identifier: BSD-3-Clause
"""The origin of the estimate's NED frame, beginning and end of aiding by GPS, and the jumps that go with them."""

from __future__ import annotations

from ...core.algebra import ZERO2, horizontal, with_down
from ...core.geodesy import offset_ne
from ...core.kernels import law
from ...core.vectors import Vec2
from .. import events
from ..state import Autopilot, Estimate, Sensors
from . import noise
from .covariance import clear
from .history import shift
from .magnetometer import learn_field
from .state import POS, VEL, Ekf


@law
def place_origin(ap: Autopilot, lat_e7: int, lon_e7: int, alt: float) -> None:
    """Set the origin: alt [m] is the height above mean sea level of the position zero."""
    estimate = ap.estimate
    estimate.origin_lat, estimate.origin_lon, estimate.origin_alt = lat_e7, lon_e7, alt
    estimate.origin_set = True
    learn_field(ap.ekf, estimate, lat_e7, lon_e7)
    events.emit(ap.events, ap.ekf.now_us, events.EKF_ORIGIN_SET, 0.0, 0.0)


@law
def set_origin(ap: Autopilot, lat_e7: int, lon_e7: int, alt_m: float) -> bool:
    """Origin given by a ground station (SET_GPS_GLOBAL_ORIGIN); whether it is taken: not when there is one already."""
    if ap.estimate.origin_set or abs(lat_e7) > 900000000 or abs(lon_e7) > 1800000000 or not abs(alt_m) < 1e5:
        return False
    place_origin(ap, int(lat_e7), int(lon_e7), float(alt_m))
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
def fix_ne(estimate: Estimate, sensors: Sensors) -> Vec2:
    """Horizontal position [m] of the fix."""
    return offset_ne(estimate.origin_lat, estimate.origin_lon, sensors.gps_lat, sensors.gps_lon)


@law
def reset_to_fix(ekf: Ekf, estimate: Estimate, sensors: Sensors, age: float) -> None:
    """Jump to the fix, which is ``age`` [s] old."""
    vel = 0.01 * horizontal(sensors.gps_vel)
    reset_ne(ekf, estimate, fix_ne(estimate, sensors) + age * vel, vel)


@law
def start_using(ap: Autopilot, sensors: Sensors, age: float) -> None:
    """From holding the position to GPS, whose fix is ``age`` [s] old."""
    ekf = ap.ekf
    reset_to_fix(ekf, ap.estimate, sensors, age)
    ekf.gps_in_use = True
    ekf.gps_used_before = True
    ekf.gps_pos_fused_us = ekf.now_us
    ekf.gps_vel_fused_us = ekf.now_us
    events.emit(ap.events, ekf.now_us, events.EKF_USES_GPS, 0.0, 0.0)


@law
def stop_using(ap: Autopilot) -> None:
    """From GPS to holding the position."""
    ekf, estimate = ap.ekf, ap.estimate
    ekf.gps_in_use = False
    ekf.hold_pos = horizontal(ekf.pos)
    estimate.variance_pos = 0.0
    estimate.variance_vel = 0.0
    reset_ne(ekf, estimate, ekf.hold_pos, ZERO2)
    events.emit(ap.events, ekf.now_us, events.EKF_STOPPED_GPS, 0.0, 0.0)
