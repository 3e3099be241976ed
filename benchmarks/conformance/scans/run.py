# SPDX-License-Identifier: BSD-3-Clause
"""``--scan TABLE copter|rover [--binary PATH] [--keep]``: an executable and ours, or ours and what is kept."""

from __future__ import annotations

import datetime
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from . import kept, module
from .program import Programs


def compare(table: str, vehicle: str, theirs: Mapping[str, Any], rows: str = "*") -> list[str]:
    """Scan ours; a line a row that is neither as theirs nor as listed with a reason."""
    of, path = module(table), kept.path_of(table, vehicle)
    ours = dict(of.scan(Programs(vehicle, rows=rows)))
    listed = [{**group, "rows": kept.chosen(group["rows"], rows)} for group in kept.reasons(path)]
    return kept.differences(ours, theirs, listed, getattr(of, "agrees", None))


def compare_kept(table: str, vehicle: str, rows: str = "*") -> list[str]:
    """The same beside the kept table."""
    return compare(table, vehicle, kept.chosen(kept.read(kept.path_of(table, vehicle))["rows"], rows), rows)


def scan(table: str, vehicle: str, binary: Path | None, keep: bool, rows: str, speedup: int) -> int:
    """Scan ours, and the executable where one is given; print where they differ. Gives the number of differences."""
    if binary is None:
        lines = compare_kept(table, vehicle, rows)
    else:
        programs, path = Programs(vehicle, binary, speedup, rows=rows), kept.path_of(table, vehicle)
        with programs.started() as program:
            version = program.version()
        theirs = dict(module(table).scan(programs))
        if keep:
            before = kept.read(path)["rows"] if rows != "*" and path.exists() else {}
            kept.write(path, version, datetime.date.today().isoformat(), {**before, **theirs})
        lines = compare(table, vehicle, theirs, rows)
    print("\n".join([*lines, f"{table} {vehicle}: {len(lines)} differences that are not listed"]))
    return len(lines)
