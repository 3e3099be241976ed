# SPDX-License-Identifier: BSD-3-Clause
"""Landing detector, and how much of the throttle attitude control may claim.

Landed: for one second the motors are at their least, attitude has given the throttle back, nothing leans
far, and the vehicle neither accelerates nor climbs nor sinks. It deliberately asks neither height nor
position. Where the vehicle is meant to land, leaning does not count: in strong wind the position controller
goes on asking for it on the ground.
"""

from __future__ import annotations

import math

from ...core.algebra import euler_of, norm
from ...core.kernels import inlined, law
from ...core.vectors import Quat
from ..arming_checks import ArmingMethod
from ..events import Event, emit
from ..state import Arming
from .control import throttle_mix
from .control.attitude_target import cos_lean
from .control.motors import hover_throttle
from .control.spool import SpoolState
from .control.state import AttitudeState, Control, MotorsState
from .modes import ground, mode_list
from .modes.state import LandingState, Modes
from .parameters import Parameters
from .parameters.control import Attitude
from .state import Vehicle

LANDED = Event(4)

TRIGGER_TICKS = 400
"""1 s."""
MAYBE_TICKS = 80
"""0.2 s: controllers stop pushing against the ground."""
ACCEL_MAX = 1.0  # [m/s^2]
SPEED_MAX = 1.0  # [m/s]
LEAN_REQUEST_MAX = math.radians(15.0)
COS_LEAN_NEAR = 0.967  # cos(roll) cos(pitch) is below this wherever roll^2 + pitch^2 is over (15 degrees)^2
LEAN_ERROR_MAX = math.radians(30.0)
ACCEL_MOVING = 3.0  # [m/s^2]
_FILTER = 0.0025 / (0.0025 + 1.0 / (2.0 * math.pi))
"""Gain of a 1 Hz low-pass at 400 Hz."""
_MIX_AT_MIN = 1.25
_STOPPED = 0.1  # [m/s]
_DISARM_BEHAVIOUR = 4
"""PILOT_THR_BHV"""


@inlined
def is_taking_off(modes: Modes) -> bool:
    """Whether the mode raises the throttle from the ground by itself and tells when it flies."""
    return modes.takeoff.user_active or mode_list.is_taking_off(modes.number, modes)


@inlined
def acceleration(detector: LandingState) -> float:
    """Filtered acceleration [m/s^2]."""
    return norm(detector.acc)


@inlined
def leans_far(attitude: AttitudeState) -> bool:
    """Whether a lean over 15 degrees is asked for, or the lean is off by more than 30 degrees."""
    return is_far_lean(attitude.target_q) or attitude.thrust_error_angle > LEAN_ERROR_MAX


@law
def is_far_lean(q: Quat) -> bool:
    """Whether roll and pitch of an attitude are over 15 degrees together."""
    if cos_lean(q) > COS_LEAN_NEAR:
        return False  # for certain: the angles themselves are dear
    lean = euler_of(q)
    return lean.roll * lean.roll + lean.pitch * lean.pitch > LEAN_REQUEST_MAX * LEAN_REQUEST_MAX


@inlined
def detect(v: Vehicle) -> None:
    """One tick of the detector."""
    ap = v.autopilot
    arming, modes = ap.arming, ap.modes
    modes.landing.acc += _FILTER * (ap.estimate.acc_ned - modes.landing.acc)
    modes.landing.landing = mode_list.is_landing(modes.number, modes)
    if not arming.armed:
        ground.set_landed(arming, True)
    elif arming.landed:
        if pushes(ap.control.motors, hover_throttle(ap.params.MOT)) and not is_taking_off(modes):
            ground.set_landed(arming, False)
    elif count_rest(arming, is_at_rest(ap.control, modes, ap.estimate.vel.z, ap.params.ATC)):
        emit(ap.events, v.time_us, LANDED, 0.0, 0.0)
        if disarms(modes.number, ap.params):
            ground.disarm(v, ArmingMethod.LANDING)


@law
def disarms(mode: int, p: Parameters) -> bool:
    """Whether a vehicle that has landed in a ``mode`` disarms at once (PILOT_THR_BHV)."""
    if int(p.PILOT.THR_BHV) & _DISARM_BEHAVIOUR == 0 or mode_list.has_manual_throttle(mode):
        return False
    return mode_list.may_arm(mode, p, ArmingMethod.LANDING)


@inlined
def count_rest(arming: Arming, at_rest: bool) -> bool:
    """Count a tick in the air ``at_rest`` or not; whether the vehicle has landed with it."""
    if not at_rest:
        arming.landed_ticks = 0
        arming.landed_maybe = False
        return False
    arming.landed_ticks += 1
    if arming.landed_ticks >= TRIGGER_TICKS:
        ground.set_landed(arming, True)
        return True
    arming.landed_maybe = arming.landed_ticks >= MAYBE_TICKS
    return False


@inlined
def pushes(motors: MotorsState, hover: float) -> bool:
    """Whether the motors lift more than half of the vehicle; ``hover``: throttle that lifts it."""
    return motors.throttle > 0.5 * hover and motors.spool_state == SpoolState.THROTTLE_UNLIMITED


@inlined
def is_meant_to_land(modes: Modes, motors: MotorsState, vel_d: float) -> bool:
    """Whether the mode lands, or the pilot's closed throttle asks for a descent that the ground has stopped."""
    if modes.landing.landing:
        return True
    if not mode_list.has_climb_stick(modes.number):
        return False
    return modes.pilot.throttle_zero and motors.limit_throttle_lower and abs(vel_d) < _STOPPED


@inlined
def is_at_rest(control: Control, modes: Modes, vel_d: float, p: Attitude) -> bool:
    """Whether everything in this tick speaks for the ground; ``vel_d``: down [m/s]."""
    if not control.motors.limit_throttle_lower or control.attitude.mix >= _MIX_AT_MIN * p.THR_MIX_MIN:
        return False
    if leans_far(control.attitude) and not is_meant_to_land(modes, control.motors, vel_d):
        return False
    return abs(vel_d) < SPEED_MAX and acceleration(modes.landing) <= ACCEL_MAX


@inlined
def set_priority(control: Control, arming: Arming, modes: Modes, vel_d: float, p: Attitude) -> None:
    """Attitude first in the air, throttle first on and near the ground; ``vel_d``: down [m/s]."""
    attitude = control.attitude
    if not arming.armed or arming.landed:
        throttle_mix.set_mix_min(attitude, p)
    elif mode_list.has_manual_throttle(modes.number):
        if modes.pilot.throttle <= 0.0:
            throttle_mix.set_mix_min(attitude, p)
        else:
            throttle_mix.set_mix_man(attitude, p)
    else:
        path = control.pos_d
        busy = leans_far(attitude) or path.vel_desired <= 0.0 or acceleration(modes.landing) > ACCEL_MOVING
        if busy and not is_meant_to_land(modes, control.motors, vel_d):
            throttle_mix.set_mix_max(attitude, p, path.control_ratio)
        else:
            throttle_mix.set_mix_min(attitude, p)
