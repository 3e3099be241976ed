# SPDX-License-Identifier: BSD-3-Clause
"""SPIN: holds its place and turns at 30 degrees a second; a mode of another package."""

from __future__ import annotations

import math

from sitl.autopilot.copter.modes import auto_yaw, brake, ground
from sitl.autopilot.copter.modes.mode import CopterMode, never_arms
from sitl.autopilot.copter.state import Vehicle
from sitl.core.kernels import law

RATE = math.radians(30.0)


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    if ground.is_grounded(ap.arming):
        ground.rest(ap.arming.armed, ap.control, ap.estimate, ap.params)
    else:
        auto_yaw.turn_at(ap.modes.auto_yaw, RATE, ap.control.attitude, ap.estimate)
        ground.hold(ap.modes.auto_yaw, ap.control, ap.estimate, ap.params)


MODE = CopterMode(
    number=99,
    name="SPIN",
    start=brake.start,
    run=run,
    needs_position=True,
    autonomous=True,
    may_arm=never_arms,
)
