# SPDX-License-Identifier: BSD-3-Clause
"""HOLD: motors off, wheels straight; the vehicle rolls out."""

from __future__ import annotations

from ....core.kernels import law
from ..control import motors
from ..state import Vehicle
from .mode import RoverMode

HOLD = 4


@law
def run(v: Vehicle) -> None:
    """One period."""
    motors.set_throttle(v.autopilot, 0.0)
    motors.set_steering(v.autopilot, 0.0)


MODE = RoverMode(number=HOLD, name="HOLD", run=run, controlled=False)
