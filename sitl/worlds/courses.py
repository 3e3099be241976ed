# SPDX-License-Identifier: BSD-3-Clause
"""Worlds to drive in that are made from a seed: a race track, a slalom, a car park.

Their markings tell tasks where to drive: "gate 1", "gate 2", ... are passed in their direction
(``envs.targets.gates``), "bay 1", ... are free bays to park in (``envs.targets.parking``).
"""

from __future__ import annotations

import math

import numpy as np

from sitl.core.elementary import atan2, cos, sin

from .making import made, wall
from .shapes import Box, Cylinder, Marking, Solid, Start
from .world import World

_SIDES = 48
"""Pieces of wall on each side of a track."""
_GATES = 12
"""Of a track."""
CAR = (3.0, 1.8, 1.4)
"""Length, width, height of a parked car [m]."""
DEPTH = 4.5
"""Of a bay [m]."""


def gate(x: float, y: float, yaw: float, width: float, number: int) -> Marking:
    """A gate's line on the floor: where it is [m], the direction it is passed in [rad], its width [m]."""
    return Marking((x, y), size=(0.2, width), yaw=yaw, colour="green", name=f"gate {number}")


def track(seed: int = 0, difficulty: float = 0.5, size: float = 30.0, scale: float = 1.0) -> World:
    """A closed track between two walls, with gates across it; it is driven counter-clockwise.

    Args:
        seed: of its shape.
        difficulty: 0: almost a circle, 7 m wide; 1: with narrow bends, 4 m wide.
        size: side of the square that it lies in [m].
        scale: it is so many times as wide.
    """
    rng = np.random.default_rng([4, seed])
    a, b = difficulty * rng.uniform(0.10, 0.16), difficulty * rng.uniform(0.05, 0.10)
    first, second = rng.uniform(0.0, math.tau, 2)
    half = 0.5 * scale * (7.0 - 3.0 * difficulty)
    mean = (0.5 * size - half) / (1.0 + a + b)

    def middle(angle: float) -> tuple[float, float, float]:
        """x, y [m] and heading [rad] of the middle of the track."""
        r = mean * (1.0 + a * cos(2.0 * angle + first) + b * cos(3.0 * angle + second))
        slope = -mean * (2.0 * a * sin(2.0 * angle + first) + 3.0 * b * sin(3.0 * angle + second))
        heading = angle + atan2(r, slope)
        return r * cos(angle), r * sin(angle), heading

    turns = [middle(math.tau * k / _SIDES) for k in range(_SIDES)]
    solids: list[Solid] = []
    for side, name in ((1.0, "inner"), (-1.0, "outer")):
        edge = [(x - side * half * sin(h), y + side * half * cos(h)) for x, y, h in turns]
        solids += [wall(p, q, f"{name} wall {k}") for k, (p, q) in enumerate(zip(edge, edge[1:] + edge[:1]), 1)]
    gates = [gate(*middle(math.tau * k / _GATES), 2.0 * half, k) for k in range(1, _GATES + 1)]
    x, y, heading = middle(0.0)
    start = Start("line", (x, y, 0.0), heading)
    text = f"A track {2.0 * half:.1f} m wide."
    return made("track", (seed, difficulty, size, scale), solids, text, start, gates)


def slalom(seed: int = 0, difficulty: float = 0.5, size: float = 50.0, scale: float = 1.0) -> World:
    """Poles in a row ahead of the start; the path leads to the left of the first one, to the right of the next.

    Args:
        seed: of how far poles stand from one another, and beside the line.
        difficulty: 0: 10 m from pole to pole; 1: 6 m.
        size: length of the course [m].
        scale: poles are so many times as far apart, gates as wide.
    """
    rng = np.random.default_rng([5, seed])
    apart, width, radius = scale * (10.0 - 4.0 * difficulty), 3.0 * scale, 0.15
    solids: list[Solid] = []
    gates: list[Marking] = []
    x, side = 8.0 * scale, 1.0
    while x < size - 4.0:
        y = float(rng.uniform(-0.5, 0.5)) * scale
        solids.append(Cylinder((x, y, 1.0), radius, 2.0, f"pole {len(solids) + 1}"))
        gates.append(gate(x, y + side * (radius + 0.5 * width), 0.0, width, len(gates) + 1))
        x, side = x + apart * float(rng.uniform(0.9, 1.1)), -side
    ground = Marking((0.5 * size, 0.0), size=(size + 6.0, 20.0 * scale), colour="white", name="ground")
    text = f"A slalom of {len(solids)} poles."
    return made("slalom", (seed, difficulty, size, scale), solids, text, markings=gates, ground=ground)


def car_park(seed: int = 0, difficulty: float = 0.5, size: float = 30.0, scale: float = 1.0) -> World:
    """A lane with bays on both sides, most of them taken; a third is free, nose to the wall.

    Args:
        seed: of the bays that are free.
        difficulty: 0: bays 4.5 m wide; 1: 3 m.
        size: length of the lane [m].
        scale: lane, bays and cars are so many times as large.
    """
    rng = np.random.default_rng([6, seed])
    width, depth, lane = scale * (4.5 - 1.5 * difficulty), scale * DEPTH, scale * 6.0
    count, edge = int(size / width), lane + scale * DEPTH
    taken = np.ones(2 * count, np.bool_)
    taken[rng.choice(2 * count, max(2 * count // 3, 1), replace=False)] = False
    half = 0.5 * count * width
    corners = [(-half, -edge), (half, -edge), (half, edge), (-half, edge)]
    solids: list[Solid] = [
        wall(a, b, f"wall {k}") for k, (a, b) in enumerate(zip(corners, corners[1:] + corners[:1]), 1)
    ]
    bays: list[Marking] = []
    length, broad, high = (scale * side for side in CAR)
    for k, is_taken in enumerate(taken.tolist()):
        side = 1.0 if k < count else -1.0
        x, y, yaw = -half + width * (k % count + 0.5), side * (lane + 0.5 * depth), side * 0.5 * math.pi
        if is_taken:
            solids.append(Box((x, y, 0.5 * high), (length, broad, high), yaw, f"car {len(solids) - 3}"))
        else:
            bays.append(Marking((x, y), size=(depth, width), yaw=yaw, colour="green", name=f"bay {len(bays) + 1}"))
    text = f"A car park with {len(bays)} free bays of {2 * count}."
    return made("car_park", (seed, difficulty, size, scale), solids, text, markings=bays)
