# SPDX-License-Identifier: BSD-3-Clause
"""POSHOLD: the sticks lean it as in STABILIZE; when they are centred, it brakes (PHLD_BRAKE_*) and holds its position.

Roll and pitch are apart: one may be flown while the other brakes. The lean that holding took against the wind is added
while it does not hold.
"""

from __future__ import annotations

import math

from ....core.algebra import ZERO2, horizontal, norm2
from ....core.constants import GRAVITY
from ....core.elementary import atan, cos, sincos
from ....core.kernels import law
from ....core.scalars import constrain
from ....core.vectors import Vec2
from ...modes import ModeResult
from ...state import Estimate
from .. import pilot
from ..control import attitude, position, position_start
from ..control.attitude import Lean
from ..control.state import DT, Control
from ..control.throttle_mix import lean_limit
from ..parameters import Parameters
from ..parameters.flight_modes import PosHold
from ..state import Vehicle
from . import alt_hold, loiter
from .mode import CopterMode
from .state import PosHoldAxis, PosHoldState

POSHOLD = 16

# What an axis is doing (``PosHoldAxis.phase``)
FLOWN = 0
BRAKING = 1
STOPPED = 2
TAKEN_OVER = 3

_TAKE_OVER_S = 0.5
"""As long the stick that takes an axis over is mixed with the lean there was [s]."""
_RELEASE_TIME = 0.2
"""Time constant of the lean after the stick is let go [s]."""
_RELEASED = math.radians(2.0)
"""Then the brake begins."""
_SLOW = 0.1
"""An axis this slow has stopped [m/s]."""
_WIND_TIME = 2.5
"""Time constant of what is learnt of the wind while it holds [s]."""
_ENTRY_SPEED = 0.5
"""Entered more slowly it holds at once [m/s]."""


@law
def brake_lean(speed: float, rate: float, most: float) -> float:
    """Lean [rad] that brakes a ``speed`` [m/s]: more for its size near rest; ``rate``: PHLD_BRAKE_RATE, ``most`` [deg].

    Source: ArduPilot's; with PHLD_BRAKE_RATE 8 12.6 degrees at 2 m/s, 25 degrees at 7 m/s.
    """
    gain = 0.95 + 0.15 * rate  # [deg per m/s]
    lean = gain * speed * (1.0 + 5.0 / (abs(speed) + 0.6))
    return math.radians(constrain(lean, -most, most))


@law
def advance_axis(axis: PosHoldAxis, stick: float, speed: float, time_us: int, p: PosHold) -> None:
    """One tick of an axis whose stick asks for a lean [rad]; ``speed`` [m/s]: that a positive lean takes away."""
    if stick != 0.0 and axis.phase in (BRAKING, STOPPED):
        axis.phase = TAKEN_OVER
        axis.since_us = time_us
        axis.held = axis.lean
    since = 1e-6 * (time_us - axis.since_us)
    if stick != 0.0 and axis.phase == TAKEN_OVER and since < _TAKE_OVER_S:
        share = since / _TAKE_OVER_S  # as recorded: the stick counts in full at first, and again at the end
        axis.lean = stick + share * (axis.held - stick)
    elif stick != 0.0:
        axis.phase = FLOWN
        grows = stick * axis.lean <= 0.0 or abs(stick) >= abs(axis.lean)
        axis.lean = stick if grows else axis.lean + DT / _RELEASE_TIME * (stick - axis.lean)
    elif axis.phase in (FLOWN, TAKEN_OVER):
        axis.lean -= DT / _RELEASE_TIME * axis.lean
        if abs(axis.lean) < _RELEASED:
            axis.phase = BRAKING
            axis.since_us = time_us
    else:
        step = math.radians(p.BRAKE_RATE) * DT
        axis.lean += constrain(brake_lean(speed, p.BRAKE_RATE, p.BRAKE_ANGLE * 0.01) - axis.lean, -step, step)
        longest = 1.0 + 2.0 * p.BRAKE_ANGLE * 0.01 / p.BRAKE_RATE  # [s]: to the greatest lean and back
        if abs(speed) < _SLOW or since > longest:
            axis.phase = STOPPED


@law
def reset(state: PosHoldState, holding: bool) -> None:
    """Forget the wind and all leans; hold, or brake."""
    state.holding = holding
    state.wind = ZERO2
    for_axis(state.roll, STOPPED if holding else BRAKING)
    for_axis(state.pitch, STOPPED if holding else BRAKING)


@law
def for_axis(axis: PosHoldAxis, phase: int) -> None:
    """Put an axis into a phase, level."""
    axis.phase = phase
    axis.lean = 0.0
    axis.held = 0.0


@law
def start(v: Vehicle) -> int:
    """Enter: slow, hold; else brake."""
    ap = v.autopilot
    control, est, p, state = ap.control, ap.estimate, ap.params, ap.modes.poshold
    loiter.set_limits(control.pos_ne, p)
    reset(state, norm2(horizontal(est.vel)) < _ENTRY_SPEED)
    state.roll.since_us = v.time_us
    state.pitch.since_us = v.time_us
    if not position_start.is_active_ne(control):
        position_start.init_ne(control, est, p)
    alt_hold.start_vertical(ap.modes.takeoff, control, est, p)
    return ModeResult.ACCEPTED


@law
def wind_lean(wind: Vec2, yaw: float) -> Lean:
    """Lean [rad] at heading ``yaw`` [rad] whose acceleration is ``wind`` (NE [m/s^2])."""
    s, c = sincos(yaw)
    pitch = -atan((wind.x * c + wind.y * s) / GRAVITY)
    return Lean(atan(cos(pitch) * (wind.y * c - wind.x * s) / GRAVITY), pitch)


@law
def begin_hold(state: PosHoldState, control: Control, est: Estimate, p: Parameters) -> None:
    """Both axes have stopped: hold from here, with the lean that the wind needed before."""
    state.holding = True
    position_start.init_ne(control, est, p)
    control.pos_ne.vel_integrator = state.wind


@law
def hold(state: PosHoldState, yaw_rate: float, landing: bool, control: Control, est: Estimate, p: Parameters) -> None:
    """One tick of holding, turning at ``yaw_rate`` [rad/s]; ``landing``: it may stand on the ground."""
    path = control.pos_ne
    if landing:
        position_start.soften_for_landing_ne(path, est.pos)
    position.brake_ne(path)
    position.update_ne(control, est, p)
    if norm2(horizontal(est.vel)) < _SLOW:
        state.wind += DT / (DT + _WIND_TIME) * (path.accel_target - state.wind)
    attitude.input_thrust_vector_heading_rate(control, est, p, position.thrust_vector(path), yaw_rate)


@law
def lean_back(state: PosHoldState, yaw_rate: float, control: Control, est: Estimate, p: Parameters) -> None:
    """One tick of axes that are flown or brake, turning at ``yaw_rate`` [rad/s]."""
    most = math.radians(p.ANGLE_MAX * 0.01)
    wind = wind_lean(state.wind, est.yaw)
    roll = constrain(state.roll.lean + wind.roll, -most, most)
    pitch = constrain(state.pitch.lean + wind.pitch, -most, most)
    attitude.input_euler_roll_pitch_yaw_rate(control, est, p, Lean(roll, pitch), yaw_rate)


@law
def fly(v: Vehicle) -> None:
    """Horizontal part of one tick in the air."""
    ap = v.autopilot
    modes, control, est, p = ap.modes, ap.control, ap.estimate, ap.params
    state, yaw_rate = modes.poshold, modes.pilot.yaw_rate
    most = math.radians(p.ANGLE_MAX * 0.01)
    stick = pilot.lean_angles(modes.pilot, most, min(most, lean_limit(control.attitude)))
    if state.holding and (stick.roll != 0.0 or stick.pitch != 0.0):
        state.holding = False
        for_axis(state.roll, BRAKING)
        for_axis(state.pitch, BRAKING)
        state.roll.since_us = v.time_us
        state.pitch.since_us = v.time_us
    if not state.holding:
        s, c = sincos(est.yaw)
        forward, right = est.vel.x * c + est.vel.y * s, est.vel.y * c - est.vel.x * s
        advance_axis(state.roll, stick.roll, -right, v.time_us, p.PHLD)
        advance_axis(state.pitch, stick.pitch, forward, v.time_us, p.PHLD)
        if state.roll.phase == STOPPED and state.pitch.phase == STOPPED:
            begin_hold(state, control, est, p)
    if state.holding:
        hold(state, yaw_rate, ap.arming.landed_maybe, control, est, p)
    else:
        lean_back(state, yaw_rate, control, est, p)


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    modes, control, est, p = ap.modes, ap.control, ap.estimate, ap.params
    alt_hold.set_limits(control.pos_d, p)
    loiter.set_limits(control.pos_ne, p)
    climb = alt_hold.climb_rate(modes, ap.rc, control.pos_d, p)
    doing = alt_hold.decide(ap.arming, modes.takeoff, control.motors, climb)
    if doing == alt_hold.STOPPED or doing == alt_hold.LANDED_IDLE:
        attitude.reset_yaw_target(control.attitude, est.yaw)
    if doing == alt_hold.STOPPED or doing == alt_hold.LANDED_IDLE or doing == alt_hold.LANDED_READY:
        reset(modes.poshold, True)
        loiter.stand(modes.loiter, modes.pilot.yaw_rate, control, est, p)
    else:
        fly(v)
    climb = alt_hold.kept_below(v, doing, climb)
    alt_hold.run_vertical(doing, climb, ap.arming, modes.takeoff, control, est, p)


MODE = CopterMode(number=POSHOLD, name="POSHOLD", start=start, run=run, climb_stick=True, needs_position=True)
