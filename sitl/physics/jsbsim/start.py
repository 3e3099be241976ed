# SPDX-License-Identifier: BSD-3-Clause
"""Starting JSBSim from a given motion, so that equal motions start alike to the last bit whatever was before."""

from __future__ import annotations

from typing import Any, NamedTuple

from ...core.vectors import Euler, Vec3
from .aircraft import RADIUS
from .model import FOOT

_EULER, _BUSS2 = 1.0, 7.0
_INTEGRATORS = (
    ("simulation/integrator/rate/rotational", _EULER),
    ("simulation/integrator/rate/translational", _EULER),
    ("simulation/integrator/position/rotational", _BUSS2),
    ("simulation/integrator/position/translational", _EULER),
)
_GRIP = "ground/static-friction-factor"
_ORIGIN = [
    (f"ic/{name}", 0.0)
    for _ in range(4)
    for name in ("psi-true-rad", "theta-rad", "phi-rad", "lat-gc-rad", "long-gc-rad", "h-sl-ft")
]
"""JSBSim works each condition into those set before, and rounds: from here all starts are alike. Each round leaves
angles that are smaller than a rounding error of those that the one before has left."""


class Motion(NamedTuple):
    """How a vehicle moves."""

    position: tuple[float, float, float]
    """Of the centre of mass: north, east, height over the floor [m]."""
    velocity: Vec3
    """NED [m/s]."""
    euler: Euler
    """[rad]"""
    rates: Vec3
    """Body [rad/s]."""


def begin(executive: Any, motion: Motion) -> None:
    """Put the vehicle where it is and let JSBSim work out what follows, but for friction.

    Friction is solved for from the last solution, and the wind of initial conditions is one of rounding errors; so the
    last solution is made to be zero here, and ``settle`` does it again with what truly acts.
    """
    set_value = executive.set_property_value
    north, east, height = motion.position
    for name, value in _ORIGIN:
        set_value(name, value)
    set_value("ic/terrain-elevation-ft", 0.0)
    for _ in range(2):
        set_value("ic/h-sl-ft", height / FOOT)
        set_value("ic/lat-gc-rad", north / RADIUS)
        set_value("ic/long-gc-rad", east / RADIUS)
    for name, angle in zip(("phi", "theta", "psi-true"), motion.euler, strict=True):
        set_value(f"ic/{name}-rad", angle)
    for name, speed in zip(("vn", "ve", "vd"), motion.velocity, strict=True):
        set_value(f"ic/{name}-fps", speed / FOOT)
    for name, rate in zip("pqr", motion.rates, strict=True):
        set_value(f"ic/{name}-rad_sec", rate)
    set_value(_GRIP, 0.0)
    executive.reset_to_initial_conditions(0)
    for name, value in _INTEGRATORS:
        set_value(name, value)
    set_value(_GRIP, 1.0)


def settle(executive: Any) -> None:
    """Work out once more what acts on the vehicle; it does not move."""
    executive.suspend_integration()
    executive.run()
    executive.resume_integration()
