# SPDX-License-Identifier: BSD-3-Clause
"""CRUISE: drives straight on at WP_SPEED; a mode of another package."""

from __future__ import annotations

from sitl.autopilot.rover.control import speed
from sitl.autopilot.rover.modes import drive
from sitl.autopilot.rover.modes.mode import RoverMode
from sitl.autopilot.rover.state import Vehicle
from sitl.core.kernels import law


@law
def run(v: Vehicle) -> None:
    """One period."""
    ap = v.autopilot
    drive.turn(ap.control, ap.estimate, ap.modes.pilot, 0.0, ap.params)
    speed.drive(ap.control, ap.arming.armed, ap.params.WP.SPEED, ap.params)


MODE = RoverMode(number=77, name="CRUISE", run=run, needs_position=True, autonomous=True)
