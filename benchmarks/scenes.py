# SPDX-License-Identifier: BSD-3-Clause
"""Where the speed of everything is measured: a vehicle of each kind at its work in GUIDED."""

from __future__ import annotations

from typing import Any

import numpy as np

from sitl.missions.pilot import VELOCITY_ONLY, Pilot
from sitl.simulation import Core, Simulation

Array = np.ndarray[Any, Any]

SPEED = 1.0
"""Of the set-points [m/s]: every rover reaches it."""


def begin(frame: str, core: Core, estimator: str = "ekf") -> Pilot:
    """A copter hovers at 10 m, a rover drives north at a velocity; both have settled."""
    pilot = Pilot(Simulation(frame, core=core, estimator=estimator))
    pilot.boot()
    pilot.arm()
    if core.kind.name == "copter":
        pilot.send_command("NAV_TAKEOFF", altitude=10.0)
        pilot.fly(20.0)
    else:
        pilot.stream_setpoint(20.0, VELOCITY_ONLY, (SPEED, 0.0, 0.0))
    return pilot


def go_on(core: Core, vehicles: Array) -> None:
    """Where no client repeats it, the rovers' velocity has just come again: without, they stop after 3 s."""
    if core.kind.name == "rover":
        vehicles["autopilot"]["modes"]["guided"]["update_us"] = vehicles["time_us"]
