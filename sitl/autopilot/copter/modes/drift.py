# SPDX-License-Identifier: BSD-3-Clause
"""DRIFT: flies like a plane: the roll stick turns it in coordinated turns, the pitch stick pitches it.

With the pitch stick centred it brakes. The yaw stick asks for a speed sideways. The throttle drives the motors, with an
assist against climbing and sinking around its middle.
"""

from __future__ import annotations

import math

from ....core.elementary import sincos
from ....core.kernels import law
from ....core.scalars import constrain
from .. import pilot
from ..control import attitude, throttle_mix
from ..control.attitude import Lean
from ..control.state import DT
from ..control.throttle_mix import lean_limit
from ..state import Vehicle
from . import ground, stabilize
from .mode import CopterMode
from .state import DriftState, Modes

DRIFT = 11

# What a real ArduPilot does in flight
_GAIN = math.radians(8.0)
"""Lean against side slip, and in braking once it has grown [rad per m/s]."""
_BRAKE_TIME = 2.0 / 3.0
"""In which the lean of braking grows [s]."""
_LEAN_MAX = math.radians(45.0)
_SPEED_MAX = 5.6
"""No lean for what is faster [m/s]."""
_SIDE_SPEED = 5.625
"""That a full yaw stick asks for [m/s]."""
_SIDE_TIME = 0.0625
"""Time constant of the yaw stick [s]."""
_LEAN_OF_TURN = math.radians(45.0)
"""A roll stick of this lean turns at ACRO_Y_RATE."""
_FAST, _FASTEST = 20.0, 50.0  # slower turns with speed [m/s]
_ASSIST = 0.18  # of the throttle per m/s
_ASSIST_MAX = 0.3
_ASSIST_FULL, _ASSIST_WIDTH = 1.2, 0.24


@law
def turn_rate(roll: float, forward: float, full_rate: float) -> float:
    """Turn rate [rad/s] of a roll stick that asks for a lean ``roll`` [rad]; ``forward`` speed [m/s]."""
    return roll / _LEAN_OF_TURN * full_rate * (1.0 - min(abs(forward), _FAST) / _FASTEST)


@law
def slip_lean(state: DriftState, stick: float, right: float) -> float:
    """Roll [rad] against a speed to the ``right`` [m/s] that the yaw stick (-1 .. 1) does not ask for."""
    state.side_speed += DT / _SIDE_TIME * (stick * _SIDE_SPEED - state.side_speed)
    slip = state.side_speed - constrain(right, -_SPEED_MAX, _SPEED_MAX)
    return constrain(_GAIN * slip, -_LEAN_MAX, _LEAN_MAX)


@law
def braking_lean(state: DriftState, pitch: float, forward: float) -> float:
    """Pitch [rad] that the stick asks for; centred, one that brakes the ``forward`` speed [m/s]."""
    if pitch != 0.0:
        state.brake = 0.0
        return pitch
    state.brake = min(state.brake + DT / _BRAKE_TIME, 1.0)
    return _GAIN * state.brake * constrain(forward, -_SPEED_MAX, _SPEED_MAX)


@law
def assisted(throttle: float, climb: float) -> float:
    """Throttle 0 .. 1 with less of a climb [m/s] the nearer it is to its middle."""
    share = constrain(_ASSIST_FULL - abs(throttle - 0.5) / _ASSIST_WIDTH, 0.0, 1.0)
    return constrain(throttle + constrain(-share * _ASSIST * climb, -_ASSIST_MAX, _ASSIST_MAX), 0.0, 1.0)


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    control, est, sticks, p = ap.control, ap.estimate, ap.modes.pilot, ap.params
    state = ap.modes.drift
    wanted = assisted(stabilize.throttle(sticks, p), -est.vel.z)
    if ground.spool_by_stick(ap.arming, sticks.throttle_zero, control.motors):
        attitude.reset_yaw_target(control.attitude, est.yaw)
        wanted = 0.0
    limit = math.radians(p.ANGLE_MAX * 0.01)
    stick = pilot.lean_angles(sticks, limit, min(limit, lean_limit(control.attitude)))
    s, c = sincos(est.yaw)
    forward, right = est.vel.x * c + est.vel.y * s, est.vel.y * c - est.vel.x * s
    rate = turn_rate(stick.roll, forward, math.radians(p.ACRO.Y_RATE))
    lean = Lean(slip_lean(state, sticks.yaw, right), braking_lean(state, stick.pitch, forward))
    attitude.input_euler_roll_pitch_yaw_rate(control, est, p, lean, rate)
    throttle_mix.set_throttle_out(control, p, wanted, True, p.PILOT.THR_FILT)


@law
def is_landing(modes: Modes) -> bool:
    """Whether it may land: the throttle is closed."""
    return modes.pilot.throttle_zero


MODE = CopterMode(number=DRIFT, name="DRIFT", run=run, needs_position=True, needs_pilot=True, is_landing=is_landing)
