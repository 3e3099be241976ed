# SPDX-License-Identifier: BSD-3-Clause
"""An airframe's file (TOML): data only, read and written. What is wrong is said with file, key, value, what is allowed.

The file has ``name``, ``kind`` and ``description``, a table ``properties`` in SI units, a table ``rotor`` for each
rotor of a copter, a table ``parameters`` under ArduPilot's names, and ``intervals`` of properties that were measured::

    kind = "copter"

    [properties]
    mass = 1.14  # [kg] everything included

    [[rotor]]
    x = 0.141  # [m] forward
    y = 0.141  # [m] to the right
    z = -0.03  # [m] down
    direction = "ccw"

    [intervals]
    mass = [1.12, 1.16]  # 95 %
"""

from __future__ import annotations

import json
import math
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..core import documents
from ..errors import did_you_mean
from .airframe import Airframe, AirframeError
from .copter_airframe import CCW, CW, CopterAirframe, Rotor
from .old_names import NEW, OLD, key_of_properties
from .properties.property import Property

ENDING = ".toml"
_KEYS: dict[str, tuple[type, str]] = {
    "name": (str, "a text"),
    "kind": (str, "a text"),
    "description": (str, "a text"),
    "properties": (dict, "a table: [properties]"),
    "parameters": (dict, "a table: [parameters]"),
    "intervals": (dict, "a table: [intervals]"),
    "rotor": (list, "a table for each rotor: [[rotor]]"),
}
_ROTOR = {"x": "[m] forward", "y": "[m] to the right", "z": "[m] down"}
_DIRECTIONS = {"ccw": CCW, "cw": CW}


def read(path: str | Path, kinds: Mapping[str, type[Airframe]]) -> Airframe:
    """The airframe in a file.

    Args:
        path: of the file.
        kinds: name of a kind of vehicle -> class of its airframes.

    Raises:
        AirframeError: the file cannot be read, is not TOML, or says something that is not allowed.
    """
    title = f"airframe file {str(path)!r}"
    try:
        content = Path(path).read_bytes().decode("utf-8-sig")  # Windows editors begin with a mark
    except OSError as error:
        raise AirframeError(f"{title} cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError as error:
        raise AirframeError(f"{title} is not UTF-8 text: {error}") from None
    try:
        document = documents.toml(content)
    except tomllib.TOMLDecodeError as error:
        raise AirframeError(f"{title} is not TOML: {error}") from None
    try:
        return replace(_airframe(document, Path(path).stem, kinds), file=str(path))
    except AirframeError as error:
        raise AirframeError(f"{title}: {error}") from None


def written(airframe: Airframe, *, head: Sequence[str] = (), notes: Mapping[str, str] | None = None) -> str:
    """An airframe as the text of such a file; ``read`` makes the same airframe of it, bit for bit.

    Properties that are at their default, and that its model can use, are there as comments.

    Args:
        airframe: of a kind that comes with the simulator.
        head: lines that the file begins with, as comments.
        notes: name of a property or parameter -> what stands behind its value.
    """
    notes = notes or {}
    lines = [f"# {line}".rstrip() for line in head]
    lines += [
        f"name = {_text(airframe.name)}",
        f"kind = {_text(airframe.kind)}",
        f"description = {_text(airframe.description)}",
        "",
        "[properties] # SI units, angles in radians; body axes are forward, right, down",
    ]
    lines += [_property_line(airframe, prop, notes.get(prop.name, "")) for prop in _used(airframe)]
    for number, rotor in enumerate(getattr(airframe, "rotors", ()), 1):
        lines += ["", f"[[rotor]] # of output {number}"]
        lines += [f"{axis} = {_value(getattr(rotor, axis))}  # {meaning}" for axis, meaning in _ROTOR.items()]
        turns = next(word for word, value in _DIRECTIONS.items() if value == rotor.direction)
        lines += [f'direction = "{turns}"  # seen from above']
    if airframe.intervals:
        lines += ["", "[intervals] # low and high of 95 %, of properties that were measured"]
        lines += [f"{name} = {_value(interval)}" for name, interval in airframe.intervals.items()]
    lines += ["", "[parameters] # that differ from the firmware's defaults, in ArduPilot's units"]
    for name, value in airframe.parameters.items():
        lines.append(f"{name} = {_value(value)}" + (f"  # {notes[name]}" if name in notes else ""))
    return "\n".join(lines) + "\n"


def _used(airframe: Airframe) -> Iterator[Property]:
    """Properties that its model can use, or that it has."""
    model = airframe.properties.get(airframe.model)
    return (f for f in airframe.known if not f.models or model in f.models or f.name in airframe.properties)


def _property_line(airframe: Airframe, prop: Property, note: str) -> str:
    off = "" if prop.name in airframe.properties else "# "
    unit = f"[{prop.unit}] " if prop.unit else ""
    meaning = f"{unit}{prop.meaning}" + (f"; {note}" if note else "")
    return f"{off}{prop.name} = {_value(airframe.value(prop.name))}  # {meaning}"


def _text(value: str) -> str:
    return json.dumps(value, ensure_ascii=True)  # JSON's strings are TOML's


def _value(value: Any) -> str:
    """A number, or a list of numbers, so that it is read back with the same bits."""
    if hasattr(value, "__len__"):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, int) or (hasattr(value, "dtype") and value.dtype.kind in "iu"):
        return str(int(value))
    return repr(float(value))


# ---------------------------------------------------------------------- reading


def _airframe(document: Mapping[str, Any], stem: str, kinds: Mapping[str, type[Airframe]]) -> Airframe:
    for key, value in document.items():
        if key not in _KEYS and key != OLD:
            raise AirframeError(f"{key!r} is not known{did_you_mean(key, _KEYS)}; there are {', '.join(_KEYS)}")
        kind_of_value, words = _KEYS[NEW if key == OLD else key]
        if not isinstance(value, kind_of_value):
            raise AirframeError(f"{key} = {value!r} is not {words}")
    if "kind" not in document:
        raise AirframeError(f"kind is missing; it is one of {', '.join(kinds)}")
    if document["kind"] not in kinds:
        raise AirframeError(f"kind = {document['kind']!r} is not known; it is one of {', '.join(kinds)}")
    kind = kinds[document["kind"]]
    extra: dict[str, Any] = {}
    if issubclass(kind, CopterAirframe):
        extra["rotors"] = tuple(_rotor(n, row) for n, row in enumerate(document.get("rotor", ()), 1))
    elif "rotor" in document:
        raise AirframeError(f"a {kind.kind} has no rotors: [[rotor]] is only for copters")
    table = key_of_properties(document)
    return kind(
        name=document.get("name", stem),
        description=document.get("description", ""),
        properties={name: _number(table, name, value) for name, value in document.get(table, {}).items()},
        parameters={name: _parameter(name, value) for name, value in document.get("parameters", {}).items()},
        intervals={name: _number("intervals", name, value) for name, value in document.get("intervals", {}).items()},
        **extra,
    )


def _number(table: str, name: str, value: Any) -> Any:
    if isinstance(value, list):
        return tuple(_number(table, name, one) for one in value)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise AirframeError(f"{table}.{name} = {value!r}; numbers are allowed, and lists of them for vectors")
    return value


def _parameter(name: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise AirframeError(f"parameters.{name} = {value!r}; a finite number is allowed")
    return value


def _rotor(number: int, row: Any) -> Rotor:
    title = f"rotor {number}"
    if not isinstance(row, dict):
        raise AirframeError(f"{title} = {row!r} is not a table: [[rotor]]")
    allowed = (*_ROTOR, "direction")
    for key in row:
        if key not in allowed:
            raise AirframeError(f"{title}: {key!r} is not known; there are {', '.join(allowed)}")
    for key in allowed:
        if key not in row:
            raise AirframeError(f"{title}: {key} is missing; there are {', '.join(allowed)}")
    if not isinstance(row["direction"], str) or row["direction"] not in _DIRECTIONS:
        raise AirframeError(f"{title}: direction = {row['direction']!r}; it is one of {', '.join(_DIRECTIONS)}")
    x, y, z = (_number(title, axis, row[axis]) for axis in _ROTOR)
    return Rotor(x, y, z, _DIRECTIONS[row["direction"]])
