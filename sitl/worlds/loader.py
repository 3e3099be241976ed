# SPDX-License-Identifier: BSD-3-Clause
"""Reads a world file (TOML) into a ``World``. What is wrong is said with file, table, place in it, key and value."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from ..core import documents
from ..core.elementary import atan2, cos, hypot, sin
from .shapes import Box, Cylinder, Lap, Marking, Solid, Start, WorldError
from .tables import COLOURS, SINGLE, TABLES, Key, is_number, written
from .world import World

_START_HEADROOM = 0.01
"""A start pose is checked this far above its z [m]: a robot's base may touch the floor or stand on a box."""


def read(path: Path) -> World:
    """The world in a file.

    Raises:
        WorldError: the file cannot be read, is not TOML, or says something that is not allowed.
    """
    try:
        content = path.read_bytes().decode("utf-8-sig")  # Windows editors begin with a mark
    except OSError as error:
        raise WorldError(f"world file {str(path)!r} cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError as error:
        raise WorldError(f"world file {str(path)!r} is not UTF-8 text: {error}") from None
    return parse(content, str(path))


def parse(content: str, file: str) -> World:
    """The world in the text of a world file; ``file`` is its name, for messages and for want of a name of its own.

    Raises:
        WorldError: as ``read``.
    """
    try:
        document = documents.toml(content)
    except tomllib.TOMLDecodeError as error:
        raise WorldError(f"world file {file!r} is not TOML: {error}") from None
    reader = _Reader(file)
    tables = reader.tables(document)
    world, floor = tables["world"][0], tables["floor"][0]
    solids = (*_boxes(tables), *_cylinders(tables), *_segments(tables))
    result = World(
        name=world.get("name", Path(file).stem),
        solids=solids,
        starts=tuple(_starts(tables)) or (Start("origin", (0.0, 0.0, floor.get("z", 0.0)), 0.0),),
        description=world.get("description", ""),
        source=world.get("source", ""),
        floor_z=floor.get("z", 0.0),
        friction=floor.get("friction", 1.0),
        plan_height=world.get("plan_height", 0.5),
        markings=tuple(_markings(tables)),
        laps=tuple(Lap(**row.values) for row in tables["lap"]),
    )
    _check_starts(result, tables["start"])
    return result


@dataclass(frozen=True)
class _Row:
    """One table of the file, checked against the format."""

    where: str
    """File, table and place in it, as messages begin."""
    values: dict[str, Any]

    def get(self, key: str, default: Any = None) -> Any:
        return self.values.get(key, default)

    def __getitem__(self, key: str) -> Any:
        return self.values[key]

    @property
    def yaw(self) -> float:
        return math.radians(self.get("yaw_deg", 0.0))

    def fault(self, key: str, says: str) -> WorldError:
        return WorldError(f"{self.where}: {key} = {self.get(key)!r} {says}")


class _Reader:
    """Checks tables, keys and values."""

    def __init__(self, file: str) -> None:
        self._file = f"world file {file!r}"

    def tables(self, document: dict[str, Any]) -> dict[str, list[_Row]]:
        """Every table of the format -> its rows."""
        for name, content in document.items():
            if name not in TABLES:
                what = f"table {name!r}" if isinstance(content, dict | list) else f"key {name!r} outside of a table"
                tables = ", ".join(written(t) for t in TABLES)
                raise WorldError(f"{self._file}: {what} is not known{_meant(name, TABLES)}; there are {tables}")
        return {name: list(self._rows(name, document.get(name))) for name in TABLES}

    def _rows(self, name: str, content: Any) -> Iterator[_Row]:
        if name in SINGLE:
            content = {} if content is None else content
            if not isinstance(content, dict):
                raise WorldError(f"{self._file}: {name} is written [{name}] and stands once")
            yield self._row(name, f"{self._file}, [{name}]", content)
            return
        rows = [] if content is None else content
        if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
            raise WorldError(f"{self._file}: {name} is written [[{name}]], with double brackets, once for each")
        for index, row in enumerate(rows, 1):
            label = row.get("name")
            label = f" {label!r}" if isinstance(label, str) else ""
            yield self._row(name, f"{self._file}, [[{name}]] number {index}{label}", row)

    def _row(self, table: str, where: str, content: dict[str, Any]) -> _Row:
        keys = TABLES[table]
        for key in content:
            if key not in keys:
                allowed = ", ".join(keys)
                raise WorldError(f"{where}: key {key!r} is not known{_meant(key, keys)}; there are {allowed}")
        for name, wanted in keys.items():
            if wanted.required and name not in content:
                raise WorldError(f"{where}: {name} is missing; it is {wanted.allowed} ({wanted.doc})")
        return _Row(where, {name: self._value(where, name, keys[name], value) for name, value in content.items()})

    def _value(self, where: str, name: str, key: Key, value: Any) -> Any:
        good = {
            "text": lambda: isinstance(value, str),
            "colour": lambda: isinstance(value, str) and value in COLOURS,
            "number": lambda: _within(key, value),
            "point": lambda: (
                isinstance(value, list) and len(value) == key.count and all(_within(key, number) for number in value)
            ),
        }[key.kind]()
        if not good:
            raise WorldError(f"{where}: {name} = {value!r} must be {key.allowed}")
        if key.kind == "number":
            return float(value)
        return tuple(float(number) for number in value) if key.kind == "point" else value


def _within(key: Key, value: Any) -> bool:
    return is_number(value) and key.low <= value <= key.high  # not so for nan


def _meant(word: str, known: Any) -> str:
    close = get_close_matches(word, list(known), 1)
    return f" (did you mean {close[0]!r}?)" if close else ""


def _boxes(tables: dict[str, list[_Row]]) -> Iterator[Solid]:
    for row in tables["box"]:
        yield Box(row["centre"], row["size"], row.yaw, row.get("name", ""), row.get("colour", "grey"))


def _cylinders(tables: dict[str, list[_Row]]) -> Iterator[Solid]:
    for row in tables["cylinder"]:
        yield Cylinder(row["centre"], row["radius"], row["height"], row.get("name", ""), row.get("colour", "grey"))


def _segments(tables: dict[str, list[_Row]]) -> Iterator[Solid]:
    """Thin walls: boxes by their ends."""
    for row in tables["segment"]:
        (x1, y1), (x2, y2), (low, high) = row["from"], row["to"], row["z"]
        if (x1, y1) == (x2, y2):
            raise row.fault("to", "is the same point as 'from'; a wall has two ends")
        if not low < high:
            raise row.fault("z", "must be the height of the underside and then that of the top, above it")
        centre = (0.5 * (x1 + x2), 0.5 * (y1 + y2), 0.5 * (low + high))
        size = (hypot(x2 - x1, y2 - y1), row.get("thickness", 0.01), high - low)
        yield Box(centre, size, atan2(y2 - y1, x2 - x1), row.get("name", ""), row.get("colour", "grey"))


def _starts(tables: dict[str, list[_Row]]) -> Iterator[Start]:
    seen: dict[str, str] = {}
    for row in tables["start"]:
        if row["name"] in seen:
            raise row.fault("name", "is there twice; every start has a name of its own")
        seen[row["name"]] = row.where
        yield Start(row["name"], row["position"], row.yaw, row.get("robot"))


def _markings(tables: dict[str, list[_Row]]) -> Iterator[Marking]:
    for row in tables["marking"]:
        if ("radius" in row.values) == ("size" in row.values):
            raise WorldError(f"{row.where}: must have either 'radius' (a disc) or 'size' (a rectangle)")
        yield Marking(
            row["centre"],
            row.get("radius", 0.0),
            row.get("size", (0.0, 0.0)),
            row.yaw,
            row.get("colour", "grey"),
            row.get("name", ""),
        )


def _check_starts(world: World, rows: list[_Row]) -> None:
    """No start below the floor or inside a solid."""
    for start, row in zip(world.starts, rows):
        x, y, z = start.position
        if z < world.floor_z:
            raise row.fault("position", f"is below the floor (z = {world.floor_z:g})")
        for solid in world.solids:
            if solid.low <= z + _START_HEADROOM <= solid.high and _covers(solid, x, y):
                raise row.fault("position", f"is inside of {type(solid).__name__.lower()} {solid.name!r}")


def _covers(solid: Solid, x: float, y: float) -> bool:
    """Whether the point lies in the solid's footprint."""
    dx, dy = x - solid.centre[0], y - solid.centre[1]
    if isinstance(solid, Cylinder):
        return hypot(dx, dy) <= solid.radius
    c, s = cos(solid.yaw), sin(solid.yaw)
    return abs(c * dx + s * dy) <= 0.5 * solid.size[0] and abs(c * dy - s * dx) <= 0.5 * solid.size[1]
