# SPDX-License-Identifier: BSD-3-Clause
"""FLOWHOLD: holds its position by optical flow, without GPS and rangefinder; the sticks lean it, centred they brake.

Flow times the height over the take-off is a velocity. A lean in proportion to it drags at all times (FHLD_XY_P, a share
of ANGLE_MAX for 1 m/s); one that grows with the way gone leads it to zero against wind (FHLD_XY_I). Let go, it brakes
first, as POSHOLD does.
"""

from __future__ import annotations

import math

from ....core.algebra import ZERO2, limit_length, norm2, turned
from ....core.kernels import law
from ....core.scalars import TWO_PI, constrain
from ....core.vectors import Vec2
from ...modes import ModeResult
from ...optical_flow import OpticalFlow, is_healthy
from ...state import Estimate
from .. import pilot
from ..control import attitude
from ..control.attitude import Lean
from ..control.state import DT
from ..control.throttle_mix import lean_limit
from ..parameters import Parameters
from ..parameters.flight_modes import FlowHold
from ..state import Vehicle
from . import alt_hold
from .mode import CopterMode
from .poshold import brake_lean
from .state import FlowHoldState

FLOWHOLD = 22

LEAST_HEIGHT = 0.1
"""[m]"""
SLOW = 0.3
"""It has stopped when it is slower [m/s]."""
BRAKE_US = 3_000_000
"""And holds after braking for so long, however fast it is."""


@law
def start(v: Vehicle) -> int:
    """Enter level, with a sensor that works."""
    ap = v.autopilot
    if not is_healthy(ap.flow, v.time_us):
        return ModeResult.INIT_FAILED
    state = ap.modes.flowhold
    state.shown, state.against_wind = ZERO2, ZERO2
    state.braking, state.brake_us = True, v.time_us
    alt_hold.start_vertical(ap.modes.takeoff, ap.control, ap.estimate, ap.params)
    return ModeResult.ACCEPTED


@law
def filter_flow(state: FlowHoldState, flow: OpticalFlow, time_us: int, p: FlowHold) -> None:
    """Low-pass of the flow without body rates [rad/s]; of one that is not good enough nothing is believed."""
    is_good = is_healthy(flow, time_us) and flow.quality >= p.QUAL_MIN
    shown = limit_length(flow.rate - flow.body, p.FLOW_MAX) if is_good else ZERO2
    state.shown += DT / (DT + 1.0 / (TWO_PI * p.FILT_HZ)) * (shown - state.shown)


@law
def velocity(state: FlowHoldState, height: float) -> Vec2:
    """Forward and right [m/s], at a height over the ground [m]."""
    away = max(height, LEAST_HEIGHT)
    return Vec2(state.shown.y * away, -state.shown.x * away)


@law
def learn_wind(state: FlowHoldState, vel: Vec2, most: float, p: FlowHold) -> None:
    """The lean against the wind grows with the way gone: velocity north and east [m/s], ``most`` it may lean [rad]."""
    grown = state.against_wind + DT * p.XY_I * most * vel
    state.against_wind = limit_length(grown, min(math.radians(p.XY_IMAX * 0.01), most))


@law
def advance(state: FlowHoldState, stick: Lean, vel: Vec2, est: Estimate, time_us: int, p: Parameters) -> Lean:
    """The lean [rad] of this tick; ``stick``: that of the pilot, ``vel``: forward and right [m/s]."""
    if stick.roll != 0.0 or stick.pitch != 0.0:
        state.braking, state.brake_us = True, time_us
    elif norm2(vel) < SLOW or time_us - state.brake_us > BRAKE_US:
        state.braking = False
    most = math.radians(p.ANGLE_MAX * 0.01)
    if state.braking and state.brake_us != time_us:
        limit = p.ANGLE_MAX * 0.01
        lean = Vec2(brake_lean(vel.x, p.FHLD.BRAKE_RATE, limit), brake_lean(vel.y, p.FHLD.BRAKE_RATE, limit))
    else:
        lean = p.FHLD.XY_P * most * vel
    if not state.braking:
        learn_wind(state, turned(vel, est.yaw), most, p.FHLD)
    lean = limit_length(lean + turned(state.against_wind, -est.yaw), 0.5 * most)
    return Lean(stick.roll - lean.y, stick.pitch + lean.x)


@law
def fly(v: Vehicle) -> None:
    """Horizontal part of one tick in the air."""
    ap = v.autopilot
    modes, control, est, p = ap.modes, ap.control, ap.estimate, ap.params
    most = math.radians(p.ANGLE_MAX * 0.01)
    stick = pilot.lean_angles(modes.pilot, most, min(most, lean_limit(control.attitude)))
    filter_flow(modes.flowhold, ap.flow, v.time_us, p.FHLD)
    vel = velocity(modes.flowhold, ap.ekf.ground_d - est.pos.z)
    lean = advance(modes.flowhold, stick, vel, est, v.time_us, p)
    roll, pitch = constrain(lean.roll, -most, most), constrain(lean.pitch, -most, most)
    attitude.input_euler_roll_pitch_yaw_rate(control, est, p, Lean(roll, pitch), modes.pilot.yaw_rate)


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    modes, control, est, p = ap.modes, ap.control, ap.estimate, ap.params
    alt_hold.set_limits(control.pos_d, p)
    climb = alt_hold.climb_rate(modes, ap.rc, control.pos_d, p)
    doing = alt_hold.decide(ap.arming, modes.takeoff, control.motors, climb)
    if doing == alt_hold.FLYING or doing == alt_hold.TAKING_OFF:
        fly(v)
    else:
        state = modes.flowhold
        state.shown, state.against_wind = ZERO2, ZERO2
        if doing != alt_hold.LANDED_READY:
            attitude.reset_yaw_target(control.attitude, est.yaw)
        attitude.input_euler_roll_pitch_yaw_rate(control, est, p, Lean(0.0, 0.0), modes.pilot.yaw_rate)
    climb = alt_hold.kept_below(v, doing, climb)
    alt_hold.run_vertical(doing, climb, ap.arming, modes.takeoff, control, est, p)


MODE = CopterMode(number=FLOWHOLD, name="FLOWHOLD", start=start, run=run, climb_stick=True)
