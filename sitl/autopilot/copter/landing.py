# SPDX-License-Identifier: BSD-3-Clause
"""Landing detector, and how much of the throttle attitude control may claim.

Landed: for one second the motors are at their least, attitude has given the throttle back, nothing leans
far, and the vehicle neither accelerates nor climbs nor sinks. It deliberately asks neither height nor
position. Where the vehicle is meant to land, leaning does not count: in strong wind the position controller
goes on asking for it on the ground.
"""

from __future__ import annotations

import math

from ...core.algebra import norm
from ...core.kernels import law
from ..events import LANDED, emit
from .control import throttle_mix
from .control.motors import hover_throttle
from .control.state import AttitudeState
from .modes import ground, table
from .modes.state import Modes
from .state import Autopilot, Vehicle

TRIGGER_TICKS = 400
"""1 s."""
MAYBE_TICKS = 80
"""0.2 s: controllers stop pushing against the ground."""
ACCEL_MAX = 1.0  # [m/s^2]
SPEED_MAX = 1.0  # [m/s]
LEAN_REQUEST_MAX = math.radians(15.0)
LEAN_ERROR_MAX = math.radians(30.0)
ACCEL_MOVING = 3.0  # [m/s^2]
_FILTER = 0.0025 / (0.0025 + 1.0 / (2.0 * math.pi))
"""Gain of a 1 Hz low-pass at 400 Hz."""
_MIX_AT_MIN = 1.25
_STOPPED = 0.1  # [m/s]


@law
def is_taking_off(v: Vehicle) -> bool:
    """Whether the mode raises the throttle from the ground by itself and tells when it flies."""
    modes = v.autopilot.modes
    return modes.takeoff.user_active or table.is_taking_off(modes.number, v)


@law
def acceleration(modes: Modes) -> float:
    """Filtered acceleration [m/s^2]."""
    return norm(modes.landing.acc)


@law
def leans_far(attitude: AttitudeState) -> bool:
    """Whether a lean over 15 degrees is asked for, or the lean is off by more than 30 degrees."""
    target = attitude.target_euler
    asked = target.roll * target.roll + target.pitch * target.pitch > LEAN_REQUEST_MAX * LEAN_REQUEST_MAX
    return asked or attitude.thrust_error_angle > LEAN_ERROR_MAX


@law
def detect(v: Vehicle) -> None:
    """One tick of the detector."""
    ap = v.autopilot
    arming = ap.arming
    landing = ap.modes.landing
    landing.acc += _FILTER * (ap.estimate.acc_ned - landing.acc)
    landing.landing = table.is_landing(ap.modes.number, v)
    if not arming.armed:
        ground.set_landed(arming, True)
    elif arming.landed:
        if pushes(ap) and not is_taking_off(v):
            ground.set_landed(arming, False)
    elif is_at_rest(ap):
        arming.landed_ticks += 1
        if arming.landed_ticks >= TRIGGER_TICKS:
            ground.set_landed(arming, True)
            emit(ap.events, v.time_us, LANDED, 0.0, 0.0)
        arming.landed_maybe = arming.landed or arming.landed_ticks >= MAYBE_TICKS
    else:
        arming.landed_ticks = 0
        arming.landed_maybe = False


@law
def pushes(ap: Autopilot) -> bool:
    """Whether the motors lift more than half of the vehicle."""
    motors = ap.control.motors
    return motors.throttle > 0.5 * hover_throttle(ap.params.MOT) and motors.spool_state == ground.IS_UNLIMITED


@law
def is_meant_to_land(ap: Autopilot) -> bool:
    """Whether the mode lands, or the pilot's closed throttle asks for a descent that the ground has stopped."""
    if ap.modes.landing.landing:
        return True
    if not table.has_climb_stick(ap.modes.number):
        return False
    stopped = ap.control.motors.limit_throttle_lower and abs(ap.estimate.vel.z) < _STOPPED
    return ap.modes.pilot.throttle_zero and stopped


@law
def is_at_rest(ap: Autopilot) -> bool:
    """Whether everything in this tick speaks for the ground."""
    if not ap.control.motors.limit_throttle_lower:
        return False
    if ap.control.attitude.mix >= _MIX_AT_MIN * ap.params.ATC.THR_MIX_MIN:
        return False
    if leans_far(ap.control.attitude) and not is_meant_to_land(ap):
        return False
    return abs(ap.estimate.vel.z) < SPEED_MAX and acceleration(ap.modes) <= ACCEL_MAX


@law
def set_priority(v: Vehicle) -> None:
    """Attitude first in the air, throttle first on and near the ground."""
    ap = v.autopilot
    if not ap.arming.armed or ap.arming.landed:
        throttle_mix.set_mix_min(ap.control.attitude, ap.params.ATC)
    elif table.has_manual_throttle(ap.modes.number):
        if ap.modes.pilot.throttle <= 0.0:
            throttle_mix.set_mix_min(ap.control.attitude, ap.params.ATC)
        else:
            throttle_mix.set_mix_man(ap.control.attitude, ap.params.ATC)
    else:
        path = ap.control.pos_d
        busy = leans_far(ap.control.attitude) or path.vel_desired <= 0.0 or acceleration(ap.modes) > ACCEL_MOVING
        if busy and not is_meant_to_land(ap):
            throttle_mix.set_mix_max(ap.control.attitude, ap.params.ATC, path.control_ratio)
        else:
            throttle_mix.set_mix_min(ap.control.attitude, ap.params.ATC)
