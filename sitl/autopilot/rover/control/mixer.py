# SPDX-License-Identifier: BSD-3-Clause
"""From steering and throttle to motors: a skid-steered vehicle's left and right, and the throttle's curve.

All numbers -1 .. 1. When steering and throttle together ask for more than the motors have, MOT_STR_THR_MIX says which
is cut: 0.5 shrinks both alike, 1 keeps steering, less than 0.5 favours throttle. MOT_THST_ASYM is how much weaker the
motors push backwards.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ....core.kernels import law
from ....core.scalars import constrain, sign
from .state import MotorsState


class Demand(NamedTuple):
    """What both motors together shall do."""

    steering: float
    throttle: float


class Sides(NamedTuple):
    """What each motor shall do."""

    left: float
    right: float


@law
def fit_together(wanted: Demand, backward: float, centre: float, mix: float) -> Demand:
    """Steering and throttle that together fit ``backward`` .. 1, when each fits alone."""
    steering, throttle = wanted.steering, wanted.throttle
    size = abs(steering)
    excess = max(throttle + size, (throttle - size) / backward)
    if excess <= 1.0:
        return wanted
    fair = 1.0 / excess
    high = throttle >= centre
    if mix >= 0.5:
        steering = steering * (fair + (1.0 - fair) * (mix - 0.5) * 2.0)
        throttle = 1.0 - abs(steering) if high else abs(steering) + backward
    else:
        throttle = throttle * (fair + (1.0 - fair) * (0.5 - mix) * 2.0)
        headroom = 1.0 - throttle if throttle >= centre else throttle - backward
        steering = headroom * sign(steering)
    return Demand(steering, throttle)


@law
def mix_skid(motors: MotorsState, steering: float, throttle: float, mix: float, asymmetry: float) -> Sides:
    """Left and right motor; sets the limit flags of ``motors`` where not all could be given."""
    asymmetry = max(asymmetry, 1.0)
    backward = -1.0 / asymmetry
    centre = 0.5 * (1.0 + backward)  # throttle with the most room for steering
    headroom = max(throttle, 0.0) - backward if throttle < centre else 1.0 - centre
    wanted_steering = constrain(steering, -1.0, 1.0)
    if wanted_steering > headroom:
        motors.limit_right = True
    elif wanted_steering < -headroom:
        motors.limit_left = True
    if throttle > 1.0:
        motors.limit_upper = True
    elif throttle < backward:
        motors.limit_lower = True
    alone = Demand(constrain(wanted_steering, -headroom, headroom), constrain(throttle, backward, 1.0))
    fit = fit_together(alone, backward, centre, constrain(mix, 0.0, 1.0))
    if abs(fit.steering) < abs(alone.steering):
        if alone.steering < 0.0:
            motors.limit_left = True
        else:
            motors.limit_right = True
    if abs(fit.throttle) < abs(alone.throttle):
        if alone.throttle < 0.0:
            motors.limit_lower = True
        else:
            motors.limit_upper = True
    left, right = fit.throttle + fit.steering, fit.throttle - fit.steering
    return Sides(left * asymmetry if left < 0.0 else left, right * asymmetry if right < 0.0 else right)


@law
def thrust_curve(throttle: float, throttle_min: float, expo: float) -> float:
    """Command for a wanted throttle: begins at ``throttle_min`` (MOT_THR_MIN), undoes the curve MOT_THST_EXPO."""
    if throttle == 0.0:
        return 0.0
    direction = sign(throttle)
    size = abs(throttle)
    if throttle_min > 0.0:
        size = throttle_min + size * (1.0 - throttle_min)
    if abs(expo) <= 1.0:
        size = min(size, 1.0)
        linear = 1.0 - expo
        size = 2.0 * size / (linear + math.sqrt(max(linear * linear + 4.0 * expo * size, 0.0)))
    return direction * size
