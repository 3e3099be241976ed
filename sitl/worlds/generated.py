# SPDX-License-Identifier: BSD-3-Clause
"""Worlds that are made from a seed, as easy or difficult as one likes.

A text names one: ``"forest"``, ``"labyrinth:seed=7,difficulty=0.8"``. The same text gives the same world everywhere.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from sitl.core.elementary import hypot, pow

from . import courses
from .making import KEYS, made, wall
from .shapes import Box, Cylinder, Solid, WorldError
from .world import World

Door = tuple[bool, float, float, float]
"""Whether its wall stands across x, where the wall stands, where the door begins and ends [m]."""
MOST_SEED = (1 << 32) - 1
SMALLEST, LARGEST = 10.0, 200.0
"""Limits of a side [m]."""


def forest(seed: int = 0, difficulty: float = 0.5, size: float = 40.0, scale: float = 1.0) -> World:
    """Trees, thicker and closer together the more difficult it is; a clearing of 3 m round the start in the middle.

    Args:
        seed: of the positions of the trees.
        difficulty: 0: a tree each 60 m^2; 1: one each 8 m^2. Between two trees are 1.2 m at least.
        size: side of the square [m].
        scale: gaps, doors and corridors are so many times as wide, for robots that need more room.
    """
    rng = np.random.default_rng([1, seed])
    wanted = round(size * size / (60.0 * pow(8.0 / 60.0, difficulty)) / (scale * scale))
    trees: list[tuple[float, float, float]] = []
    for _ in range(20 * wanted):
        x, y = rng.uniform(-0.5 * size, 0.5 * size, 2).tolist()
        radius = float(rng.uniform(0.12, 0.2 + 0.2 * difficulty))
        is_free = hypot(x, y) > 3.0 * scale + radius
        if is_free and all(_is_longer(x - a, y - b, 1.2 * scale + radius + r) for a, b, r in trees):
            trees.append((x, y, radius))
        if len(trees) == wanted:
            break
    solids = [Cylinder((x, y, 4.0), radius, 8.0, f"tree {k}", "brown") for k, (x, y, radius) in enumerate(trees, 1)]
    return made("forest", (seed, difficulty, size, scale), solids, f"A forest of {len(trees)} trees.")


def _is_longer(x: float, y: float, length: float) -> bool:
    """Whether (x, y) is longer than this; most are so along one axis alone."""
    return abs(x) > length or abs(y) > length or hypot(x, y) > length


def rooms(seed: int = 0, difficulty: float = 0.5, size: float = 20.0, scale: float = 1.0) -> World:
    """A house: a square that walls part into rooms, with a door in each wall.

    Args:
        seed: of walls and doors.
        difficulty: 0: rooms of 6 m at least and doors 2 m wide; 1: 3 m and 1.1 m.
        size: side of the square [m].
        scale: gaps, doors and corridors are so many times as wide, for robots that need more room.
    """
    rng = np.random.default_rng([2, seed])
    smallest, door = scale * (6.0 - 3.0 * difficulty), scale * (2.0 - 0.9 * difficulty)
    half = 0.5 * size
    solids: list[Solid] = list(_around(half))
    todo, doors = [(-half, -half, half, half)], list[Door]()
    while todo:
        x0, y0, x1, y1 = todo.pop()
        along_x = x1 - x0 >= y1 - y0
        low, high = (x0, x1) if along_x else (y0, y1)
        if high - low < 2.0 * smallest:
            continue
        drawn = rng.uniform(low + smallest, high - smallest, 50).tolist()
        ends_at = (y0, y1) if along_x else (x0, x1)
        at = next((a for a in drawn if abs(a) > scale and not _meets_door(doors, along_x, a, ends_at)), None)
        if at is None:
            continue
        first, last = (y0, y1) if along_x else (x0, x1)
        gap = float(rng.uniform(first + 0.3, last - 0.3 - door))
        doors.append((along_x, at, gap, gap + door))
        for a, b in ((first, gap), (gap + door, last)):
            begin, end = ((at, a), (at, b)) if along_x else ((a, at), (b, at))
            solids.append(wall(begin, end, f"wall {len(solids)}"))
        halves = [(x0, y0, at, y1), (at, y0, x1, y1)] if along_x else [(x0, y0, x1, at), (x0, at, x1, y1)]
        todo += halves
    return made("rooms", (seed, difficulty, size, scale), solids, "A house of rooms with doors.")


def labyrinth(seed: int = 0, difficulty: float = 0.5, size: float = 20.0, scale: float = 1.0) -> World:
    """A labyrinth on a grid: one can get from everywhere to everywhere.

    Args:
        seed: of the walls.
        difficulty: 0: corridors 4 m wide and many loops; 1: 2 m, and one way only.
        size: side of the square [m].
        scale: gaps, doors and corridors are so many times as wide, for robots that need more room.
    """
    rng = np.random.default_rng([3, seed])
    n = max(int(size / (scale * (4.0 - 2.0 * difficulty))) | 1, 3)  # odd: the start is in the middle of a cell
    cell, half = size / n, 0.5 * size
    walls = {(i, j, side) for i in range(n) for j in range(n) for side in (0, 1) if (i, j)[side] < n - 1}
    seen, path = {(0, 0)}, [(0, 0)]
    while path:
        i, j = path[-1]
        near = [c for c in ((i + 1, j), (i - 1, j), (i, j + 1), (i, j - 1)) if c not in seen and _inside(c, n)]
        if not near:
            path.pop()
            continue
        there = near[int(rng.integers(len(near)))]
        walls.discard(_between((i, j), there))
        seen.add(there)
        path.append(there)
    kept = [wall for wall in sorted(walls) if rng.random() >= 0.4 * (1.0 - difficulty)]
    solids: list[Solid] = list(_around(half))
    for i, j, side in kept:
        x, y = cell * (i + (side == 0)) - half, cell * (j + (side == 1)) - half
        end = (x, y + cell) if side == 0 else (x + cell, y)
        solids.append(wall((x, y), end, f"wall {len(solids)}"))
    return made("labyrinth", (seed, difficulty, size, scale), solids, f"A labyrinth of {n} x {n} cells.")


GENERATORS: dict[str, Callable[..., World]] = {
    "forest": forest, "rooms": rooms, "labyrinth": labyrinth,
    "track": courses.track, "slalom": courses.slalom, "car_park": courses.car_park,
}  # fmt: skip
"""By name."""


def is_generated(text: str) -> bool:
    """Whether a text names a world that is made."""
    return text.partition(":")[0].strip().lower().replace("-", "_") in GENERATORS


def generate(text: str) -> World:
    """The world that a text names: "forest:seed=3,difficulty=0.2,size=60"; what is not said is as usual.

    Raises:
        WorldError: a key or value that is not allowed.
    """
    name, _, rest = text.partition(":")
    given: dict[str, float] = {}
    for pair in filter(None, (part.strip() for part in rest.split(","))):
        key, _, value = pair.partition("=")
        if key not in KEYS:
            raise WorldError(f"world {text!r}: {key!r} is not known; there are {', '.join(KEYS)}")
        if ".." in value:
            raise WorldError(f"world {text!r}: one world has one {key}; a range stands for a list of worlds")
        try:
            given[key] = KEYS[key](value)
        except ValueError:
            raise WorldError(f"world {text!r}: {key}={value!r} is no number") from None
    if not 0 <= given.get("seed", 0) <= MOST_SEED:
        raise WorldError(f"world {text!r}: seed must be 0 .. {MOST_SEED}")
    if not 0.0 <= given.get("difficulty", 0.0) <= 1.0:
        raise WorldError(f"world {text!r}: difficulty must be 0 .. 1")
    if not SMALLEST <= given.get("size", SMALLEST) <= LARGEST:
        raise WorldError(f"world {text!r}: size must be {SMALLEST:g} .. {LARGEST:g} m")
    if not 0.2 <= given.get("scale", 1.0) <= 20.0:
        raise WorldError(f"world {text!r}: scale must be 0.2 .. 20")
    return GENERATORS[name.strip().lower().replace("-", "_")](**given)


def _around(half: float) -> Iterator[Box]:
    corners = [(-half, -half), (half, -half), (half, half), (-half, half)]
    for k, (a, b) in enumerate(zip(corners, corners[1:] + corners[:1]), 1):
        yield wall(a, b, f"outer wall {k}")


def _meets_door(doors: list[Door], along_x: bool, at: float, ends: tuple[float, float]) -> bool:
    """Whether a wall that stands at ``at`` ends in a door of one of the walls that it runs to."""
    return any(
        crosses_x != along_x and where in ends and first - 0.3 < at < last + 0.3
        for crosses_x, where, first, last in doors
    )


def _inside(cell: tuple[int, int], n: int) -> bool:
    return 0 <= cell[0] < n and 0 <= cell[1] < n


def _between(a: tuple[int, int], b: tuple[int, int]) -> tuple[int, int, int]:
    """The wall between two cells side by side."""
    i, j = min(a, b)
    return i, j, 0 if a[1] == b[1] else 1
