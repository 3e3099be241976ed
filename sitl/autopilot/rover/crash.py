# SPDX-License-Identifier: BSD-3-Clause
"""Crash and tilt check of the modes that drive by themselves (FS_CRASH_CHECK, CRASH_ANGLE).

Crashed is what neither moves nor turns for two seconds though the motors push, or leans too far.
"""

from __future__ import annotations

import math

from ...core.elementary import hypot
from ...core.kernels import law
from ...core.mavlink import MavSeverity
from ...core.vectors import Euler
from ..arming_checks import ArmingMethod
from ..events import Event, emit, err
from ..log_events import LogErrorSubsystem
from ..modes import ModeReason
from ..state import Arming, Estimate
from . import motor_test
from .arming import set_disarmed
from .control.state import MotorsState
from .modes import set_mode
from .modes.hold import HOLD
from .modes.mode_list import is_autonomous
from .parameters.safety import Failsafes
from .state import Vehicle

TRIGGER = 20
"""Tenths of a second."""
THROTTLE_MIN = 0.05
MOTION_MIN = 0.08  # [m/s] and [rad/s]
HOLD_AND_DISARM = 2.0
"""FS_CRASH_CHECK"""

CRASH_HOLD = Event(
    24, MavSeverity.EMERGENCY, "Crash: Going to HOLD", log=err(LogErrorSubsystem.CRASH_CHECK, 1)
)  # crashed or blocked


@law
def is_leaning(euler: Euler, angle_max: float) -> bool:
    """Whether the vehicle leans further than ``angle_max`` [rad]; 0: no lean counts."""
    return angle_max != 0.0 and (abs(euler.roll) > angle_max or abs(euler.pitch) > angle_max)


@law
def is_blocked(estimate: Estimate, throttle: float) -> bool:
    """Whether the motors push with ``throttle`` and nothing moves."""
    speed = hypot(estimate.vel.x, estimate.vel.y)
    if speed >= MOTION_MIN or abs(estimate.rates.z) >= MOTION_MIN:
        return False
    return abs(throttle) >= THROTTLE_MIN


@law
def is_watched(mode: int, armed: bool, motors: MotorsState, params: Failsafes) -> bool:
    """Whether a crash counts now."""
    if not armed or params.CRASH_CHECK <= 0.0:
        return False
    return is_autonomous(mode) and not motor_test.is_running(motors)


@law
def detect_crash(arming: Arming, estimate: Estimate, throttle: float, angle_max: float) -> bool:
    """Ten times a second while watched: whether the vehicle has crashed; ``angle_max`` [rad], 0: no lean counts."""
    leaning = is_leaning(estimate.euler, angle_max)
    if not leaning and not is_blocked(estimate, throttle):
        arming.crash_ticks = 0
        return False
    arming.crash_ticks += 1
    if not leaning and arming.crash_ticks < TRIGGER:
        return False
    arming.crash_ticks = 0
    return True


@law
def check(v: Vehicle) -> None:
    """Ten times a second: HOLD after a crash, and disarm (FS_CRASH_CHECK)."""
    ap = v.autopilot
    m, p = ap.control.motors, ap.params
    if not is_watched(ap.modes.number, ap.arming.armed, m, p.FS):
        ap.arming.crash_ticks = 0
    elif detect_crash(ap.arming, ap.estimate, m.throttle, math.radians(p.CRASH_ANGLE)):
        emit(ap.events, v.time_us, CRASH_HOLD, 0.0, 0.0)
        set_mode.request(v, HOLD, ModeReason.CRASH_FAILSAFE)
        if p.FS.CRASH_CHECK == HOLD_AND_DISARM:
            set_disarmed(ap.arming, ap.events, v.time_us, ArmingMethod.CRASH)
