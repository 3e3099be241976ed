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
    ap = v.autopilot
    motors.set_throttle(ap.control.motors, ap.arming.armed, 0.0, ap.params.MOT)
    motors.set_steering(ap.control.motors, 0.0)


MODE = RoverMode(number=HOLD, name="HOLD", run=run, controlled=False)
