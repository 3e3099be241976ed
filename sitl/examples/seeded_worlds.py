# SPDX-License-Identifier: BSD-3-Clause
"""Worlds made from a seed: forests, rooms, labyrinths and tracks, easy and hard, each the same wherever it is named.

    python examples/seeded_worlds.py

The names are good for `sitl run --world`, `Simulation(world=...)` and all environments. It draws seeded_worlds.png
and needs matplotlib.
"""

import math

import numpy as np

from sitl import worlds
from sitl.worlds import planar, raycast

try:
    import matplotlib.pyplot as plt
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install matplotlib") from None

NAMES = ("forest", "rooms", "labyrinth", "track")
RAYS, RANGE_M, HEIGHT_M = 180, 12.0, 0.5


def scan(world: worlds.World) -> np.ndarray:
    """Outline x, y [m] of what a lidar at the world's start sees."""
    start = world.starts[0]
    origin = np.array(start.north_east_down) - [0, 0, HEIGHT_M]
    rays = planar.rays(RAYS, math.tau)  # unit vectors: rows of norths, easts and downs
    ranges = np.minimum(raycast.scan(world.geometry, origin, rays, np.zeros(RAYS)), RANGE_M)
    return np.stack([origin[0] + ranges * rays[0], -(origin[1] + ranges * rays[1])])  # x is north, y is west


def main() -> None:
    """Make them, and draw their plans."""
    figure, panels = plt.subplots(2, 4, figsize=(9, 4.8), layout="constrained")
    for row, difficulty in zip(panels, (0.2, 0.9)):
        for axes, name in zip(row, NAMES):
            text = f"{name}:seed=7,difficulty={difficulty}"
            world = worlds.load(text)
            axes.fill(*scan(world), color="tab:orange", alpha=0.3, linewidth=0)
            for solid in world.solids:
                axes.fill(*solid.footprint().T, color="0.2")
            axes.set_title(text, fontsize=7)
            axes.set(aspect="equal", xticks=[], yticks=[])
            print(f"{text}: {len(world.solids)} solids")
    figure.savefig("seeded_worlds.png", dpi=80)


if __name__ == "__main__":
    main()
