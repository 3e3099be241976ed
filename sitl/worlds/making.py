# SPDX-License-Identifier: BSD-3-Clause
"""What worlds from a seed are made with: walls, and the world's name and ground."""

from __future__ import annotations

from collections.abc import Sequence

from sitl.core.elementary import atan2, hypot

from .shapes import Box, Marking, Solid, Start
from .world import World

WALL = 0.1
"""Thickness of walls [m]."""
KEYS = {"seed": int, "difficulty": float, "size": float, "scale": float}
"""What the text of such a world can say, in order."""
ORIGIN = Start("middle", (0.0, 0.0, 0.0), 0.0)


def made(
    name: str,
    numbers: tuple[int, float, float, float],
    solids: Sequence[Solid],
    description: str,
    start: Start = ORIGIN,
    markings: Sequence[Marking] = (),
    ground: Marking | None = None,
) -> World:
    """The world, whose name is the text that makes it.

    Args:
        name: of the kind of world.
        numbers: seed, difficulty, size [m], scale.
        solids: in it.
        description: a line for people.
        start: the start pose.
        markings: painted on the ground.
        ground: the ground itself; None: the square of the size about the origin.
    """
    full = name + ":" + ",".join(f"{key}={_written(value)}" for key, value in zip(KEYS, numbers))
    ground = ground or Marking((0.0, 0.0), size=(numbers[2], numbers[2]), colour="white", name="ground")
    return World(full, tuple(solids), (start,), description, plan_height=1.0, markings=(ground, *markings))


def _written(number: float) -> str:
    """All digits that ``generate`` needs to make the same number again."""
    return repr(number).removesuffix(".0")


def wall(a: tuple[float, float], b: tuple[float, float], name: str) -> Box:
    """An upright wall of 3 m from one point to another."""
    length, yaw = hypot(b[0] - a[0], b[1] - a[1]), atan2(b[1] - a[1], b[0] - a[0])
    return Box((0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 1.5), (length + WALL, WALL, 3.0), yaw, name)
