# SPDX-License-Identifier: BSD-3-Clause
"""The world file format as data: every table, every key, its unit and what is allowed.

The loader checks files against this; ``docs/worlds.md`` explains the same keys (a test compares them).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

FAR = 10_000.0
"""Greatest coordinate or size [m]."""
THIN = 0.001
"""Least size [m]."""
COLOURS = {
    "black": (0.08, 0.08, 0.08), "blue": (0.16, 0.32, 0.75), "brown": (0.45, 0.30, 0.18), "green": (0.20, 0.55, 0.25),
    "grey": (0.55, 0.55, 0.55), "orange": (0.93, 0.55, 0.13), "purple": (0.50, 0.25, 0.60), "red": (0.80, 0.15, 0.13),
    "white": (0.95, 0.95, 0.95), "yellow": (0.93, 0.82, 0.20),
}  # fmt: skip
"""Name -> shares of red, green and blue that it reflects, which cameras see."""


@dataclass(frozen=True)
class Key:
    """One key of a table."""

    kind: str
    """"text", "number", "colour", or "point": a list of ``count`` numbers."""
    doc: str
    required: bool = False
    count: int = 0
    low: float = -FAR
    high: float = FAR
    unit: str = "m"

    @property
    def allowed(self) -> str:
        """What may stand there, in words."""
        if self.kind == "text":
            return "a text in quotes"
        if self.kind == "colour":
            return "one of " + ", ".join(COLOURS)
        limits = f"from {self.low:g} to {self.high:g}" + (f" [{self.unit}]" if self.unit else "")
        if self.kind == "point":
            return f"{self.count} numbers in a list, each {limits}"
        return f"a number {limits}"


def text(doc: str, required: bool = False) -> Key:
    """A text."""
    return Key("text", doc, required)


def number(doc: str, low: float = -FAR, high: float = FAR, unit: str = "m", required: bool = False) -> Key:
    """A number within limits."""
    return Key("number", doc, required, 0, low, high, unit)


def point(doc: str, count: int, low: float = -FAR, required: bool = True) -> Key:
    """A list of lengths."""
    return Key("point", doc, required, count, low)


_COLOUR = Key("colour", "in pictures by a camera (grey when absent)")
_YAW = number("turned about z, counter-clockwise from above", -360.0, 360.0, "degrees")

TABLES: dict[str, dict[str, Key]] = {
    "world": {
        "name": text("of the world; the file's name when absent"),
        "description": text("what it is"),
        "source": text("where its sizes come from"),
        "plan_height": number("height at which plans are cut (0.5 when absent)"),
    },
    "floor": {
        "z": number("height of the floor (0 when absent); it has no edge"),
        "friction": number("coefficient (1 when absent)", 0.0, 10.0, ""),
    },
    "box": {
        "name": text("of the box"),
        "centre": point("x, y, z of its middle", 3),
        "size": point("full lengths along its own x and y, and along z", 3, THIN),
        "yaw_deg": _YAW,
        "colour": _COLOUR,
    },
    "cylinder": {
        "name": text("of the cylinder"),
        "centre": point("x, y, z of its middle", 3),
        "radius": number("of the circle", THIN, required=True),
        "height": number("from underside to top", THIN, required=True),
        "colour": _COLOUR,
    },
    "segment": {
        "name": text("of the thin wall"),
        "from": point("x, y of one end", 2),
        "to": point("x, y of the other end", 2),
        "z": point("heights of its underside and its top", 2),
        "thickness": number("of the wall (0.01 when absent)", THIN),
        "colour": _COLOUR,
    },
    "start": {
        "name": text("of the pose", required=True),
        "robot": text("that it is meant for; any robot when absent"),
        "position": point("x, y and z of the robot's base", 3),
        "yaw_deg": _YAW,
    },
    "marking": {
        "name": text("of what is painted on the floor (drawn only)"),
        "centre": point("x, y", 2),
        "radius": number("of a disc", THIN),
        "size": point("of a rectangle: full lengths along its own x and y", 2, THIN, required=False),
        "yaw_deg": _YAW,
        "colour": Key("colour", "of the paint (grey when absent)"),
    },
    "lap": {
        "name": text("of the way round", required=True),
        "length": number("of one lap", 0.0, 1e6, required=True),
        "clearance": number("distance to walls that the path keeps", 0.0),
    },
}
"""Table -> key -> what it is."""

SINGLE = ("world", "floor")
"""Tables that a file has once (``[world]``); the others are lists (``[[box]]``)."""


def written(table: str) -> str:
    """A table's name as it stands in a file."""
    return f"[{table}]" if table in SINGLE else f"[[{table}]]"


def is_number(value: Any) -> bool:
    """Whether the value is a number in a TOML file (true and false are not)."""
    return isinstance(value, int | float) and not isinstance(value, bool)
