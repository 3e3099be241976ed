# SPDX-License-Identifier: BSD-3-Clause
"""Speed along the vehicle's nose, and its turn rate, from whatever knows them.

In order: the estimator's horizontal velocity; the receiver's ground speed with the sign of its course against the
heading; the wheel encoders' mean (ArduPilot feeds those to its filter instead).
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.scalars import finite
from ...control.pid import lowpass_gain
from ...estimation.status import VELOCITY_HORIZ

FIX_3D = 3
_WHEEL_HZ = 10.0  # low-pass of the encoders' speed
_WHEEL_TIMEOUT_US = 500_000


@law
def _sense_wheels(v):
    s = v.autopilot.control.speed
    sensors = v.sensors
    count = int(sensors.wheel_count)
    now = int(v.time_us)
    if count != s.wheel_count:
        distance = 0.5 * (float(sensors.wheel_distance[0]) + float(sensors.wheel_distance[1]))
        dt = float(now - int(s.wheel_us)) * 1e-6
        if s.wheel_count == 0 or dt <= 0.0 or dt > 0.5:
            s.wheel_ok = 0
            s.wheel = 0.0
        else:
            speed = (distance - float(s.wheel_distance)) / dt
            gain = lowpass_gain(_WHEEL_HZ, dt) if s.wheel_ok != 0 else 1.0
            s.wheel += gain * (speed - float(s.wheel))
            s.wheel_ok = 1
        s.wheel_count = count
        s.wheel_us = now
        s.wheel_distance = distance
    elif now - int(s.wheel_us) > _WHEEL_TIMEOUT_US:
        s.wheel_ok = 0


@law
def sense(v):
    """Renew ``control.speed.forward``; the first thing of a period, before any steering or speed law."""
    ap = v.autopilot
    s = ap.control.speed
    est = ap.estimate
    heading = float(est.euler[2])
    cosine, sine = math.cos(heading), math.sin(heading)
    _sense_wheels(v)
    ok = 0
    speed = 0.0
    if int(est.status_flags) & VELOCITY_HORIZ != 0:
        ok = 1
        speed = float(est.vel[0]) * cosine + float(est.vel[1]) * sine
    elif int(v.sensors.gps_fix) >= FIX_3D:
        ok = 1
        north, east = float(v.sensors.gps_vel[0]) * 0.01, float(v.sensors.gps_vel[1]) * 0.01
        speed = math.sqrt(north * north + east * east)
        if north * cosine + east * sine < 0.0:
            speed = -speed
    elif s.wheel_ok != 0:
        ok = 1
        speed = float(s.wheel)
    if not finite(speed):
        ok = 0
        speed = 0.0
    s.forward_ok = ok
    s.forward = speed


@law
def forward_speed(v):
    """(known 0 or 1, speed along the nose [m/s])."""
    sense(v)
    return (int(v.autopilot.control.speed.forward_ok), float(v.autopilot.control.speed.forward))


@law
def yaw_rate(ap):
    """Turn rate about the vertical [rad/s], right positive: the body rates' part along world z."""
    q = ap.estimate.q
    w, x, y, z = float(q[0]), float(q[1]), float(q[2]), float(q[3])
    r = ap.estimate.rates
    down = w * w - x * x - y * y + z * z
    return 2.0 * (x * z - w * y) * float(r[0]) + 2.0 * (y * z + w * x) * float(r[1]) + down * float(r[2])
