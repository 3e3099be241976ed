# SPDX-License-Identifier: BSD-3-Clause
"""From steering and throttle to motors: a skid-steered vehicle's left and right, and the throttle's curve.

All numbers -1 .. 1. When steering and throttle together ask for more than the motors have, MOT_STR_THR_MIX shares it
out: 0.5 shrinks both alike, 1 keeps steering, less than 0.5 favours throttle. MOT_THST_ASYM is how much weaker the
motors push backwards.
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.scalars import constrain, sign


@law
def _share(steering, throttle, backward, centre, mix):
    """(steering, throttle) that together fit ``backward`` .. 1, when each fits alone."""
    size = abs(steering)
    excess = max(throttle + size, (throttle - size) / backward)
    if excess <= 1.0:
        return (steering, throttle)
    fair = 1.0 / excess
    high = throttle >= centre
    if mix >= 0.5:
        steering = steering * (fair + (1.0 - fair) * (mix - 0.5) * 2.0)
        throttle = 1.0 - abs(steering) if high else abs(steering) + backward
    else:
        throttle = throttle * (fair + (1.0 - fair) * (0.5 - mix) * 2.0)
        room = 1.0 - throttle if throttle >= centre else throttle - backward
        steering = room * sign(steering)
    return (steering, throttle)


@law
def skid(motors, steering, throttle, mix, asymmetry):
    """(left, right) of the motors; sets the limit flags of ``motors`` where not all could be given."""
    asymmetry = max(asymmetry, 1.0)
    backward = -1.0 / asymmetry
    centre = 0.5 * (1.0 + backward)  # throttle with the most room for steering
    room = max(throttle, 0.0) - backward if throttle < centre else 1.0 - centre
    wanted_steering = constrain(steering, -1.0, 1.0)
    if wanted_steering > room:
        motors.limit_right = 1
    elif wanted_steering < -room:
        motors.limit_left = 1
    if throttle > 1.0:
        motors.limit_upper = 1
    elif throttle < backward:
        motors.limit_lower = 1
    fit_steering = constrain(wanted_steering, -room, room)
    fit_throttle = constrain(throttle, backward, 1.0)
    s, t = _share(fit_steering, fit_throttle, backward, centre, constrain(mix, 0.0, 1.0))
    if abs(s) < abs(fit_steering):
        if fit_steering < 0.0:
            motors.limit_left = 1
        else:
            motors.limit_right = 1
    if abs(t) < abs(fit_throttle):
        if fit_throttle < 0.0:
            motors.limit_lower = 1
        else:
            motors.limit_upper = 1
    left, right = t + s, t - s
    return (left * asymmetry if left < 0.0 else left, right * asymmetry if right < 0.0 else right)


@law
def thrust_curve(throttle, least, expo):
    """Command for a wanted throttle: begins at ``least`` (MOT_THR_MIN) and undoes a curve ``expo`` (MOT_THST_EXPO)."""
    if throttle == 0.0:
        return 0.0
    direction = sign(throttle)
    size = abs(throttle)
    if least > 0.0:
        size = least + size * (1.0 - least)
    if abs(expo) <= 1.0:
        size = min(size, 1.0)
        linear = 1.0 - expo
        size = 2.0 * size / (linear + math.sqrt(max(linear * linear + 4.0 * expo * size, 0.0)))
    return direction * size
