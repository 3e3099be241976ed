# SPDX-License-Identifier: BSD-3-Clause
"""Worlds as data: one file a world (``data/*.toml``, or a file of the user's own); ray casting and contacts in them."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache, lru_cache
from pathlib import Path

from .generated import GENERATORS, generate, is_generated
from .geometry import Geometry
from .lists import WorldList
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
    "WorldList",
    "load",
    "load_all",
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


def load_all(given: str | Path | World | Sequence[str | Path | World]) -> WorldList:
    """Worlds by a list of what ``load`` takes, in which "rooms:seed=1..100" stands for a hundred, or by one of those.

    Raises:
        WorldError: see ``load`` and ``WorldList``.
    """
    if not isinstance(given, str | Path | World | Sequence):
        raise WorldError(f"worlds {given!r} are neither a name nor a list of names, .toml files and Worlds")
    return WorldList(given, load)


@lru_cache(maxsize=256)  # worlds are drawn by the thousand
def _generated(text: str) -> World:
    return generate(text)


@cache
def _shipped(name: str) -> World:
    return read(_DATA / f"{name}.toml")
