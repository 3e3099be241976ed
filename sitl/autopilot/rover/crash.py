# SPDX-License-Identifier: BSD-3-Clause
"""Crash and tilt check of the modes that drive by themselves (FS_CRASH_CHECK, CRASH_ANGLE).

Crashed is what neither moves nor turns for two seconds though the motors push, or leans too far.
"""

from __future__ import annotations

import math

from ...core.kernels import law
from ..arming_checks import BY_CRASH
from ..events import CRASH_HOLD, emit
from . import arming, motor_test
from .modes import set_mode
from .modes.numbers import HOLD, REASON_CRASH_FAILSAFE, is_autopilot

TRIGGER = 20
"""Tenths of a second."""
LEAST_THROTTLE = 0.05
LEAST_MOTION = 0.08  # [m/s] and [rad/s]
HOLD_AND_DISARM = 2.0
"""FS_CRASH_CHECK"""


@law
def is_leaning(ap):
    """Whether the vehicle leans further than CRASH_ANGLE."""
    most = math.radians(ap.params.CRASH_ANGLE)
    return most != 0.0 and (abs(ap.estimate.euler[0]) > most or abs(ap.estimate.euler[1]) > most)


@law
def is_blocked(ap):
    """Whether the motors push and nothing moves."""
    speed = math.hypot(ap.estimate.vel[0], ap.estimate.vel[1])
    if speed >= LEAST_MOTION or abs(ap.estimate.rates[2]) >= LEAST_MOTION:
        return False
    return abs(ap.control.motors.throttle) >= LEAST_THROTTLE


@law
def update(v):
    """Ten times a second."""
    ap = v.autopilot
    check = ap.params.FS.CRASH_CHECK
    watched = ap.arming.armed != 0 and check > 0.0 and is_autopilot(int(ap.modes.number))
    if not watched or motor_test.is_running(ap):
        ap.arming.crash_ticks = 0
        return
    leaning = is_leaning(ap)
    if not leaning and not is_blocked(ap):
        ap.arming.crash_ticks = 0
        return
    ap.arming.crash_ticks += 1
    if leaning or ap.arming.crash_ticks >= TRIGGER:
        ap.arming.crash_ticks = 0
        emit(ap.events, v.time_us, CRASH_HOLD, 0.0, 0.0)
        set_mode.request(v, HOLD, REASON_CRASH_FAILSAFE)
        if check == HOLD_AND_DISARM:
            arming.disarm(v, BY_CRASH, 1)
