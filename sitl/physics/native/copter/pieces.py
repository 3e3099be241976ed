# SPDX-License-Identifier: BSD-3-Clause
"""A multicopter's tick in pieces, for engines that move the body themselves (``sitl.physics.engine.Laws``)."""

from __future__ import annotations

from ....core.kernels import unit
from ..observe import note, observe
from . import step
from .wrench import wrench


@unit
def begin(fleet, i):
    """Clock, wind, rotor commands."""
    v = fleet[i]
    note(v.physics)
    step.begin(v)


@unit
def load(fleet, i):
    """One substep of the rotors; leaves their and the air's force and torque in ``motion``."""
    p = fleet[i].physics
    m = p.motion
    m.force[0], m.force[1], m.force[2], m.torque[0], m.torque[1], m.torque[2] = wrench(p)


@unit
def sense(fleet, i):
    """Accelerations, battery, sensors."""
    v = fleet[i]
    observe(v.physics)
    step.end(v)
