# SPDX-License-Identifier: BSD-3-Clause
"""FLIP: flips once, then returns to the previous mode.

It turns right; forward, back or left when that stick is held on entry. It begins in the air in STABILIZE, ACRO and
ALT_HOLD only, and gives up when it takes too long or a stick is pushed far.
"""

from __future__ import annotations

import math

from ....core.algebra import euler_of, quat_from_euler
from ....core.elementary import atan2
from ....core.kernels import law
from ....core.scalars import constrain, wrap_pi
from ....core.vectors import Euler, Quat, Vec3
from ...modes import ModeReason, ModeResult, ask
from .. import pilot
from ..control import attitude, throttle_mix
from ..control.motors import hover_throttle
from ..control.spool import DesiredSpoolState
from ..state import Vehicle
from .acro import ACRO
from .alt_hold import ALT_HOLD
from .mode import CopterMode, never_arms
from .stabilize import STABILIZE
from .state import FlipState, PilotState

FLIP = 14

# What it is doing (``FlipState.phase``)
BEGINNING = 0
TURNING = 1
RECOVERING = 2

_RATE = math.radians(400.0)  # [rad/s]
_MORE, _LESS = 0.2, 0.24  # throttle added to begin and to recover, taken off upside down
_BEGUN = math.radians(45.0)
_ROLL_DONE, _PITCH_DONE = math.radians(-90.0), math.radians(-45.0)  # from there on it recovers
_RECOVERED = math.radians(5.0)
_TIME_MAX_US = 2_500_000
_LEAN_MAX = math.radians(45.0)
_STICK_CHOOSES = 0.3 / 4.5  # of full stick
_STICK_ENDS = 4.0 / 4.5


@law
def choose(flip: FlipState, sticks: PilotState) -> None:
    """The way round, by the sticks: right when both are centred."""
    flip.roll, flip.pitch = 0.0, 0.0
    if sticks.pitch > _STICK_CHOOSES:
        flip.pitch = 1.0
    elif sticks.pitch < -_STICK_CHOOSES:
        flip.pitch = -1.0
    elif sticks.roll < -_STICK_CHOOSES:
        flip.roll = -1.0
    else:
        flip.roll = 1.0


@law
def start(v: Vehicle) -> int:
    """Enter, in flight and near level."""
    ap = v.autopilot
    modes, est = ap.modes, ap.estimate
    if modes.number not in (STABILIZE, ACRO, ALT_HOLD):
        return ModeResult.INIT_FAILED
    throttle_down = modes.number != ALT_HOLD and modes.pilot.throttle_zero
    lean = euler_of(est.q)
    if throttle_down or not ap.arming.armed or ap.arming.landed or abs(lean.roll) >= _LEAN_MAX:
        return ModeResult.INIT_FAILED
    flip = modes.flip
    choose(flip, modes.pilot)
    flip.phase = BEGINNING
    flip.start_us = v.time_us
    flip.level = quat_from_euler(Euler(constrain(lean.roll, -_LEAN_MAX, _LEAN_MAX), lean.pitch, lean.yaw))
    return ModeResult.ACCEPTED


@law
def turned(flip: FlipState, q: Quat) -> float:
    """Angle [rad] of the thrust about the axis of the flip, -pi .. pi, positive in its direction."""
    up = 1.0 - 2.0 * (q.x * q.x + q.y * q.y)
    roll = atan2(2.0 * (q.w * q.x + q.y * q.z), up)
    pitch = atan2(2.0 * (q.w * q.y - q.x * q.z), up)
    return flip.roll * roll + flip.pitch * pitch


@law
def advance(flip: FlipState, q: Quat) -> bool:
    """Follow the attitude ``q`` from phase to phase; whether the flip is over."""
    angle = turned(flip, q)
    if flip.phase == BEGINNING and angle >= _BEGUN:
        flip.phase = TURNING
    elif flip.phase == TURNING and (_ROLL_DONE if flip.roll != 0.0 else _PITCH_DONE) <= angle < _BEGUN:
        flip.phase = RECOVERING
    elif flip.phase == RECOVERING:
        return abs(wrap_pi(angle - turned(flip, flip.level))) <= _RECOVERED
    return False


@law
def throttle(flip: FlipState, stick: float) -> float:
    """Throttle 0 .. 1 of a phase; ``stick``: what the pilot's asks for."""
    return constrain(stick - _LESS if flip.phase == TURNING else stick + _MORE, 0.0, 1.0)


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    modes, control, est, p = ap.modes, ap.control, ap.estimate, ap.params
    flip, sticks = modes.flip, modes.pilot
    pushed = abs(sticks.roll) >= _STICK_ENDS or abs(sticks.pitch) >= _STICK_ENDS
    late = v.time_us - flip.start_us > _TIME_MAX_US
    if advance(flip, est.q) or pushed or late or not ap.arming.armed or ap.arming.landed:
        ask(modes, modes.previous, ModeReason.FLIP_COMPLETE)
    control.motors.desired_spool = (
        DesiredSpoolState.THROTTLE_UNLIMITED if ap.arming.armed else DesiredSpoolState.SHUT_DOWN
    )
    if flip.phase == RECOVERING:
        attitude.input_quaternion(control, est, p, flip.level, Vec3(0.0, 0.0, 0.0))
    else:
        attitude.input_rates(control, est, p, Vec3(flip.roll * _RATE, flip.pitch * _RATE, 0.0))
    held = pilot.throttle_out(sticks.throttle_filtered, pilot.throttle_middle(p), hover_throttle(p.MOT))
    wanted = throttle(flip, held)
    throttle_mix.set_throttle_out(control, p, wanted, False, p.PILOT.THR_FILT)


MODE = CopterMode(number=FLIP, name="FLIP", start=start, run=run, ignores_simple=True, may_arm=never_arms)
