# SPDX-License-Identifier: BSD-3-Clause
"""Our flights on ArduPilot's quad against the recorded ones: the figures that agree must go on agreeing."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest

from missions import compare
from missions.recording import RecordingError, recorded
from sitl.simulation import Core

LOOSER = {  # percent, where docs/comparison.md says why
    "take-off: 0.1 m": 10.0,
    "3 m/s east: 1 m/s": 7.0,
    "3 m/s east: 2.85 m/s": 35.0,
}


@pytest.fixture(scope="module", params=["ekf", "truth"])
def figures(request: pytest.FixtureRequest, core: Core) -> list[compare.Figure]:
    return compare.figures(request.param)


def test_times_speeds_and_angles_agree_within_five_percent(figures: list[compare.Figure]) -> None:
    compared = [f for f in figures if f.theirs and "behind" not in f.name]
    assert len(compared) > 25
    wrong = [f for f in compared if not abs(f.percent) <= LOOSER.get(f.name, 5.0)]
    assert not wrong


def test_paths_agree_within_half_a_metre(figures: list[compare.Figure]) -> None:
    paths = [f for f in figures if "RMS" in f.name]
    assert len(paths) == 5
    assert all(f.ours < 0.5 for f in paths), paths


@pytest.mark.parametrize("estimator", ["ekf", "truth"])
def test_the_page_shows_what_is_flown(core: Core, estimator: str) -> None:
    """Close, not equal: another processor's mathematics may round another way."""
    page = (Path(__file__).parents[2] / "docs" / "comparison.md").read_text(encoding="utf-8")
    section = page.split("\n## ")[{"ekf": 1, "truth": 2}[estimator]]
    rows = re.findall(r"^\| (.+?) \| \S+ \| (-?[\d.]+) \|", section, re.MULTILINE)
    shown = {name: float(ours) for name, ours in rows}
    flown = {f.name: f.ours for f in compare.figures(estimator)}
    assert shown == pytest.approx(flown, rel=0.01, abs=0.03), "run: python docs/make_pages.py"


def test_a_recording_that_does_not_exist_is_named() -> None:
    with pytest.raises(RecordingError, match="no recording 'plane'; there are copter_auto, copter_guided"):
        recorded("plane")


def test_recordings_hold_the_manoeuvres() -> None:
    guided = recorded("copter_guided")
    step = guided.since("pos_step_20N", 25.0)
    assert step[0, 0] >= 0.0
    assert compare.crossing(step, compare.X, 10.0) == pytest.approx(3.32, abs=0.05)
    assert math.isnan(compare.crossing(step, compare.X, 50.0))


def test_the_table_is_markdown() -> None:
    table = compare.table([compare.Figure("a", "s", 1.05, 1.0), compare.Figure("b", "m", 0.2, 0.0)])
    assert table.splitlines()[2:] == ["| a | s | 1.05 | 1.00 | +5.0 % |", "| b | m | 0.20 |  |  |"]
