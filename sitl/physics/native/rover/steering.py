# SPDX-License-Identifier: BSD-3-Clause
"""Steering of a rover: the angle of its front wheels or the difference of its sides, to a yaw rate that tyres hold."""

from __future__ import annotations

import math

from ....core.kernels import law
from ....vehicles.figures.rover import STEERING_FRONT_WHEELS


@law
def turn_wheels(p, command):
    """Turn the front wheels towards a command -1 .. 1 (right positive) for a tick."""
    w = p.wheels
    target = command * float(p.airframe.steering_angle)
    before, step = float(w.angle), float(p.derived.steering_step)
    w.angle = min(max(target, before - step), before + step)


@law
def curvature(p):
    """1 / radius [1/m] of the driven axle's path that the front wheels' angle asks for, right positive."""
    angle = float(p.wheels.angle)
    if int(p.airframe.steering_model) == STEERING_FRONT_WHEELS:
        return math.tan(angle) * float(p.derived.inverse_wheelbase)
    return math.sin(angle) * float(p.derived.circle_scale)


@law
def grip_across(p, wanted, accel):
    """Yaw rate [rad/s] that the tyres give of the one wanted, while they accelerate the vehicle along [m/s^2].

    Beyond the friction circle the vehicle runs wide (understeer); the yaw rate changes no faster than tyres can turn
    the body.
    """
    d = p.derived
    speed, grip = abs(float(p.wheels.forward)), float(d.grip)
    across = speed * abs(wanted)
    if across * across + accel * accel > grip * grip:
        left = math.sqrt(max(grip * grip - accel * accel, 0.0))
        if across > left:
            wanted = wanted * (left / across)
    before, step = float(p.body.rates[2]), float(d.yaw_step)
    return min(max(wanted, before - step), before + step)
