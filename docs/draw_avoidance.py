# SPDX-License-Identifier: BSD-3-Clause
"""``python docs/draw_avoidance.py``: flies what the picture of avoidance.md shows, and draws it."""

from __future__ import annotations

import math
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from sitl import Simulation
from sitl.client import Client
from sitl.worlds.drawing import plan

plt.rcParams.update({"font.size": 13, "legend.fontsize": 12, "axes.titlesize": 14})

STICKS = ((1400, 1500), (1500, 1600), (1500, 1400), (1420, 1540))
"""Pitch and roll [us], each for 8 s; the lidar does not see behind the vehicle."""


def flown(pilot: Client, seconds: float) -> list[tuple[float, float]]:
    """North and east [m], five times a second."""
    places = []
    for _ in range(round(5 * seconds)):
        pilot.delay(0.2)
        body = pilot.simulation.v.physics.body
        places.append((body.pos.x, body.pos.y))
    return places


def in_the_office(avoids: bool) -> tuple[list[tuple[float, float]], Simulation]:
    """LOITER with the same sticks."""
    params = {"PRX1_TYPE": 10, "PRX_FILT": 0, "AVOID_MARGIN": 0.6, "AVOID_ENABLE": 3 if avoids else 1}
    pilot = Client(Simulation("erle_copter", world="office_erlecopter", params=params, seed=1, estimator="truth"))
    pilot.wait_ready()
    pilot.take_off(1.15)
    pilot.set_mode("LOITER")
    places = []
    for pitch, roll in STICKS:
        pilot.rc(pitch=pitch, roll=roll, throttle=1500)
        places += flown(pilot, 8.0)
        if pilot.simulation.v.physics.obstacles.hit_count > 0:
            break
    return places, pilot.simulation


def in_a_circle(behave: int) -> list[tuple[float, float]]:
    """GUIDED velocities north-east within 15 m of home."""
    params = {"FENCE_TYPE": 2, "FENCE_RADIUS": 15, "FENCE_MARGIN": 3, "FENCE_ENABLE": 1, "AVOID_BEHAVE": behave}
    pilot = Client(Simulation("erle_copter", params=params, seed=1, estimator="truth"))
    pilot.wait_ready()
    pilot.take_off(10)
    places = []
    for north, east in ((3.0, 0.0), (0.0, 3.0), (-3.0, -2.0), (0.0, -3.0)):
        pilot.set_velocity(north, east)
        places += flown(pilot, 12.0)
    return places


def main() -> None:
    """Write docs/images/avoidance.png."""
    figure, (office, circle) = plt.subplots(1, 2, figsize=(10, 5.8))
    for avoids, colour in ((False, "tab:red"), (True, "tab:blue")):
        places, simulation = in_the_office(avoids)
        office.plot(*zip(*((n, -e) for n, e in places), strict=True), color=colour,
                    label="AVOID_ENABLE 3" if avoids else "AVOID_ENABLE 1: into the wall")  # fmt: skip
        if not avoids:
            office.plot(places[-1][0], -places[-1][1], "x", color=colour, markersize=10)
        assert simulation.world is not None
    plan(office, simulation.world, 1.15, names=False)
    office.set_title("LOITER in the office, AVOID_MARGIN 0.6")
    for behave, name in ((0, "AVOID_BEHAVE 0: slides"), (1, "AVOID_BEHAVE 1: stops")):
        circle.plot(*zip(*((e, n) for n, e in in_a_circle(behave)), strict=True), label=name)
    for radius, style in ((15.0, "-"), (12.0, "--")):
        turn = [math.tau * k / 200 for k in range(201)]
        circle.plot([radius * math.sin(a) for a in turn], [radius * math.cos(a) for a in turn], style, color="0.3")
    circle.set_title("GUIDED, FENCE_RADIUS 15, FENCE_MARGIN 3")
    circle.set(aspect="equal", xlabel="east [m]", ylabel="north [m]")
    for axes in (office, circle):
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), frameon=False)
    figure.tight_layout()
    figure.savefig(Path(__file__).parent / "images" / "avoidance.png", dpi=100)


if __name__ == "__main__":
    main()
