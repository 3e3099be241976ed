# SPDX-License-Identifier: BSD-3-Clause
"""Crash check: a vehicle that lies on its side and cannot right itself is disarmed (FS_CRASH_CHECK)."""

from __future__ import annotations

import math

from ...core.algebra import dot
from ...core.kernels import inlined
from ...core.vectors import Vec3
from ..arming_checks import BY_CRASH
from ..events import CRASH_DISARM, emit
from . import landing
from .control.state import AttitudeState
from .modes import ground
from .modes.state import LandingState
from .state import Vehicle

TRIGGER_TICKS = 800
"""2 s."""
ANGLE_ERROR_MAX = math.radians(30.0)
COS_LEAN_MIN = math.cos(math.radians(15.0))
ACCEL_MAX = 3.0  # [m/s^2]
SPEED_MAX = 10.0  # [m/s]


@inlined
def is_crashed(attitude: AttitudeState, detector: LandingState, vel: Vec3) -> bool:
    """Whether this tick looks like a crash: far off its lean, yet neither accelerating nor fast; ``vel`` [m/s]."""
    if attitude.cos_lean > COS_LEAN_MIN or attitude.thrust_error_angle <= ANGLE_ERROR_MAX:
        return False
    return landing.acceleration(detector) < ACCEL_MAX and dot(vel, vel) < SPEED_MAX * SPEED_MAX


@inlined
def check(v: Vehicle) -> None:
    """One tick: count, and disarm after two seconds."""
    ap = v.autopilot
    attitude, detector = ap.control.attitude, ap.modes.landing
    watched = ap.arming.armed and not ap.arming.landed and ap.params.FS.CRASH_CHECK >= 1.0
    crashed = watched and is_crashed(attitude, detector, ap.estimate.vel)
    ap.arming.crash_ticks = ap.arming.crash_ticks + 1 if crashed else 0
    if ap.arming.crash_ticks >= TRIGGER_TICKS:
        error = math.degrees(attitude.thrust_error_angle)
        emit(ap.events, v.time_us, CRASH_DISARM, error, landing.acceleration(detector))
        ground.disarm(v, BY_CRASH)


def text(angle_error_deg: float, acceleration: float) -> str:
    """Status text (MAV_SEVERITY_EMERGENCY) of CRASH_DISARM."""
    return f"Crash: Disarming: AngErr={angle_error_deg:.0f}>30, Accel={acceleration:.1f}<3.0"
