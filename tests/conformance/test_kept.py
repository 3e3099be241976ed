# SPDX-License-Identifier: BSD-3-Clause
"""Tables of scans: kept a row a line, compared row by row."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.conformance.scans import kept
from sitl.errors import OptionError


def test_a_table_is_read_as_it_was_written(tmp_path: Path) -> None:
    path, rows = kept.path_of("acks", "copter", tmp_path), {"a": {"x": 1}, "b": None}
    kept.write(path, "4.7.0", "2026-01-01", rows)
    assert kept.read(path) == {"version": "4.7.0", "date": "2026-01-01", "rows": rows}
    assert ' "b": null' in path.read_text().splitlines()[5]
    with pytest.raises(OptionError, match="--keep makes it"):
        kept.read(kept.path_of("logs", "copter", tmp_path))


def test_a_difference_is_told_unless_it_is_listed_as_it_is() -> None:
    theirs, ours = {"a": 1, "b": 2, "c": 3, "d": 4}, {"a": 1, "b": 9, "c": 9, "d": 4}
    listed = [{"reason": "why", "rows": {"b": 9, "d": 8}}]
    assert kept.differences(ours, theirs, listed) == ["c: ours 9, ArduPilot 3", "d: ours 4, listed as 8"]
    assert kept.differences({"a": 1}, {"a": 1}, [{"reason": "", "rows": {"a": 1}}]) == ["a: listed, but it agrees"]
    assert kept.differences({}, {"a": 1}, []) == ["a: ours null, ArduPilot 1"]
    assert kept.differences({"a": 1.0}, {"a": 1.1}, [], lambda a, b: abs(a - b) < 0.2) == []
