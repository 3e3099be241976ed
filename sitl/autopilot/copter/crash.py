# SPDX-License-Identifier: BSD-3-Clause
"""Crash check (FS_CRASH_CHECK): a vehicle is disarmed that lies on its side and cannot right itself.

So is one that has come down level, as with a dead motor, and is asked for a lean that it does not take: motors at their
least lift nothing, so what does not move for five seconds then lies on the ground. In the air it would fall.
"""

from __future__ import annotations

import math

from ...core.algebra import dot
from ...core.elementary import cos
from ...core.kernels import inlined
from ...core.mavlink import MavSeverity
from ...core.vectors import Vec3
from ..arming_checks import ArmingMethod
from ..events import Event, emit, err
from ..log_events import LogErrorSubsystem
from ..state import Estimate
from . import landing
from .control.state import AttitudeState, MotorsState
from .modes import ground
from .modes.state import LandingState
from .state import Vehicle

TRIGGER_TICKS = 800
"""2 s."""
ANGLE_ERROR_MAX = math.radians(30.0)
COS_LEAN_MIN = cos(math.radians(15.0))
ACCEL_MAX = 3.0  # [m/s^2]
SPEED_MAX = 10.0  # [m/s]
STILL_TICKS = 2000
"""5 s."""
STILL_ACCEL, STILL_SPEED, STILL_RATE = 0.5, 0.3, math.radians(3.0)
"""What counts as no movement [m/s^2], [m/s], [rad/s]."""

CRASH_DISARM = Event(
    8,
    MavSeverity.CRITICAL,
    "Crash: Disarming: AngErr={a:.0f}>30, Accel={b:.1f}<3.0",
    log=err(LogErrorSubsystem.CRASH_CHECK, 1),
)


@inlined
def is_crashed(attitude: AttitudeState, detector: LandingState, vel: Vec3) -> bool:
    """Whether this tick looks like a crash: far off its lean, yet neither accelerating nor fast; ``vel`` [m/s]."""
    if attitude.cos_lean > COS_LEAN_MIN or attitude.thrust_error_angle <= ANGLE_ERROR_MAX:
        return False
    return landing.acceleration(detector) < ACCEL_MAX and dot(vel, vel) < SPEED_MAX * SPEED_MAX


@inlined
def lies_still(motors: MotorsState, attitude: AttitudeState, detector: LandingState, estimate: Estimate) -> bool:
    """Whether nothing moves with motors at their least, although the vehicle leans otherwise than it is asked to."""
    if not motors.limit_throttle_lower or not landing.leans_far(attitude):
        return False
    if landing.acceleration(detector) > STILL_ACCEL or dot(estimate.rates, estimate.rates) > STILL_RATE * STILL_RATE:
        return False
    return dot(estimate.vel, estimate.vel) < STILL_SPEED * STILL_SPEED


@inlined
def check(v: Vehicle) -> None:
    """One tick: count, and disarm after two seconds on the side or five seconds of lying still."""
    ap = v.autopilot
    attitude, detector = ap.control.attitude, ap.modes.landing
    watched = ap.arming.armed and not ap.arming.landed and ap.params.FS.CRASH_CHECK >= 1.0
    crashed = watched and is_crashed(attitude, detector, ap.estimate.vel)
    still = watched and not crashed and lies_still(ap.control.motors, attitude, detector, ap.estimate)
    ap.arming.crash_ticks = ap.arming.crash_ticks + 1 if crashed or still else 0
    if ap.arming.crash_ticks >= (TRIGGER_TICKS if crashed else STILL_TICKS):
        error = math.degrees(attitude.thrust_error_angle)
        emit(ap.events, v.time_us, CRASH_DISARM, error, landing.acceleration(detector))
        ground.disarm(v, ArmingMethod.CRASH)


def text(angle_error_deg: float, acceleration: float) -> str:
    """Status text (MAV_SEVERITY_EMERGENCY) of CRASH_DISARM."""
    if angle_error_deg <= math.degrees(ANGLE_ERROR_MAX):
        return f"Crash: Disarming: at rest, AngErr={angle_error_deg:.0f}"
    return f"Crash: Disarming: AngErr={angle_error_deg:.0f}>30, Accel={acceleration:.1f}<3.0"
