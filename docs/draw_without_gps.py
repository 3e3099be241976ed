# SPDX-License-Identifier: BSD-3-Clause
"""``python docs/draw_without_gps.py``: flies what the picture of without-gps.md shows, and draws it."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from sitl import Simulation
from sitl.client import Client
from sitl.client.odometry import PARAMETERS, Odometry
from sitl.worlds.drawing import plan

plt.rcParams.update({"font.size": 13, "legend.fontsize": 12, "axes.titlesize": 14})

FLOW: dict[str, float] = {
    "EK3_SRC1_POSXY": 0, "EK3_SRC1_VELXY": 5, "EK3_SRC1_VELZ": 0, "FLOW_TYPE": 10, "SIM_FLOW_ENABLE": 1, "GPS1_TYPE": 0,
    "WPNAV_SPEED": 100,
}  # fmt: skip
WAY = ((-8.0, 0.0), (-8.0, -3.0), (0.0, -3.0), (0.0, 0.0))
MINUTES = 5


def squares(params: dict[str, float]) -> tuple[list[tuple[float, float]], Simulation]:
    """True places, north and east [m], five times a second."""
    client = Client(Simulation("erle_copter", world="office_erlecopter", params=params, seed=1))
    if "VISO_TYPE" in params:
        Odometry(client, position_noise=0.01, velocity_noise=0.02).start()
    client.delay(26)
    origin = client.simulation.v.physics.origin
    client.send("SET_GPS_GLOBAL_ORIGIN", target_system=1, latitude=origin.lat, longitude=origin.lon, altitude=584_000)
    client.delay(1)
    client.set_mode("GUIDED")
    client.arm()
    client.take_off(1)
    places = []
    body = client.simulation.v.physics.body
    for k in range(MINUTES * 6):
        client.set_position(*WAY[k % 4], 1.0)
        for _ in range(50):
            client.delay(0.2)
            places.append((body.pos.x, body.pos.y))
    return places, client.simulation


def main() -> None:
    """Draw images/without_gps.png."""
    figure, axes = plt.subplots(1, 2, figsize=(9, 4.6), sharex=True, sharey=True)
    for ax, (title, params) in zip(axes, (("optical flow", FLOW), ("odometry", PARAMETERS)), strict=True):
        places, simulation = squares(params)
        assert simulation.world is not None
        plan(ax, simulation.world, 1.0, names=False)
        ax.plot(*zip(*((n, -e) for n, e in places), strict=True), lw=0.8)
        ax.set_title(f"{MINUTES} minutes by {title}")
    figure.tight_layout()
    figure.savefig(Path(__file__).parent / "images" / "without_gps.png", dpi=110)


if __name__ == "__main__":
    main()
