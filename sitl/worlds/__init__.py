# SPDX-License-Identifier: BSD-3-Clause
"""Worlds as data: one file a world (``data/*.toml``, or a file of the user's own); ray casting and contacts in them."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from .generated import GENERATORS, generate, is_generated
from .geometry import Geometry
from .loader import read
from .shapes import Box, Cylinder, Lap, Marking, Solid, Start, WorldError
from .world import World

__all__ = [
    "Box",
    "Cylinder",
    "Geometry",
    "Lap",
    "Marking",
    "Solid",
    "Start",
    "World",
    "WorldError",
    "load",
    "names",
]

_DATA = Path(__file__).parent / "data"
_NAMES = (
    "circuit",
    "circuit2",
    "maze",
    "round",
    "maze_erlerover",
    "office_erlecopter",
    "circuit2c",
    "circuit3",
    "circle",
    "open",
)
"""The six of the paper, then those of gym-gazebo that were not in it."""


def names() -> tuple[str, ...]:
    """Names of the worlds that ``load`` knows."""
    return _NAMES


def load(name: str | Path | World) -> World:
    """A world by its name (hyphens and underscores are the same), one that is made ("forest:seed=3,difficulty=0.8"; see
    ``generated``), or by the path of a .toml file; a world is returned as it is.

    Raises:
        WorldError: no world of that name (the message lists those there are), or the file cannot be used.
    """
    if isinstance(name, World):
        return name
    if not isinstance(name, str | Path):
        raise WorldError(f"world {name!r} is neither a name, a .toml file nor a World")
    if isinstance(name, Path) or name.endswith(".toml"):
        return read(Path(name))
    known = name.strip().lower().replace("-", "_")
    if is_generated(name):
        return _generated(name)
    if known not in _NAMES:
        made = ", ".join(f'"{kind}:seed=1"' for kind in GENERATORS)
        raise WorldError(f"world {name!r} is not known; it is one of {', '.join(_NAMES)}, {made}, or a .toml file")
    return _shipped(known)


@cache
def _generated(text: str) -> World:
    return generate(text)


@cache
def _shipped(name: str) -> World:
    return read(_DATA / f"{name}.toml")
