# SPDX-License-Identifier: BSD-3-Clause
"""A multicopter's tick in pieces, for engines that move the body themselves (``sitl.physics.engine.Laws``)."""

from __future__ import annotations

from ....core.kernels import unit
from ....core.records import Records
from ..observe import note, observe
from ..records import Vehicle
from . import step
from .state import Physics
from .wrench import act


@unit
def begin(fleet: Records[Vehicle[Physics]], i: int) -> None:
    """Clock, wind, rotor commands."""
    v = fleet[i]
    note(v.physics.body, v.physics.motion)
    step.begin(v)


@unit
def load(fleet: Records[Vehicle[Physics]], i: int) -> None:
    """One substep of the rotors; leaves their and the air's force and torque in ``motion``."""
    p = fleet[i].physics
    p.motion.force, p.motion.torque = act(p)


@unit
def sense(fleet: Records[Vehicle[Physics]], i: int) -> None:
    """Accelerations, battery, sensors."""
    v = fleet[i]
    observe(v.physics.body, v.physics.motion, v.physics.obstacles)
    step.end(v)
