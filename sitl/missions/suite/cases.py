# SPDX-License-Identifier: BSD-3-Clause
"""The flights of a suite: mission files of a folder, in variants, as its ``suite.toml`` says."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

from sitl import vehicles
from sitl.autopilot.params import parm_files
from sitl.core import code_in_files, documents
from sitl.errors import OptionError
from sitl.physics.engines import NATIVE
from sitl.vehicle.kinds import DEFAULT, KINDS

from .. import library
from ..comparison.tolerance import is_file as is_tolerance_file
from ..comparison.tolerance import load as load_tolerance
from ..files import load
from ..fly import LIMIT_S

TOML, GOLDEN = "suite.toml", "golden"
ENDINGS = (".plan", ".waypoints", ".txt")
_SETTINGS = (
    "vehicle",
    "frame",
    "world",
    "start",
    "home",
    "seed",
    "seeds",
    "params",
    "physics",
    "tolerance",
    "time_limit",
)
_MISSION = ("file", "library", *_SETTINGS)
_VARIANT = ("name", "missions", "vehicle", "seed", "seeds", "params", "physics", "tolerance")
_TYPES: dict[str, tuple[type | tuple[type, ...], str]] = {
    "vehicle": (str, f"one of {', '.join(KINDS)}"),
    "frame": (str, "the name or file of an airframe"),
    "world": (str, "the name or file of a world"),
    "start": (str, "a start pose of the world"),
    "home": (list, "[latitude, longitude, altitude, heading]"),
    "seed": (int, "a whole number"),
    "seeds": (list, "a list of whole numbers"),
    "params": ((dict, str), "a table of parameters, which are numbers, or a file of parameters"),
    "physics": (str, "the name of an engine"),
    "tolerance": ((str, dict), '"exact", "same", "alike", a distance with its unit ("0.5 m"), a file or a table'),
    "time_limit": ((int, float), "a number of seconds above 0"),
    "name": (str, "a name of letters, digits and .+=,_-"),
    "missions": (list, "a list of patterns"),
    "file": (str, "a mission file"),
    "library": (str, "a mission of the library, or a pattern"),
}


class SuiteError(OptionError):
    """A suite that cannot be flown; names the file, the entry and what is allowed."""


@dataclass(frozen=True)
class Case:
    """One flight of a suite."""

    name: str
    """Name of its golden, its report and its line in the table."""
    mission: Path
    golden: Path
    frame: str
    kind: str
    world: str | None = None
    start: str | None = None
    home: tuple[float, float, float, float] | None = None
    seed: int = 0
    params: Mapping[str, float] = field(default_factory=dict)
    physics: str = NATIVE
    tolerance: str | Mapping[str, Any] | None = None
    """Tolerance for ``comparison.tolerance.load``; None: chosen by what the two flights are."""
    time_limit: float = LIMIT_S


def find(folder: str | Path) -> list[Case]:
    """All flights of a folder, in the order of their names.

    Raises:
        SuiteError: the folder or its ``suite.toml`` cannot be read, or holds nothing to fly.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise SuiteError(f"{str(folder)!r} is no folder")
    table = _table(folder)
    for key in table:
        if key not in ("defaults", "missions", "variants"):
            raise SuiteError(f"{folder / TOML}: {key!r} is not known; there are [defaults], [[missions]], [[variants]]")
    for key in ("missions", "variants"):
        if not isinstance(table.get(key, []), list):
            raise SuiteError(f"{folder / TOML}: {key} is a list of tables, [[{key}]], not {table[key]!r}")
    defaults = _checked(folder, "[defaults]", table.get("defaults", {}), _SETTINGS)
    missions = [_checked(folder, "[[missions]]", row, _MISSION) for row in table.get("missions", [])]
    variants = [_checked(folder, "[[variants]]", row, _VARIANT) for row in table.get("variants", [])] or [{}]
    rows = [row for one in missions for row in _expanded(folder, one)] or _files(folder)
    found: dict[str, Case] = {}
    for row in rows:
        for variant in variants:
            for case in _cases(folder, {**defaults, **row}, variant):
                if case.name in found:
                    raise SuiteError(f"{folder / TOML}: two flights are called {case.name!r}; variants need names")
                found[case.name] = case
    if not found:
        raise SuiteError(f"{str(folder)!r} holds no mission ({', '.join(ENDINGS)}) and no {TOML} that names one")
    return [found[name] for name in sorted(found)]


def _table(folder: Path) -> dict[str, Any]:
    path = folder / TOML
    if not path.exists():
        return {}
    try:
        return documents.toml(path.read_text())
    except OSError as error:
        raise SuiteError(f"{path} cannot be read: {error.strerror or error}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise SuiteError(f"{path} is no TOML: {error}") from None


def _checked(folder: Path, title: str, row: Any, known: tuple[str, ...]) -> dict[str, Any]:
    title = f"{folder / TOML}: {title}"
    if not isinstance(row, dict):
        raise SuiteError(f"{title} is a table, not {row!r}")
    for key, value in row.items():
        if key not in known:
            raise SuiteError(f"{title}: {key!r} is not known; there are {', '.join(known)}")
        kind, words = _TYPES[key]
        if not isinstance(value, kind) or isinstance(value, bool) or not _CHECKS.get(key, lambda _: True)(value):
            raise SuiteError(f"{title}: {key} = {value!r} is not {words}")
    refused = code_in_files.refusal(folder / TOML, _outside(folder, row), say="")
    if refused is not None:
        raise SuiteError(refused)
    if "tolerance" in row:
        _tolerance(folder, row["tolerance"])
    return row


def _outside(folder: Path, row: Mapping[str, Any]) -> list[str]:
    """What a table names that is neither in the suite's folder nor known here by its name."""
    options = {key: row[key] for key in ("frame", "physics", "world") if key in row}
    if _lies_beside(folder, options.get("world")):
        del options["world"]
    if str(options.get("frame")).endswith(".toml") and _lies_beside(folder, options["frame"]):  # data, and no code
        del options["frame"]
    named = code_in_files.code_of_options(options)
    tolerance, file = row.get("tolerance", {}), row.get("file", "")
    is_file = isinstance(tolerance, str) and (not code_in_files.is_name(tolerance) or Path(tolerance).exists())
    if is_file and is_tolerance_file(tolerance) and not _lies_beside(folder, tolerance):
        named.append(f"tolerance = {tolerance!r}")
    found = folder.glob(file) if file and not Path(file).is_absolute() else []
    if not all(code_in_files.lies_in(folder, path) for path in (file, *(path.absolute() for path in found))):
        named.append(f"file = {file!r}")
    return named


def _lies_beside(folder: Path, name: str | None) -> bool:
    return name is not None and (folder / name).is_file() and code_in_files.lies_in(folder, name)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _is_whole(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)


_CHECKS: dict[str, Callable[[Any], bool]] = {
    "vehicle": lambda value: value in KINDS,
    "home": lambda value: len(value) == 4 and all(map(_is_number, value)),
    "seeds": lambda value: bool(value) and all(map(_is_whole, value)),
    "params": lambda value: isinstance(value, str) or all(map(_is_number, value.values())),
    "time_limit": lambda value: _is_number(value) and value > 0,
    "name": lambda value: bool(re.fullmatch(r"[\w.+=,-]+", value)),
    "missions": lambda value: all(isinstance(pattern, str) for pattern in value),
}
"""Further condition on a value of the right type."""


def _tolerance(folder: Path, value: Any) -> str | Mapping[str, Any]:
    """The argument for ``comparison.tolerance.load``; a file beside the suite gets its path.

    Raises:
        ToleranceError: it does not.
    """
    if isinstance(value, str) and (folder / value).exists():
        value = str(folder / value)
    load_tolerance(value)
    return value  # type: ignore[no-any-return]


def _params(folder: Path, table: dict[str, Any]) -> dict[str, float]:
    """Parameters of an entry: a table, or a file in the suite's folder.

    Raises:
        SuiteError: the file cannot be read, or is elsewhere.
    """
    value = table.get("params", {})
    if not isinstance(value, str):
        return dict(value)
    if not (folder / value).resolve().is_relative_to(folder.resolve()):
        raise SuiteError(f"{folder / TOML}: params = {value!r} is not in the folder of the suite")
    try:
        return parm_files.load(folder / value)
    except parm_files.ParameterError as error:
        raise SuiteError(f"{folder / TOML}: {error}") from None


def _files(folder: Path) -> list[dict[str, Any]]:
    return [{"file": path.name} for path in sorted(folder.iterdir()) if _is_mission(path)]


def _is_mission(path: Path) -> bool:
    """Whether a file is a mission, by its suffix; a .txt must begin as a QGC WPL file."""
    suffix = path.suffix.lower()
    if suffix != ".txt" or not path.is_file():
        return suffix in ENDINGS
    with path.open("rb") as file:
        return file.read(16).lstrip(b"\xef\xbb\xbf").startswith(b"QGC WPL")


def _expanded(folder: Path, row: dict[str, Any]) -> list[dict[str, Any]]:
    """A row for each mission that a row's pattern matches."""
    if ("file" in row) == ("library" in row):
        raise SuiteError(f"{folder / TOML}: [[missions]] has either file or library")
    if "file" in row:
        found = [] if not row["file"] or Path(row["file"]).is_absolute() else folder.glob(row["file"])
        names = sorted(path.relative_to(folder).as_posix() for path in found) or [row["file"]]
        return [{**row, "file": name} for name in names]
    names = [name for name in library.entries() if fnmatch(name, row["library"])]
    if not names:
        raise SuiteError(
            f"{folder / TOML}: no mission of the library is {row['library']!r}; "
            f"there are {', '.join(library.entries())}"
        )
    return [{**row, "library": name} for name in names]


def _cases(folder: Path, row: dict[str, Any], variant: dict[str, Any]) -> list[Case]:
    """The flights of one mission in one variant: one for each seed."""
    entry = library.find(row["library"]) if "library" in row else None
    path = entry.path if entry else folder / row["file"]
    stem = entry.name.replace("/", "-") if entry else Path(row["file"]).stem
    if not any(fnmatch(stem, pattern) for pattern in variant.get("missions", ["*"])):
        return []
    kind, frame = _vehicle(folder, path, row, entry)
    if variant.get("vehicle", kind) != kind:
        return []
    settings = {**row, **variant}
    seeds = variant.get("seeds", [variant["seed"]] if "seed" in variant else row.get("seeds", [row.get("seed", 0)]))
    params = dict(entry.params if entry else {}) | _params(folder, row) | _params(folder, variant)
    name = stem + (f"-{variant['name']}" if "name" in variant else "")
    tolerance = _tolerance(folder, settings["tolerance"]) if "tolerance" in settings else None
    home = settings.get("home")
    found = []
    for seed in seeds:
        full = name if len(seeds) == 1 else f"{name}-seed{seed}"
        found.append(
            Case(
                full,
                path,
                folder / GOLDEN / f"{full}.rec",
                frame,
                kind,
                _local(folder, settings.get("world", entry.world if entry else None)),
                settings.get("start", entry.start if entry else None),
                tuple(home) if home is not None else None,  # type: ignore[arg-type]
                seed,
                params,
                settings.get("physics", NATIVE),
                tolerance,
                float(settings.get("time_limit", LIMIT_S)),
            )
        )
    return found


def _vehicle(folder: Path, path: Path, row: dict[str, Any], entry: library.Entry | None) -> tuple[str, str]:
    """(kind, airframe) of a mission."""
    frame = row.get("frame", entry.frame if entry else None)
    if frame is not None:
        frame = _local(folder, frame) or frame
        return vehicles.load(frame).kind, frame
    kind = row.get("vehicle") or load(path).kind or DEFAULT
    return kind, KINDS[kind].default_frame


def _local(folder: Path, name: str | None) -> str | None:
    """The path of a file beside the suite, or the name unchanged."""
    return str(folder / name) if name is not None and (folder / name).is_file() else name
