# SPDX-License-Identifier: BSD-3-Clause
"""Crash and tilt check of the modes that drive by themselves (FS_CRASH_CHECK, CRASH_ANGLE).

Crashed is what neither moves nor turns for two seconds though the motors push, or leans too far.
"""

from __future__ import annotations

import math

from ...core.kernels import law
from ...core.vectors import Euler
from ..arming_checks import BY_CRASH
from ..events import CRASH_HOLD, emit
from ..modes import REASON_CRASH_FAILSAFE
from ..state import Estimate
from . import arming, motor_test
from .modes import set_mode
from .modes.hold import HOLD
from .modes.table import is_autonomous
from .state import Autopilot, Vehicle

TRIGGER = 20
"""Tenths of a second."""
THROTTLE_MIN = 0.05
MOTION_MIN = 0.08  # [m/s] and [rad/s]
HOLD_AND_DISARM = 2.0
"""FS_CRASH_CHECK"""


@law
def is_leaning(euler: Euler, angle_max: float) -> bool:
    """Whether the vehicle leans further than ``angle_max`` [rad]; 0: no lean counts."""
    return angle_max != 0.0 and (abs(euler.roll) > angle_max or abs(euler.pitch) > angle_max)


@law
def is_blocked(estimate: Estimate, throttle: float) -> bool:
    """Whether the motors push with ``throttle`` and nothing moves."""
    speed = math.hypot(estimate.vel.x, estimate.vel.y)
    if speed >= MOTION_MIN or abs(estimate.rates.z) >= MOTION_MIN:
        return False
    return abs(throttle) >= THROTTLE_MIN


@law
def is_watched(ap: Autopilot) -> bool:
    """Whether a crash counts now."""
    if not ap.arming.armed or ap.params.FS.CRASH_CHECK <= 0.0:
        return False
    return is_autonomous(ap.modes.number) and not motor_test.is_running(ap.control.motors)


@law
def update(v: Vehicle) -> None:
    """Ten times a second."""
    ap = v.autopilot
    leaning = is_leaning(ap.estimate.euler, math.radians(ap.params.CRASH_ANGLE))
    if not is_watched(ap) or not (leaning or is_blocked(ap.estimate, ap.control.motors.throttle)):
        ap.arming.crash_ticks = 0
        return
    ap.arming.crash_ticks += 1
    if leaning or ap.arming.crash_ticks >= TRIGGER:
        ap.arming.crash_ticks = 0
        emit(ap.events, v.time_us, CRASH_HOLD, 0.0, 0.0)
        set_mode.request(v, HOLD, REASON_CRASH_FAILSAFE)
        if ap.params.FS.CRASH_CHECK == HOLD_AND_DISARM:
            arming.disarm(v, BY_CRASH, True)
