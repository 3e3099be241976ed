# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.ray_casting``: lidar scans, camera pictures a second on one core, beside PyBullet's scans."""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable

import numpy as np

from sitl import worlds
from sitl.worlds import planar, raycast
from sitl.worlds.camera import Camera, Photographer
from sitl.worlds.shapes import Box, Start
from sitl.worlds.world import World

FIELD_OF_VIEW = math.radians(270.0)
RANGE = 20.0
RAYS = (36, 270)
PLACES = 50
PICTURE = Camera(64, 48, 1.0, RANGE)
SEEN_WORLDS = ("maze", "office_erlecopter", "forest:seed=1", "rooms:seed=1")


def thirty_boxes() -> World:
    """30 boxes strewn over 20 x 20 m."""
    rng = np.random.default_rng(1)
    boxes = tuple(
        Box((*rng.uniform(-10, 10, 2), 0.5), (*rng.uniform(0.2, 2.0, 2), 1.0), rng.uniform(-3, 3)) for _ in range(30)
    )
    return World("30 boxes", boxes, (Start("origin", (0.0, 0.0, 0.0), 0.0),))


def places(world: World) -> list[np.ndarray]:
    """Places at the height of the plan, clear of solids."""
    rng, (x1, y1, x2, y2) = np.random.default_rng(0), world.bounds
    found: list[np.ndarray] = []
    while len(found) < PLACES:
        origin = np.array([rng.uniform(x1, x2), -rng.uniform(y1, y2), -world.plan_height])
        if raycast.scan(world.geometry, origin, planar.rays(8, FIELD_OF_VIEW), np.zeros(8)).min() > 0.0:
            found.append(origin)
    return found


def per_second(scan: Callable[[np.ndarray], object], origins: list[np.ndarray]) -> float:
    """Scans a second: the best of several runs."""
    best = math.inf
    for _ in range(7):
        start = time.process_time()
        for origin in origins:
            scan(origin)
        best = min(best, time.process_time() - start)
    return len(origins) / best


def ours(world: World, count: int) -> float:
    """Our scans a second."""
    geometry, rays, out = world.geometry, planar.rays(count, FIELD_OF_VIEW), np.zeros(count)
    return per_second(lambda origin: raycast.scan(geometry, origin, rays, out), places(world))


def pybullets(world: World, count: int) -> float:
    """Scans a second of PyBullet's rayTestBatch, 0 where it is not installed."""
    try:
        import pybullet
    except ImportError:
        return 0.0
    pybullet.connect(pybullet.DIRECT)
    for box in world.solids:
        assert isinstance(box, Box)
        shape = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=[0.5 * s for s in box.size])
        turn = [0.0, 0.0, math.sin(0.5 * box.yaw), math.cos(0.5 * box.yaw)]
        pybullet.createMultiBody(0, shape, -1, box.centre, turn)
    rays = planar.rays(count, FIELD_OF_VIEW).T * (RANGE, -RANGE, -RANGE)

    def scan(origin: np.ndarray) -> object:
        start = origin * (1.0, -1.0, -1.0)
        return pybullet.rayTestBatch([start.tolist()] * count, (start + rays).tolist())

    result = per_second(scan, places(world))
    pybullet.disconnect()
    return result


def pictures(world: World) -> tuple[float, float]:
    """Pictures of depth, and of colour, a second: level cameras at random places and headings."""
    photographer, turns = Photographer(world, PICTURE), np.random.default_rng(2).uniform(-math.pi, math.pi, PLACES)
    cameras = [
        np.array([[*origin, math.cos(0.5 * turn), 0.0, 0.0, math.sin(0.5 * turn)]])
        for origin, turn in zip(places(world), turns.tolist())
    ]
    return per_second(photographer.depths, cameras), per_second(photographer.colours, cameras)


def main() -> None:
    """Print the tables."""
    argparse.ArgumentParser(prog="python -m benchmarks.ray_casting", description=__doc__).parse_args()
    print("| world | " + " | ".join(f"{count} rays" for count in RAYS) + " |\n|---|---|---|")
    reference = thirty_boxes()
    for world in (reference, *map(worlds.load, worlds.names())):
        if world.solids:
            cells = [f"{ours(world, count):,.0f} scans/s" for count in RAYS]
            print(f"| {world.name} ({len(world.solids)} solids) | " + " | ".join(cells) + " |")
    others = [pybullets(reference, count) for count in RAYS]
    if all(others):
        cells = [f"{rate:,.0f} scans/s ({ours(reference, n) / rate:.0f}x slower)" for n, rate in zip(RAYS, others)]
        print("| PyBullet's rayTestBatch, the 30 boxes | " + " | ".join(cells) + " |")
    print(f"\n| world, {PICTURE.width} x {PICTURE.height} pixels | depth | colour |\n|---|---|---|")
    for world in map(worlds.load, SEEN_WORLDS):
        depth, colour = pictures(world)
        print(f"| {world.name} ({len(world.solids)} solids) | {depth:,.0f} pictures/s | {colour:,.0f} pictures/s |")


if __name__ == "__main__":
    main()
