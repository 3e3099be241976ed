# SPDX-License-Identifier: BSD-3-Clause
"""Throttle: demand from the modes, boost for lean, and how much of it attitude may claim (ATC_THR_MIX_*)."""

from __future__ import annotations

import math

from ....core.elementary import acos
from ....core.kernels import inlined, law
from ....core.scalars import constrain, finite
from ..parameters import Parameters
from ..parameters.control import Attitude
from .motors import hover_throttle
from .state import DT, AttitudeState, Control, MotorsState

LEAN_TICKS = 8
"""Period, in ticks, of the lean limits."""
_LEAN_THROTTLE = 0.8  # part of full throttle that the lean may use up
_LEAN_MIN = math.radians(10.0)
_MIX_MIN, _MIX_MAX = 0.1, 5.0
_MIX_RISE, _MIX_FALL = 2.0, 0.5  # [1/s]


@inlined
def boosted(throttle: float, cos_lean: float) -> float:
    """Throttle that keeps the lift of ``throttle`` at a lean; none beyond the horizontal."""
    return throttle * constrain(10.0 * cos_lean, 0.0, 1.0) / constrain(cos_lean, 0.1, 1.0)


@inlined
def throttle_average_max(throttle: float, hover: float, mix: float) -> float:
    """How far the mixer may raise ``throttle`` for attitude: ``mix`` 0 not at all, 1 to that of hovering."""
    return max(throttle, throttle * max(0.0, 1.0 - mix) + hover * mix)


@inlined
def set_throttle_out(control: Control, p: Parameters, throttle: float, angle_boost: bool, filter_hz: float) -> None:
    """Throttle 0 .. 1 for the motors, low-passed at ``filter_hz`` [Hz] (0: not).

    ``angle_boost`` adds what a leaning vehicle needs to keep its lift (also needs ATC_ANGLE_BOOST).
    """
    if not finite(throttle):
        return
    attitude = control.attitude
    motors = control.motors
    attitude.throttle_in = throttle
    if motors.thrust_max <= 0.0 or control.tick % LEAN_TICKS == 0:
        update_lean_max(attitude, throttle, motors.thrust_max, p.ATC.ANG_LIM_TC)
    boost = angle_boost and p.ATC.ANGLE_BOOST != 0.0
    motors.throttle_filter_hz = filter_hz
    motors.throttle_in = boosted(throttle, attitude.cos_lean) if boost else throttle
    average = constrain(max(motors.throttle_in, throttle), 0.0, 1.0)
    motors.throttle_avg_max = throttle_average_max(average, hover_throttle(p.MOT), attitude.mix)


@law
def update_lean_max(attitude: AttitudeState, throttle: float, thrust_max: float, time_constant: float) -> None:
    """Lean at which 80 % of the throttle range still lifts the vehicle, low-passed with a time constant [s].

    Every few ticks is enough for a time constant of a second, and an arc cosine is dear.
    """
    if thrust_max <= 0.0:
        attitude.lean_max = 0.0
        return
    lean = acos(constrain(throttle / (_LEAN_THROTTLE * thrust_max), 0.0, 1.0))
    dt = LEAN_TICKS * DT
    attitude.lean_max += dt / (dt + time_constant) * (lean - attitude.lean_max)


@law
def lean_limit(attitude: AttitudeState) -> float:
    """Lean [rad] up to which altitude can be held, at least 10 degrees."""
    return max(attitude.lean_max, _LEAN_MIN)


@law
def set_mix_min(attitude: AttitudeState, p: Attitude) -> None:
    """Throttle first: landing, idle on the ground."""
    attitude.mix_desired = p.THR_MIX_MIN


@law
def set_mix_man(attitude: AttitudeState, p: Attitude) -> None:
    """Throttle in the pilot's hand."""
    attitude.mix_desired = p.THR_MIX_MAN


@law
def set_mix_max(attitude: AttitudeState, p: Attitude, ratio: float) -> None:
    """Attitude first; ``ratio`` 0 .. 1 between the lowest and the highest priority."""
    r = constrain(ratio, 0.0, 1.0)
    attitude.mix_desired = (1.0 - r) * p.THR_MIX_MIN + r * p.THR_MIX_MAX


@law
def follow_mix(attitude: AttitudeState, motors: MotorsState, hover: float) -> None:
    """Move the priority to its goal: quickly up, slowly down, never above what the mixer has just used.

    ``hover``: throttle 0 .. 1 that holds the vehicle in the air.
    """
    mix = attitude.mix
    desired = attitude.mix_desired
    if mix < desired:
        mix += min(_MIX_RISE * DT, desired - mix)
    elif mix > desired:
        mix -= min(_MIX_FALL * DT, mix - desired)
        asked = motors.throttle
        out = max(motors.throttle_out, asked)
        used = (out - asked) / (hover - asked) if out < hover else out / hover
        mix = min(mix, max(used, desired))
    attitude.mix = constrain(mix, _MIX_MIN, _MIX_MAX)
