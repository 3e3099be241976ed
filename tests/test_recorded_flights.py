# SPDX-License-Identifier: BSD-3-Clause
"""Our flights on ArduPilot's airframes against the recorded ones: the metrics that agree must go on agreeing."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest

from benchmarks.recorded import __main__ as compare
from benchmarks.recorded.metrics import Metric, X, crossing, table
from benchmarks.recorded.recording import RecordingError, recorded

LOOSER = {  # percent, where docs/comparison.md says why
    "take-off: 0.1 m": 10.0,
    "3 m/s east: 1 m/s": 7.0,
    "3 m/s east: 2.85 m/s": 35.0,
    "HOLD: below 0.5 m/s": 7.0,
    "AUTO: item 1 reached": 16.0,
    "AUTO: item 2 reached": 11.0,
    "AUTO: item 3 reached": 9.0,
    "AUTO: item 4 reached": 6.0,
}
NOT_COMPARED = ("behind", "while it stands", "HOLD: below 0.1", "error at the end")


@pytest.fixture(scope="module", params=[(k, e) for k in ("copter", "rover") for e in ("ekf", "truth")])
def metrics(request: pytest.FixtureRequest) -> list[Metric]:
    return compare.metrics(*request.param)


def test_times_speeds_and_angles_agree_within_five_percent(metrics: list[Metric]) -> None:
    compared = [f for f in metrics if f.theirs and not any(part in f.name for part in NOT_COMPARED)]
    assert len(compared) > 25
    wrong = [f for f in compared if not abs(f.percent) <= LOOSER.get(f.name, 5.0)]
    assert not wrong


def test_paths_agree_within_half_a_metre(metrics: list[Metric]) -> None:
    paths = [f for f in metrics if "RMS" in f.name]
    assert len(paths) >= 5
    assert all(f.ours < 0.5 for f in paths), paths


def test_places_agree_within_a_fifth_of_a_metre(metrics: list[Metric]) -> None:
    assert all(abs(f.ours - f.theirs) < 0.2 for f in metrics if "error at the end" in f.name)


@pytest.mark.parametrize(("kind", "estimator"), [(k, e) for k in ("copter", "rover") for e in ("ekf", "truth")])
def test_the_page_shows_what_is_flown(kind: str, estimator: str) -> None:
    """Close, not equal: another processor's mathematics may round another way."""
    page = (Path(__file__).parents[1] / "docs" / "comparison.md").read_text(encoding="utf-8")
    title = f"{kind.title()}, with the " + {"ekf": "Kalman filter", "truth": "true state"}[estimator]
    section = next(s for s in page.split("\n## ") if s.startswith(title))
    rows = re.findall(r"^\| (.+?) \| \S+ \| (-?[\d.]+|-) \|", section, re.MULTILINE)
    shown = {name: math.nan if ours == "-" else float(ours) for name, ours in rows}
    flown = {f.name: f.ours for f in compare.metrics(kind, estimator)}
    assert shown == pytest.approx(flown, rel=0.01, abs=0.03, nan_ok=True), "run: python docs/make_pages.py"


def test_a_recording_that_does_not_exist_is_named() -> None:
    with pytest.raises(RecordingError, match="no recording 'plane'; there are copter_auto, copter_guided"):
        recorded("plane")


def test_recordings_hold_the_manoeuvres() -> None:
    guided = recorded("copter_guided")
    step = guided.since("pos_step_20N", 25.0)
    assert step[0, 0] >= 0.0
    assert crossing(step, X, 10.0) == pytest.approx(3.32, abs=0.05)
    assert math.isnan(crossing(step, X, 50.0))


def test_the_table_is_markdown() -> None:
    lines = table([Metric("a", "s", 1.05, 1.0), Metric("b", "m", 0.2, 0.0), Metric("c", "s", math.nan, 1.0)])
    assert lines.splitlines()[2:] == [
        "| a | s | 1.05 | 1.00 | +5.0 % |",
        "| b | m | 0.20 |  |  |",
        "| c | s | - | 1.00 | - |",
    ]
