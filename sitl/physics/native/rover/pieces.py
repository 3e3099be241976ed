# SPDX-License-Identifier: BSD-3-Clause
"""A rover's tick in pieces, for engines that move the body themselves (``sitl.physics.engine.Laws``)."""

from __future__ import annotations

from ....core.kernels import unit
from ....vehicles.figures.rover import STEERING_SKID
from ..observe import note, observe
from . import step


@unit
def begin(fleet, i):
    """Clock; motors and steering follow the controls: ``wheels.speed``, ``wheels.angle``, ``wheels.power``."""
    v = fleet[i]
    note(v.physics)
    step.begin(v)
    p = v.physics
    first, second = step.commands(p, v.actuators.controls)
    if int(p.airframe.steering_model) == STEERING_SKID:
        step.drive_sides(p, first, second)
    else:
        step.drive_axle(p, first, second)


@unit
def load(fleet, i):
    """Nothing: all forces on a rover come from its wheels."""
    v = fleet[i]
    v.physics.motion.force[0] = 0.0


@unit
def sense(fleet, i):
    """Accelerations, battery, sensors."""
    v = fleet[i]
    observe(v.physics)
    step.end(v)
