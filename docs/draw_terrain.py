# SPDX-License-Identifier: BSD-3-Clause
"""``python docs/draw_terrain.py``: flies what the picture of terrain.md shows, and draws it."""

from __future__ import annotations

import math
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from sitl import Simulation
from sitl.client import Client
from sitl.client.terrain import TerrainAnswers

plt.rcParams.update({"font.size": 13, "legend.fontsize": 12, "axes.titlesize": 14})

LAT, LON, ALT = -35.363262, 149.165237, 584.0
ABOVE_GROUND, ABOVE_HOME = 10, 3
"""MAV_FRAMEs."""


def rise(north: float) -> float:
    """Height of the ground over home's [m]."""
    return 30.0 * math.exp(-(((north - 250.0) / 60.0) ** 2)) + 12.0 * math.exp(-(((north - 480.0) / 40.0) ** 2))


def flight(frame: int) -> list[tuple[float, float, float]]:
    """(North, height over home, height of the simulated ground over home) [m], five times a second."""
    client = Client(Simulation("ardupilot_quad", seed=1, home=(LAT, LON, ALT, 0.0), params={"AUTO_OPTIONS": 3}))
    TerrainAnswers(client, lambda lat, lon: ALT + rise((lat - LAT) * 111318.845)).start()
    client.wait_ready()
    client.delay(25.0)
    waypoint = client.item("NAV_WAYPOINT", 600, 0, altitude=20)._replace(frame=frame)
    client.upload([client.item("NAV_WAYPOINT"), client.item("NAV_TAKEOFF", altitude=20), waypoint])
    client.set_mode("AUTO")
    client.arm()
    physics, seen = client.simulation.v.physics, []
    while client.reached[-1:] != [2] and client.armed:
        client.delay(0.2)
        seen.append((physics.body.pos.x, -physics.body.pos.z, -physics.downward.ground_d))
    return seen


def main() -> None:
    """Draw images/terrain.png."""
    figure, ax = plt.subplots(figsize=(8, 3.8))
    rows = flight(ABOVE_GROUND)
    north, height, ground = zip(*rows, strict=True)
    ax.fill_between(north, ground, -2.0, color="0.8", label="simulated ground: points 100 m apart")
    ax.plot([*range(600)], [rise(float(n)) for n in range(600)], "k:", lw=0.8, label="ground that was asked about")
    ax.plot(north, height, label="mission at 20 m above the ground")
    ax.set(xlabel="north [m]", ylabel="height over home [m]", ylim=(-2.0, 60.0))
    ax.legend()
    figure.tight_layout()
    figure.savefig(Path(__file__).parent / "images" / "terrain.png", dpi=110)


if __name__ == "__main__":
    main()
