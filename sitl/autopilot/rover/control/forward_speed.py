# SPDX-License-Identifier: BSD-3-Clause
"""Speed along the vehicle's nose, and its turn rate, from whatever knows them.

In order: the estimator's horizontal velocity; the receiver's ground speed with the sign of its course against the
heading; the wheel encoders' mean (ArduPilot feeds those to its filter instead).
"""

from __future__ import annotations

from typing import NamedTuple

from ....core.algebra import direction, dot2, horizontal, norm2
from ....core.kernels import law
from ....core.mavlink import GpsFixType
from ....core.scalars import finite
from ....core.vectors import Quat, Vec2, Vec3
from ...control.pid import lowpass_gain
from ...estimation.status import VELOCITY_HORIZ
from ...state import Estimate, Sensors
from .state import SpeedState

WHEEL_HZ = 10.0
"""Low-pass of the encoders' speed."""
WHEEL_TIMEOUT_US = 500_000


class ForwardSpeed(NamedTuple):
    """Speed along the nose."""

    known: bool
    speed: float  # backward negative [m/s]


@law
def sense_wheels(s: SpeedState, sensors: Sensors, now_us: int) -> None:
    """Speed of the wheels from the distance that they rolled since the last sample."""
    if sensors.wheel_count != s.wheel_count:
        distance = 0.5 * (sensors.wheel_distance.x + sensors.wheel_distance.y)
        dt = float(now_us - s.wheel_us) * 1e-6
        if s.wheel_count == 0 or dt <= 0.0 or dt > 0.5:
            s.wheel_ok = False
            s.wheel = 0.0
        else:
            speed = (distance - s.wheel_distance) / dt
            gain = lowpass_gain(WHEEL_HZ, dt) if s.wheel_ok else 1.0
            s.wheel += gain * (speed - s.wheel)
            s.wheel_ok = True
        s.wheel_count = sensors.wheel_count
        s.wheel_us = now_us
        s.wheel_distance = distance
    elif now_us - s.wheel_us > WHEEL_TIMEOUT_US:
        s.wheel_ok = False


@law
def signed_ground_speed(vel: Vec2, nose: Vec2) -> float:
    """Length of a velocity [m/s], negative when it points away from the nose (a unit vector), both NE."""
    speed = norm2(vel)
    return -speed if dot2(vel, nose) < 0.0 else speed


@law
def estimate_forward_speed(s: SpeedState, estimate: Estimate, sensors: Sensors) -> ForwardSpeed:
    """Speed along the nose from the first source that knows it."""
    heading = estimate.yaw
    nose = direction(heading)
    known, speed = s.wheel_ok, s.wheel
    if estimate.status_flags & VELOCITY_HORIZ != 0:
        known, speed = True, dot2(horizontal(estimate.vel), nose)
    elif sensors.gps_fix >= GpsFixType.FIX_3D:
        known, speed = True, signed_ground_speed(horizontal(sensors.gps_vel) * 0.01, nose)
    if known and finite(speed):
        return ForwardSpeed(True, speed)
    return ForwardSpeed(False, 0.0)


@law
def sense(s: SpeedState, estimate: Estimate, sensors: Sensors, time_us: int) -> None:
    """Renew ``s.forward``; the first thing of a period, before any steering or speed law."""
    sense_wheels(s, sensors, time_us)
    forward = estimate_forward_speed(s, estimate, sensors)
    s.forward_ok = forward.known
    s.forward = forward.speed


@law
def yaw_rate(q: Quat, rates: Vec3) -> float:
    """Turn rate about the vertical [rad/s], right positive: the part of body ``rates`` along world z."""
    down = q.w * q.w - q.x * q.x - q.y * q.y + q.z * q.z
    return 2.0 * (q.x * q.z - q.w * q.y) * rates.x + 2.0 * (q.y * q.z + q.w * q.x) * rates.y + down * rates.z
