# SPDX-License-Identifier: BSD-3-Clause
"""What a real ArduPilot answered, kept as data; where ours differs, and why.

``TABLE-VEHICLE.json`` has ``version``, ``date`` and ``rows``. ``TABLE-VEHICLE.differences.json`` beside it is a list of
{"reason": why, "rows": {name: what ours answers}}.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from sitl.errors import OptionError

FOLDER = Path(__file__).parents[3] / "tests" / "conformance" / "kept"
Rows = Mapping[str, Any]


def path_of(table: str, vehicle: str, folder: Path = FOLDER) -> Path:
    """Where the table of a vehicle is kept."""
    return folder / f"{table}-{vehicle}.json"


def write(path: Path, version: str, date: str, rows: Rows) -> None:
    """Keep a table, a row a line."""
    lines = ",\n".join(f"  {json.dumps(name)}: {json.dumps(value)}" for name, value in rows.items())
    path.parent.mkdir(parents=True, exist_ok=True)
    head = f'{{\n "version": {json.dumps(version)},\n "date": {json.dumps(date)},\n "rows": {{\n'
    path.write_text(f"{head}{lines}\n }}\n}}\n", encoding="utf-8")


def read(path: Path) -> dict[str, Any]:
    """The kept table.

    Raises:
        OptionError: it is not kept.
    """
    if not path.exists():
        raise OptionError(f"{path} is not there: --scan with --binary and --keep makes it")
    return dict(json.loads(path.read_text(encoding="utf-8")))


def reasons(path: Path) -> list[dict[str, Any]]:
    """The differences that stay, of the table kept at ``path``."""
    beside = path.with_suffix(".differences.json")
    return list(json.loads(beside.read_text(encoding="utf-8"))) if beside.exists() else []


def chosen(rows: Rows, pattern: str) -> dict[str, Any]:
    """Rows whose names match a pattern of the shell."""
    return {name: value for name, value in rows.items() if fnmatchcase(name, pattern)}


def differences(
    ours: Rows, theirs: Rows, listed: list[dict[str, Any]], agrees: Callable[[Any, Any], bool] | None = None
) -> list[str]:
    """A line a row that differs and is not listed, and a line a listed row that is not as listed."""
    same = agrees or (lambda a, b: bool(a == b))
    expected = {name: value for group in listed for name, value in group["rows"].items()}
    found = [f"{name}: listed twice" for name in expected if sum(name in group["rows"] for group in listed) > 1]
    for name in {**theirs, **ours}:
        a, b = ours.get(name), theirs.get(name)
        if name in expected:
            if not same(a, expected[name]):
                found.append(f"{name}: ours {json.dumps(a)}, listed as {json.dumps(expected[name])}")
            elif same(a, b):
                found.append(f"{name}: listed, but it agrees")
        elif not same(a, b):
            found.append(f"{name}: ours {json.dumps(a)}, ArduPilot {json.dumps(b)}")
    return found
