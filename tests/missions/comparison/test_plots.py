# SPDX-License-Identifier: BSD-3-Clause
"""What is drawn of a comparison: which lines, where limits are, what axes say. Colours and sizes are the reader's."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sitl.missions.comparison import plots
from sitl.missions.comparison.alignment import pair
from sitl.missions.comparison.flight import measure
from tests.missions.comparison.conftest import straight

pytest.importorskip("matplotlib")
SHOWN = ("position", "cross_track", "altitude", "delay", "speed", "climb", "tilt", "heading")


@pytest.fixture(autouse=True)
def figures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Figures themselves, not their PNG bytes."""
    monkeypatch.setattr(plots, "_png", lambda figure: figure)


def comparison(limits: Any = None, first: float | None = None, kind: str = "copter", north: float = 0.5,
               align: str = "auto") -> Any:  # fmt: skip
    """Of a flight of 20 s, and one that is half a metre north of it."""
    golden = replace(straight(), kind=kind)
    data = golden.data.copy()
    data[:, 1] += north
    data[:, 7:10] = 0.1, 0.2, 0.3
    found = pair(golden, replace(golden, data=data), align)
    return SimpleNamespace(
        pair=found, differences=measure(found), first=None if first is None else SimpleNamespace(t=first),
        tolerance=SimpleNamespace(limit=lambda name: (limits or {}).get(name, math.inf)),
    )  # fmt: skip


def lines(axis: Any, label: str) -> Any:
    return next(line for line in axis.lines if line.get_label() == label).get_xydata()


def labels(figure: Any) -> list[str]:
    return [axis.get_ylabel() for axis in figure.axes]


# ---------------------------------------------------------------- from above


def test_paths_from_above_have_east_to_the_right_and_north_up() -> None:
    figure: Any = plots.plan(comparison())
    axis = figure.axes[0]
    assert (axis.get_xlabel(), axis.get_ylabel()) == ("east [m]", "north [m]")
    golden = lines(axis, "golden")
    assert golden[-1].tolist() == pytest.approx([20.0, 20.0]) and golden[50].tolist() == pytest.approx([0.0, 10.0])
    assert lines(axis, "start").tolist() == [[0.0, 0.0]]
    new = axis.collections[0].get_segments()
    assert len(new) == len(golden) - 1 and new[0].tolist() == pytest.approx(np.array([[0.0, 0.5], [0.0, 0.7]]))
    assert {text.get_text() for text in axis.texts} == {"1", "2"}
    items = [line.get_xydata()[0].tolist() for line in axis.lines if len(line.get_xydata()) == 1][:2]
    assert items == [pytest.approx([0.0, 20.5]), pytest.approx([20.0, 20.5])]
    assert "first divergence" not in [line.get_label() for line in axis.lines]


@pytest.mark.parametrize(("limit", "top"), [(None, 0.5), (0.2, 0.5), (3.0, 3.0)])
def test_the_new_path_is_coloured_up_to_its_limit_or_its_greatest_distance(limit: float | None, top: float) -> None:
    figure: Any = plots.plan(comparison({"cross_track.max": limit} if limit is not None else None))
    colours, bar = figure.axes[0].collections[0], figure.axes[1]
    assert colours.get_clim() == (0.0, pytest.approx(top, abs=0.01))
    assert bar.get_ylabel() == "new: distance from the golden path [m]"
    assert len([line for line in bar.lines if line.get_ydata()[0] == limit]) == int(limit is not None)


def test_flights_that_are_the_same_have_a_scale_of_two_centimetres() -> None:
    figure: Any = plots.plan(comparison(north=0.0))
    assert figure.axes[0].collections[0].get_clim() == (0.0, 0.02)


def test_the_first_divergence_is_marked() -> None:
    figure: Any = plots.plan(comparison(first=5.0))
    assert lines(figure.axes[0], "first divergence")[0].tolist() == pytest.approx([0.0, 10.5])


# ---------------------------------------------------------------- over time


def test_both_flights_over_time() -> None:
    figure: Any = plots.flown(comparison(first=7.0))
    assert labels(figure) == ["above home [m]", "ground speed [m/s]", "roll [deg]", "pitch [deg]", "heading [deg]",
                              "energy [Wh]"]  # fmt: skip
    up, speed, roll, pitch, heading, _ = (lines(axis, "new") for axis in figure.axes)
    assert set(up[:, 1]) == {10.0} and up[-1, 0] == pytest.approx(20.0)
    assert speed[50, 1] == pytest.approx(2.0)
    for drawn, angle in ((roll, 0.1), (pitch, 0.2), (heading, 0.3)):
        assert drawn[5, 1] == pytest.approx(math.degrees(angle), abs=0.05)
    assert lines(figure.axes[2], "golden")[5, 1] == 0.0
    assert figure.axes[-1].get_xlabel() == "simulated time since AUTO began [s]"
    marks = [round(float(line.get_xdata()[0]), 3) for line in figure.axes[0].lines if len(line.get_xdata()) == 2]
    assert marks == [10.0, 20.0, 7.0], "items, and the first divergence"
    assert figure.axes[0].get_xlim() == (0.0, pytest.approx(20.0))
    assert [text.get_text() for text in figure.axes[0].texts] == ["1", "2"]


def test_a_rover_has_neither_height_nor_lean() -> None:
    figure: Any = plots.flown(comparison(kind="rover"))
    assert labels(figure) == ["ground speed [m/s]", "heading [deg]", "energy [Wh]"]


def test_a_heading_that_turns_over_is_no_line_across() -> None:
    made = comparison()
    made.pair.new.data[:, 9] = np.where(np.arange(len(made.pair.new.data)) < 50, 3.1, -3.1)
    heading = lines(plots.flown(made).axes[4], "new")[:, 1]  # type: ignore[attr-defined]
    assert np.flatnonzero(np.isnan(heading)).tolist() == [50]


@pytest.mark.parametrize(("align", "words"), [("armed", "arming"), ("start", "power-on"), ("AUTO", "AUTO began")])
def test_time_counts_from_what_flights_are_aligned_by(align: str, words: str) -> None:
    for drawn in (plots.flown, plots.differing):
        figure: Any = drawn(comparison(align=align))
        assert figure.axes[-1].get_xlabel() == f"simulated time since {words} [s]"


# ---------------------------------------------------------------- differences


def test_each_difference_has_its_panel_with_its_unit() -> None:
    made = comparison()
    figure: Any = plots.differing(made)
    wanted = [f"{made.differences[name].title}\n[{made.differences[name].unit}]" for name in SHOWN]
    assert labels(figure) == wanted
    assert figure.axes[0].lines[0].get_ydata()[7] == pytest.approx(made.differences["position"].values[7])


@pytest.mark.parametrize(
    ("limit", "top", "drawn", "bad"),
    [
        (None, 1.25 * 0.5, [], False),
        (0.4, 1.25 * 0.5, [0.4], True),
        (0.6, 1.25 * 0.6, [0.6], False),
        (2.0, 1.25 * 2.0, [2.0], False),
        (5.0, 0.5 * 5.0, [5.0], False),  # far below its limit: that is out of sight
    ],
)
def test_limits_of_a_difference(limit: float | None, top: float, drawn: list[float], bad: bool) -> None:
    figure: Any = plots.differing(comparison({"position.max": limit} if limit is not None else None))
    axis = figure.axes[0]
    low, high = axis.get_ylim()
    assert high == pytest.approx(top, rel=0.02) and low == pytest.approx(-0.04 * high)
    ends = [line.get_ydata()[0] for line in axis.lines if line.get_linestyle() == "--"]
    assert ends == drawn
    assert bool(axis.collections) == bad
    assert (axis.yaxis.label.get_color() == plots.LIMIT) == bad


def test_differences_with_signs_have_two_limits() -> None:
    made = comparison({"altitude.max": 0.3})
    made.pair.new.data[:, 3] += 0.5
    made.differences = measure(made.pair)
    axis = plots.differing(made).axes[2]  # type: ignore[attr-defined]
    assert sorted(line.get_ydata()[0] for line in axis.lines if line.get_linestyle() == "--") == [-0.3, 0.3]
    low, high = axis.get_ylim()
    assert low == -high == pytest.approx(-1.25 * 0.5)


def test_what_does_not_differ_has_a_millimetre() -> None:
    figure: Any = plots.differing(comparison(north=0.0))
    assert figure.axes[0].get_ylim()[1] == pytest.approx(1.25e-3)


def test_a_rover_shows_what_is_limited() -> None:
    figure: Any = plots.differing(comparison({"position.max": 1.0, "speed.max": 1.0}, kind="rover"))
    assert [label.splitlines()[1] for label in labels(figure)] == ["[m]", "[m/s]"]


def test_items_are_named_as_far_as_there_is_space() -> None:
    made = comparison()
    made.pair.new.items[:] = [(1.0, 1), (1.2, 2), (1.31, 3), (9.0, 4)]
    figure: Any = plots.flown(made)
    assert [text.get_text() for text in figure.axes[0].texts] == ["1", "3", "4"], "0.3 s are the space of a number"
