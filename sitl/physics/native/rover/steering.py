# SPDX-License-Identifier: BSD-3-Clause
"""Steering of a rover: the angle of its front wheels or the difference of its sides, to a yaw rate that tyres hold."""

from __future__ import annotations

import math

from ....core.kernels import law
from ....vehicles.figures.rover import STEERING_FRONT_WHEELS, Figures
from .state import Derived


@law
def approach(value: float, target: float, step: float) -> float:
    """``value`` a tick later, which goes to ``target`` by at most ``step``."""
    return min(max(target, value - step), value + step)


@law
def curvature(angle: float, figures: Figures, derived: Derived) -> float:
    """1 / radius [1/m] of the driven axle's path that the front wheels' angle [rad] asks for, right positive."""
    if figures.steering_model == STEERING_FRONT_WHEELS:
        return math.tan(angle) * derived.inverse_wheelbase
    return math.sin(angle) * derived.circle_scale


@law
def grip_across(wanted: float, speed: float, accel: float, grip: float) -> float:
    """Yaw rate [rad/s] that tyres of a grip [m/s^2] give of the one wanted, while they accelerate the vehicle, of this
    speed [m/s], along [m/s^2]: beyond the friction circle it runs wide (understeer).
    """
    across = abs(speed) * abs(wanted)
    if across * across + accel * accel > grip * grip:
        left = math.sqrt(max(grip * grip - accel * accel, 0.0))
        if across > left:
            return wanted * (left / across)
    return wanted
