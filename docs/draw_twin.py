# SPDX-License-Identifier: BSD-3-Clause
"""``python docs/draw_twin.py``: a mission, its twin, and the twin with a payload in wind, as twin.md shows them."""

from __future__ import annotations

import tempfile
from pathlib import Path

from sitl import Simulation
from sitl.missions.files import load
from sitl.missions.fly import fly
from sitl.missions.twin import plots, twin
from sitl.missions.twin.log_flight import Change
from sitl.run.runner import open_dataflash

MISSION = Path(__file__).parents[1] / "missions" / "library" / "copter" / "square.plan"
SHOWN = ("height", "speed", "roll", "pitch", "throttle", "current")


def main() -> None:
    """Draw it."""
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "square.bin"
        simulation = Simulation("erle_copter", seed=3)
        open_dataflash(simulation, log)
        assert fly(simulation, load(MISSION).mission).completed
        simulation.close()
        change = Change(wind=(8.0, 270.0), mass="+0.2")
        found = twin.fly(log, "erle_copter", change=change, segments=False)
    (Path(__file__).parent / "images" / "twin.png").write_bytes(plots.flown(found, SHOWN))


if __name__ == "__main__":
    main()
