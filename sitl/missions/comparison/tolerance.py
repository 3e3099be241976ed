# SPDX-License-Identifier: BSD-3-Clause
"""Limits of the differences between two flights: a TOML file on top of a preset of ``presets/``."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any

from sitl.core import documents
from sitl.errors import OptionError
from sitl.vehicle.kinds import DEFAULT, KINDS

SERIES = ("position", "cross_track", "altitude", "delay", "speed", "climb", "tilt", "heading")
TOTALS = ("duration", "energy")
EVENTS = ("items", "modes", "texts")
PRESETS = ("exact", "same", "alike")
_DISTANCE = re.compile(r"(\d+(?:\.\d+)?|\.\d+) ?(mm|cm|m)")
_METRES = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}
ALIGNMENTS = ("auto", "AUTO", "armed", "start")
_KEYS: dict[str, tuple[str, ...]] = {
    **dict.fromkeys(SERIES, ("max", "rms")),
    **dict.fromkeys(TOTALS, ("max",)),
    "items": ("time",),
    "modes": ("time",),
    "texts": ("time", "ignore", "numbers"),
}


class ToleranceError(OptionError):
    """An invalid tolerance file; names the file, the key and what is allowed."""


@dataclass(frozen=True)
class Tolerance:
    """Limits of one comparison."""

    name: str
    align: str
    """Start of the common time: "AUTO" (the first AUTO while armed), "armed" (first arming), "start" (power-on);
    "auto": the
    first of these that both flights have."""
    limits: Mapping[str, float]
    """ "cross_track.max" -> limit in the metric's unit; infinite: reported, not judged."""
    ignore: tuple[re.Pattern[str], ...]
    """Status texts that match one of these are ignored."""
    numbers: bool
    """Whether numbers in status texts are compared."""
    bits: bool = False
    """Whether the flights must be the same to the last bit."""

    def limit(self, metric: str) -> float:
        """Limit of a metric such as "cross_track.max", in its unit; infinite: not judged."""
        return self.limits.get(metric, math.inf)


def is_file(given: str | Path) -> bool:
    """Whether a tolerance is the name of a file: neither a preset nor a distance."""
    return not (isinstance(given, str) and (given in PRESETS or _DISTANCE.fullmatch(given)))


def load(given: str | Path | Mapping[str, Any], kind: str = DEFAULT) -> Tolerance:
    """A preset by its name, a distance, a TOML file, or a mapping of the same shape; for a kind of vehicle.

    A distance with its unit, "0.5 m" or "2 cm", limits position, cross-track and altitude; the rest is as in "alike".
    What a file does not say is as in its ``base``, "same" unless it says another.

    Raises:
        ToleranceError: no such preset or file, or it says something that is not known.
    """
    if isinstance(given, Mapping):
        return _build("tolerance", given, kind)
    if isinstance(given, str) and given in PRESETS:
        return _build(given, _preset(given), kind)
    distance = _DISTANCE.fullmatch(given) if isinstance(given, str) else None
    if distance:
        limit = {"max": float(distance[1]) * _METRES[distance[2]], "rms": False}
        names = ("position", "cross_track", "altitude")
        return _build(str(given), {"base": "alike", **dict.fromkeys(names, limit)}, kind)
    file = Path(given)
    try:
        table = documents.toml(file.read_text())
    except OSError as error:
        raise ToleranceError(
            f"tolerance {str(given)!r} cannot be read ({error.strerror or error}), is none of {', '.join(PRESETS)}, "
            "and no distance with its unit such as '0.5 m' or '2 cm'"
        ) from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ToleranceError(f"tolerance {str(given)!r} is no TOML: {error}") from None
    return _build(str(given), table, kind)


def _preset(name: str) -> dict[str, Any]:
    return tomllib.loads((resources.files(__package__) / "presets" / f"{name}.toml").read_text())


def _build(title: str, table: Mapping[str, Any], kind: str) -> Tolerance:
    base = table.get("base", "same")
    if base not in PRESETS:
        raise ToleranceError(f"{title}: base {base!r} is none of {', '.join(PRESETS)}")
    found: dict[str, Any] = {}
    for other in KINDS:
        if not isinstance(table.get(other, {}), Mapping):
            raise ToleranceError(f"{title}: [{other}] is a table, not {table[other]!r}")
    for name, layer in (base, _preset(base)), (title, table):
        _lay(found, layer, name, ("base", "align", "bits", *_KEYS, *KINDS))
        _lay(found, layer.get(kind, {}), f"{name}: [{kind}]", tuple(_KEYS))
    if found["align"] not in ALIGNMENTS:
        raise ToleranceError(f"{title}: align {found['align']!r} is none of {', '.join(ALIGNMENTS)}")
    if not isinstance(found.get("bits", False), bool):
        raise ToleranceError(f"{title}: bits is true or false, not {found['bits']!r}")
    limits = {}
    for name, keys in _KEYS.items():
        for key in keys:
            value = found.get(f"{name}.{key}", False)
            if key not in ("ignore", "numbers"):
                limits[f"{name}.{key}"] = _limit(title, f"{name}.{key}", value)
    patterns, numbers = found["texts.ignore"], found["texts.numbers"]
    if not isinstance(patterns, list | tuple):
        raise ToleranceError(f"{title}: texts.ignore is a list of regular expressions, not {patterns!r}")
    if not isinstance(numbers, bool):
        raise ToleranceError(f"{title}: texts.numbers is true or false, not {numbers!r}")
    try:
        ignore = tuple(re.compile(pattern) for pattern in patterns)
    except (re.error, TypeError) as error:
        raise ToleranceError(f"{title}: texts.ignore is a list of regular expressions: {error}") from None
    return Tolerance(title, found["align"], limits, ignore, numbers, found.get("bits", False))


def _lay(found: dict[str, Any], layer: Mapping[str, Any], title: str, known: tuple[str, ...]) -> None:
    """Override entries of ``found`` by those of a table."""
    for name, entry in layer.items():
        if name not in known:
            raise ToleranceError(f"{title}: {name!r} is not known; there are {', '.join(known)}")
        if name in _KEYS:
            if not isinstance(entry, Mapping):
                raise ToleranceError(f"{title}: {name} is a table of {', '.join(_KEYS[name])}, not {entry!r}")
            for key, value in entry.items():
                if key not in _KEYS[name]:
                    raise ToleranceError(f"{title}: {name}.{key} is not known; there is {', '.join(_KEYS[name])}")
                found[f"{name}.{key}"] = value
        elif name in ("align", "bits"):
            found[name] = entry


def _limit(title: str, name: str, value: Any) -> float:
    if value is False:
        return math.inf
    if isinstance(value, bool) or not isinstance(value, int | float) or not value >= 0.0:
        raise ToleranceError(f"{title}: {name} = {value!r} is neither a number from 0 on nor false (not judged)")
    return float(value)
