# SPDX-License-Identifier: BSD-3-Clause
"""Throttle: demand from the modes, boost for lean, and how much of it attitude may claim (ATC_THR_MIX_*)."""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.scalars import constrain, finite
from .motors import hover_throttle
from .state import DT

LEAN_TICKS = 8
"""Period, in ticks, of the lean limits."""
_LEAN_THROTTLE = 0.8  # part of full throttle that the lean may use up
_LEAN_LEAST = math.radians(10.0)
_MIX_MIN, _MIX_MAX = 0.1, 5.0
_MIX_RISE, _MIX_FALL = 2.0, 0.5  # [1/s]


@law
def set_throttle_out(ap, throttle, angle_boost, filter_hz):
    """Throttle 0 .. 1 for the motors, low-passed at ``filter_hz`` [Hz] (0: not).

    ``angle_boost`` != 0 adds what a leaning vehicle needs to keep its lift (also needs ATC_ANGLE_BOOST).
    """
    if not finite(throttle):
        return
    attitude = ap.control.attitude
    motors = ap.control.motors
    attitude.throttle_in = throttle
    update_lean_max(ap, throttle)
    motors.throttle_filter_hz = filter_hz
    out = throttle
    if angle_boost != 0 and ap.params.ATC.ANGLE_BOOST != 0.0:
        cos_lean = float(attitude.cos_lean)
        out = throttle * constrain(10.0 * cos_lean, 0.0, 1.0) / constrain(cos_lean, 0.1, 1.0)
    motors.throttle_in = out
    mix = float(attitude.mix)
    avg = constrain(max(out, throttle), 0.0, 1.0)
    motors.throttle_avg_max = max(avg, avg * max(0.0, 1.0 - mix) + hover_throttle(ap) * mix)


@law
def update_lean_max(ap, throttle):
    """Lean at which 80 % of the throttle range still lifts the vehicle, low-passed with ATC_ANG_LIM_TC.

    Every few ticks is enough for a time constant of a second, and an arc cosine is dear.
    """
    attitude = ap.control.attitude
    thrust_max = float(ap.control.motors.thrust_max)
    if thrust_max <= 0.0:
        attitude.lean_max = 0.0
    elif ap.control.tick % LEAN_TICKS == 0:
        lean = math.acos(constrain(throttle / (_LEAN_THROTTLE * thrust_max), 0.0, 1.0))
        dt = LEAN_TICKS * DT
        attitude.lean_max += dt / (dt + float(ap.params.ATC.ANG_LIM_TC)) * (lean - float(attitude.lean_max))


@law
def lean_limit(ap):
    """Lean [rad] up to which altitude can be held, at least 10 degrees."""
    return max(float(ap.control.attitude.lean_max), _LEAN_LEAST)


@law
def set_mix_min(ap):
    """Throttle first: landing, idle on the ground."""
    ap.control.attitude.mix_desired = float(ap.params.ATC.THR_MIX_MIN)


@law
def set_mix_man(ap):
    """Throttle in the pilot's hand."""
    ap.control.attitude.mix_desired = float(ap.params.ATC.THR_MIX_MAN)


@law
def set_mix_max(ap, ratio):
    """Attitude first; ``ratio`` 0 .. 1 between the least and the most priority."""
    r = constrain(ratio, 0.0, 1.0)
    p = ap.params
    ap.control.attitude.mix_desired = (1.0 - r) * float(p.ATC.THR_MIX_MIN) + r * float(p.ATC.THR_MIX_MAX)


@law
def update_mix(ap):
    """Move the priority to its goal: quickly up, slowly down, never above what the mixer has just used."""
    attitude = ap.control.attitude
    mix = float(attitude.mix)
    desired = float(attitude.mix_desired)
    if mix < desired:
        mix += min(_MIX_RISE * DT, desired - mix)
    elif mix > desired:
        mix -= min(_MIX_FALL * DT, mix - desired)
        hover = hover_throttle(ap)
        asked = float(ap.control.motors.throttle)
        out = max(float(ap.control.motors.throttle_out), asked)
        used = (out - asked) / (hover - asked) if out < hover else out / hover
        mix = min(mix, max(used, desired))
    attitude.mix = constrain(mix, _MIX_MIN, _MIX_MAX)
