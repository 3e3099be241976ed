# SPDX-License-Identifier: BSD-3-Clause
"""Manoeuvres of ours beside the kept metrics of a real ArduPilot: what agrees must go on agreeing."""

from __future__ import annotations

import json
import math
import re
import sys
from pathlib import Path

import pytest

from benchmarks.manoeuvres import __main__ as manoeuvres
from benchmarks.manoeuvres import executable, table
from benchmarks.manoeuvres.table import Row
from sitl.client.connection import RealTime
from sitl.errors import LinkLostError, OptionError

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "comparison.md"
AGREE = {"copter": 0.95, "rover": 0.9}
BY_PERCENT = {"copter": 0.92, "rover": 0.87}
"""By 5 % or 0.5 m alone; nine of ten in all."""


@pytest.fixture(scope="module", params=sorted(manoeuvres.FLIGHTS))
def flown(request: pytest.FixtureRequest) -> tuple[str, list[Row]]:
    kind: str = request.param
    return kind, table.rows(manoeuvres.fly_ours(kind), table.kept(kind)["metrics"])


def test_nine_of_ten_metrics_agree(flown: tuple[str, list[Row]]) -> None:
    kind, rows = flown
    assert len(rows) > 90
    wrong = [row for row in rows if not row.agrees]
    assert 1.0 - len(wrong) / len(rows) >= AGREE[kind], wrong
    assert sum(map(table.within, rows)) / len(rows) >= BY_PERCENT[kind]


def test_every_flight_has_all_its_kept_metrics(flown: tuple[str, list[Row]]) -> None:
    kind, rows = flown
    kept = {(flight, name) for flight, metrics in table.kept(kind)["metrics"].items() for name in metrics}
    assert {(row.flight, row.name) for row in rows} == kept, "fly them: python -m benchmarks.manoeuvres --ardupilot"


def test_the_page_shows_what_is_flown(flown: tuple[str, list[Row]]) -> None:
    """Close, not equal: another processor's mathematics may round another way."""
    kind, rows = flown
    section = next(s for s in PAGE.read_text(encoding="utf-8").split("\n### ") if s.startswith(f"{kind.title()}: "))
    cells = re.findall(r"^\|[^|]*\| (.+?) \| \S+ \| (-?[\d.]+|-) \|", section, re.MULTILINE)
    shown = {name: math.nan if ours == "-" else float(ours) for name, ours in cells}
    flown_now = {row.name: row.ours for row in rows}
    assert shown == pytest.approx(flown_now, rel=0.01, abs=0.03, nan_ok=True), "run: python docs/make_pages.py"


@pytest.mark.parametrize(
    ("unit", "ours", "theirs", "agrees"),
    (
        ("m/s", 1.04, 1.0, True), ("m/s", 1.06, 1.0, False), ("m/s", -1.0, 1.0, False),
        ("m", 0.4, 0.0, True), ("m", 0.6, 0.01, False), ("deg", 0.9, -0.05, True),
        ("s", 1.09, 1.0, True), ("s", 1.11, 1.0, False), ("s", 2.2, 2.05, False),
        ("s", math.nan, math.nan, True), ("s", math.nan, 1.0, False), ("s", 1.0, math.nan, False),
    ),
)  # fmt: skip
def test_the_rule(unit: str, ours: float, theirs: float, agrees: bool) -> None:
    assert Row("flight", "metric", unit, ours, theirs).agrees == agrees


def test_the_rule_without_short_times_and_small_angles() -> None:
    cases = (("s", 1.06, 1.0), ("m", 0.4, 0.0), ("deg", 0.9, 0.1), ("s", 1.04, 1.0), ("s", math.nan, math.nan))
    assert [table.within(Row("flight", "metric", *case)) for case in cases] == [False, True, False, True, True]


def test_kept_metrics_are_json_and_the_table_is_markdown() -> None:
    metrics = {"a": {"time": (1.23456, "s"), "never": (math.nan, "m")}}
    kept = json.loads(table.as_json("4.7", "2026-01-02", metrics))
    assert kept == {
        "version": "4.7",
        "date": "2026-01-02",
        "metrics": {"a": {"time": [1.2346, "s"], "never": [None, "m"]}},
    }
    lines = table.markdown([Row("a", "time", "s", 1.0, 2.0), Row("a", "never", "m", math.nan, math.nan)]).splitlines()
    assert lines[2:] == ["| **differs** | time | s | 1.00 | 2.00 | -50.0 % |", "|  | never | m | - | - |  |"]
    assert table.summary([Row("a", "time", "s", 1.0, 2.0)]) == "0 of 1 metrics agree (0.0 %)"


def test_the_median_of_flights_counts() -> None:
    flown = [{"a": {"time": (x, "s"), "never": (y, "m")}} for x, y in ((1.0, math.nan), (9.0, math.nan), (2.0, 3.0))]
    (metrics,) = table.medians(flown).values()
    assert metrics["time"] == (2.0, "s") and math.isnan(metrics["never"][0])


def test_what_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(OptionError, match="arducopter is no executable"):
        executable.find(tmp_path, "copter")
    with pytest.raises(OptionError, match="a rover has no flight 'loiter'; it has velocities, positions"):
        manoeuvres.chosen("rover", ["loiter"])
    with pytest.raises(table.KeptMetricsError, match="no metrics of a plane are kept"):
        table.kept("plane")


def test_the_port_of_an_instance_is_the_one_that_its_executable_is_told(monkeypatch, tmp_path: Path) -> None:
    """ArduPilot's --instance does not move a --base-port."""
    said: list[list[str]] = []
    reached: list[int] = []

    class Process:
        def __init__(self, words: list[str], **_: object) -> None:
            said.append(words)

        def kill(self) -> None:
            return

        wait = kill

    def connected(process: Process, port: int) -> RealTime:
        reached.append(port)
        raise LinkLostError("enough")

    monkeypatch.setattr(executable.subprocess, "Popen", Process)
    monkeypatch.setattr(executable, "_connected", connected)
    for instance in (0, 3):
        with pytest.raises(LinkLostError), executable.started(tmp_path, "copter", manoeuvres.HOME, 1, {}, instance):
            pass
    assert reached == [int(words[words.index("--base-port") + 1]) for words in said] == [5760, 5790]
    assert [words[2] for words in said] == ["-I0", "-I3"]


@pytest.mark.slow
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="the executable is a shell script")
def test_an_executable_is_flown_as_a_vehicle_in_this_process(tmp_path: Path) -> None:
    program = tmp_path / "ardurover"
    program.write_text(f"#!/bin/sh\nPYTHONPATH='{ROOT}' exec '{sys.executable}' -m sitl ardurover \"$@\"\n")
    program.chmod(0o755)
    found, version = manoeuvres.fly_executable(tmp_path, "rover", ["rtl"], 20, instance=41)
    rows = table.rows(found, manoeuvres.fly_ours("rover", ["rtl"]))
    assert len(rows) == 5 and all(abs(row.percent) < 10.0 or row.agrees for row in rows), rows
    assert re.match(r"\d+\.\d+\.\d+", version)
