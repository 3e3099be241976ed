# SPDX-License-Identifier: BSD-3-Clause
"""``python docs/draw_swarm.py``: flies examples/swarm_formation.py, and draws the paths of swarm.md."""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "examples"))
import swarm_formation  # noqa: E402

plt.rcParams.update({"font.size": 13, "legend.fontsize": 12, "axes.titlesize": 14})

COUNT = 16


def flown() -> swarm_formation.Swarm:
    """The vehicles after the flight."""
    with tempfile.TemporaryDirectory() as logs:
        command = [sys.executable, "-m", "sitl", "run", "copter", "--count", str(COUNT), "--lockstep", "--quiet"]
        vehicles = subprocess.Popen(
            [*command, "--tcp", "0", "--out", "none", "--log-dir", logs], cwd=ROOT, stdout=subprocess.PIPE, text=True
        )
        try:
            assert vehicles.stdout is not None
            said = re.search(r"tcp:127\.0\.0\.1:(\d+)", vehicles.stdout.readline())
            assert said is not None
            swarm = swarm_formation.Swarm(f"tcp:127.0.0.1:{said.group(1)}", COUNT, lockstep=True)
            swarm_formation.fly(swarm)
        finally:
            vehicles.terminate()
            vehicles.wait()
    return swarm


def main() -> None:
    """Draw images/swarm.png."""
    swarm = flown()
    figure, ax = plt.subplots(figsize=(7.5, 5.2))
    colours = plt.get_cmap("twilight")
    for system, track in swarm.tracks.items():
        north, east, _ = zip(*track, strict=True)
        ax.plot(east, north, lw=0.9, color=colours(system / (COUNT + 1)))
        ax.plot(east[0], north[0], "ks", ms=5, label="start" if system == 1 else None)
    for k, (_, places) in enumerate(swarm.formations):
        label = "place in a formation" if k == 0 else None
        ax.plot([east for _, east in places], [north for north, _ in places], ".", color="0.2", ms=7, label=label)
    ax.set(xlabel="east [m]", ylabel="north [m]", aspect="equal")
    ax.set_title(f"{COUNT} copters, each in its colour")
    ax.legend(loc="upper right")
    ax.grid(alpha=0.25)
    figure.tight_layout()
    figure.savefig(Path(__file__).parent / "images" / "swarm.png", dpi=100)


if __name__ == "__main__":
    main()
