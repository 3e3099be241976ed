# SPDX-License-Identifier: BSD-3-Clause
"""What is drawn of a twin: which lines, from where to where, what axes say. Colours and widths are the reader's."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sitl.missions.twin import plots, report
from sitl.missions.twin.agreement import Agreement
from sitl.missions.twin.streams import COPTER

pytest.importorskip("matplotlib")
TIME = np.arange(0.0, 10.0, 0.1)


@pytest.fixture(autouse=True)
def figures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Figures themselves, not their PNG bytes."""
    monkeypatch.setattr(plots, "_png", lambda figure: figure)
    monkeypatch.setattr(report.base64, "b64encode", lambda figure: b"a picture")


def agreement(name: str, logged: Any, flown: Any, time: Any = TIME) -> Agreement:
    quantity = next(one for one in COPTER if one.name == name)
    both = [np.reshape(values if np.ndim(values) else np.full(len(time), values), (len(time), -1))
            for values in (logged, flown)]  # fmt: skip
    return Agreement(quantity, time, both[0], both[1], 1.0, 0.1, 0.0, 0.1, 0.0, 99.0)


def twin(**parts: Any) -> Any:
    return SimpleNamespace(**{"whole": [], "difference": [], "segments": [], "begins": (), **parts})


def line(axis: Any, label: str) -> Any:
    return next(drawn for drawn in axis.lines if drawn.get_label() == label).get_xydata()


def names(figure: Any) -> list[str]:
    return [axis.get_ylabel().splitlines()[0] for axis in figure.axes]


def test_paths_from_above_have_east_to_the_right() -> None:
    path = np.stack([TIME, 2.0 * TIME], 1)
    made = twin(whole=[agreement("position", path, path + 1.0)], difference=[agreement("position", path, path + 3.0)])
    (axis,) = plots.plan(made).axes  # type: ignore[attr-defined]
    assert (axis.get_xlabel(), axis.get_ylabel()) == ("east of where it was armed [m]", "north [m]")
    for label, by in (("logged", 0.0), ("twin", 1.0), ("changed twin", 3.0)):
        assert line(axis, label)[10].tolist() == pytest.approx([2.0 + by, 1.0 + by]), label
    assert line(axis, "armed here").tolist() == [[0.0, 0.0]]


def test_without_a_changed_twin_there_is_no_line_of_it() -> None:
    path = np.stack([TIME, TIME], 1)
    (axis,) = plots.plan(twin(whole=[agreement("position", path, path)])).axes  # type: ignore[attr-defined]
    assert [drawn.get_label() for drawn in axis.lines] == ["logged", "twin", "armed here"]


def test_quantities_over_time() -> None:
    made = twin(
        whole=[agreement("position", np.zeros((100, 2)), np.zeros((100, 2))), agreement("height", TIME, TIME + 1.0),
               agreement("asked_roll", 1.0, 1.0), agreement("consumed", 1.0, 1.0), agreement("acceleration", 2.0, 3.0)],
        difference=[agreement("height", TIME, TIME + 5.0)],
    )  # fmt: skip
    figure: Any = plots.flown(made)
    assert names(figure) == ["height", "up acceleration"], "what is asked for, and what adds up, is elsewhere"
    height, up = figure.axes
    assert height.get_ylabel() == "height\n[m]" and up.get_ylabel() == "up acceleration\n[m/s^2]"
    assert line(height, "logged")[20].tolist() == pytest.approx([2.0, 2.0])
    assert line(height, "twin")[20].tolist() == pytest.approx([2.0, 3.0])
    assert line(height, "changed twin")[20].tolist() == pytest.approx([2.0, 7.0])
    assert [drawn.get_label() for drawn in up.lines] == ["logged", "twin"]
    assert up.get_xlabel() == "time since arming [s]" and height.get_shared_x_axes().joined(height, up)
    assert [text.get_text() for text in height.get_legend().get_texts()] == ["logged", "twin", "changed twin"]


def test_what_has_no_quantity_to_draw_is_left_out_of_the_report() -> None:
    made = twin(whole=[agreement("position", np.zeros((100, 2)), np.zeros((100, 2))), agreement("consumed", 1.0, 1.0)],
                segments=[agreement("height", 1.0, 1.0)])  # fmt: skip
    assert plots.flown(made) == plots.opened(made) == b""
    drawn = list(report._pictures(made))
    assert len(drawn) == 1 and "The path, from above" in drawn[0]


@pytest.mark.parametrize(("first", "drawn"), [(10.0, 10.0), (350.0, -10.0), (190.0, -170.0), (-30.0, -30.0)])
def test_headings_go_on_beyond_a_full_turn_and_begin_near_north(first: float, drawn: float) -> None:
    turning = (first + 40.0 * TIME) % 360.0
    figure: Any = plots.flown(twin(whole=[agreement("yaw", turning, turning)]))
    found = line(figure.axes[0], "logged")[:, 1]
    assert found[0] == pytest.approx(drawn) and found[-1] - found[0] == pytest.approx(40.0 * TIME[-1])


def test_motors_are_drawn_as_their_mean() -> None:
    outputs = np.stack([np.full(100, x) for x in (10.0, 20.0, 60.0)], 1)
    figure: Any = plots.flown(twin(whole=[agreement("motors", outputs, 2.0 * outputs)]))
    assert line(figure.axes[0], "logged")[0, 1] == pytest.approx(30.0)
    assert line(figure.axes[0], "twin")[0, 1] == pytest.approx(60.0)


@pytest.mark.parametrize(("count", "points"), [(4000, 4000), (7999, 7999), (8000, 4000), (12_001, 4001)])
def test_long_flights_are_thinned(count: int, points: int) -> None:
    time = np.arange(float(count))
    figure: Any = plots.flown(twin(whole=[agreement("height", time, time, time)]))
    assert len(line(figure.axes[0], "logged")) == points == len(line(figure.axes[0], "twin"))


def test_open_segments_are_lines_of_their_own_from_each_beginning() -> None:
    made = twin(segments=[agreement("height", 1.0, 1.0), agreement("pitch", 1.0, 2.0), agreement("roll", TIME, TIME)],
                begins=np.array([0.0, 2.0, 5.0]))  # fmt: skip
    figure: Any = plots.opened(made)
    assert names(figure) == ["roll", "pitch"], "in an order of their own, and height is none of them"
    roll = figure.axes[0]
    pieces = [
        drawn.get_xydata() for drawn in roll.lines if drawn.get_color() == plots.FLOWN and len(drawn.get_xydata())
    ]
    assert [(round(float(p[0, 0]), 3), round(float(p[-1, 0]), 3)) for p in pieces] == [
        (0.0, 1.9),
        (2.0, 4.9),
        (5.0, 9.9),
    ]
    marks = [float(drawn.get_xdata()[0]) for drawn in roll.lines if drawn.get_color() == "#777"]
    assert marks == [0.0, 2.0, 5.0] and roll.get_shared_x_axes().joined(*figure.axes)
    assert "twin, from the logged state at each grey line" in [
        text.get_text() for text in roll.get_legend().get_texts()
    ]
