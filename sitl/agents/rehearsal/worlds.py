# SPDX-License-Identifier: BSD-3-Clause
"""A world that is another and yet as hard: the same one mirrored, stretched, or both."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from sitl import worlds
from sitl.worlds import World
from sitl.worlds.shapes import Box, Solid


def altered(world: str | Path | World, mirror: bool = False, stretch: float = 1.0) -> World:
    """A mirrored or stretched copy of a world; heights stay.

    Args:
        world: name, .toml file or World.
        mirror: left and right change places.
        stretch: factor of all lengths along x and y.
    """
    found = worlds.load(world)
    side = -1.0 if mirror else 1.0

    def place(position: tuple[float, float, float]) -> tuple[float, float, float]:
        x, y, z = position
        return stretch * x, side * stretch * y, z

    def solid(one: Solid) -> Solid:
        if isinstance(one, Box):
            x, y, z = one.size
            return replace(one, centre=place(one.centre), size=(stretch * x, stretch * y, z), yaw=side * one.yaw)
        return replace(one, centre=place(one.centre), radius=stretch * one.radius)

    what = [*(["mirrored"] if mirror else []), *([f"x {stretch:g}"] if stretch != 1.0 else [])]
    return World(
        name=" ".join([found.name, *what]),
        solids=tuple(solid(one) for one in found.solids),
        starts=tuple(replace(s, position=place(s.position), yaw=side * s.yaw) for s in found.starts),
        description=found.description,
        source=found.source,
        floor_z=found.floor_z,
        friction=found.friction,
        plan_height=found.plan_height,
    )
