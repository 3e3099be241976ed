# SPDX-License-Identifier: BSD-3-Clause
"""A rover's tick in pieces, for engines that move the body themselves (``sitl.physics.engine.Laws``)."""

from __future__ import annotations

from ....core.algebra import ZERO
from ....core.kernels import unit
from ....core.records import Records
from ..observe import note, observe
from ..records import Vehicle
from . import step
from .state import Physics


@unit
def begin(fleet: Records[Vehicle[Physics]], i: int) -> None:
    """Clock; motors and steering follow the controls: ``wheels.speed``, ``wheels.angle``, ``wheels.power``."""
    v, p = fleet[i], fleet[i].physics
    note(p.body, p.motion)
    step.begin(v)
    step.drive(p.wheels, p.airframe, p.derived, v.actuators.controls)


@unit
def load(fleet: Records[Vehicle[Physics]], i: int) -> None:
    """Nothing: all forces on a rover come from its wheels."""
    fleet[i].physics.motion.force = ZERO


@unit
def sense(fleet: Records[Vehicle[Physics]], i: int) -> None:
    """Accelerations, battery, sensors."""
    v = fleet[i]
    observe(v.physics.body, v.physics.motion, v.physics.obstacles)
    step.end(v)
