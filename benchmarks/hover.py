# SPDX-License-Identifier: BSD-3-Clause
"""A copter hovering at 10 m in GUIDED, where the speed of everything is measured."""

from __future__ import annotations

from missions.pilot import TAKEOFF, Pilot
from sitl.simulation import Core, Simulation


def hovering(frame: str, core: Core, estimator: str = "ekf") -> Pilot:
    """Boot, arm, climb to 10 m and settle."""
    pilot = Pilot(Simulation(frame, core=core, estimator=estimator))
    pilot.boot()
    pilot.arm()
    pilot.client.command(TAKEOFF, 0, 0, 0, 0, 0, 0, 10.0)
    pilot.fly(20.0)
    return pilot
