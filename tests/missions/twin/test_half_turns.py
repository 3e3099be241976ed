# SPDX-License-Identifier: BSD-3-Clause
"""A half turn goes either way: where the twin takes the other one, it is told, and heading does not count."""

from __future__ import annotations

import numpy as np
import pytest

from sitl.missions.twin import half_turns
from sitl.missions.twin.agreement import Window
from sitl.missions.twin.half_turns import HalfTurn
from sitl.missions.twin.streams import QUANTITIES, Stream
from sitl.missions.twin.twin import Twin, _compared


def course(*turns: tuple[float, float], until: float = 60.0) -> Stream:
    """Turns at 45 deg/s, (begin [s], by [deg]), as a log has them: from 0 to 360 deg, then unwrapped again."""
    time = np.arange(0.0, until, 0.05)
    yaw = np.full(len(time), 10.0)
    for begin, by in turns:
        yaw += np.clip(45.0 * (time - begin), 0.0, abs(by)) * np.sign(by)
    return Stream(time, np.degrees(np.unwrap(np.radians(np.mod(yaw, 360.0))))[:, None])


ALL_OF_IT = [Window(0.0, 60.0)]


def test_half_turns_are_those_of_about_180_degrees() -> None:
    found = half_turns.half_turns(course((5.0, 180.0), (20.0, 90.0), (30.0, -174.0), (40.0, 270.0), (50.0, 150.0)))
    assert [round(turn.by) for turn in found] == [180, -174]
    assert found[0].begin == pytest.approx(4.5, abs=0.2) and found[0].end == pytest.approx(9.5, abs=0.2)
    assert half_turns.half_turns(course()) == []


@pytest.mark.parametrize(("by", "here", "told"), [(180.0, -180.0, True), (180.0, 180.0, False), (90.0, -90.0, False)])
def test_only_a_half_turn_that_the_twin_makes_the_other_way_is_told(by: float, here: float, told: bool) -> None:
    found = half_turns.opposite_turns(course((10.0, by)), course((10.0, here)), ALL_OF_IT)
    assert bool(found) == told
    assert ["the other way round than the log's vehicle (at 10 s)" in text for text in half_turns.words(found)] == (
        [True] if told else []
    )


def test_a_twin_that_is_late_is_given_the_time_of_both_turns() -> None:
    late = [Window(0.0, 60.0, 3.0)]
    (found,) = half_turns.opposite_turns(course((10.0, 180.0)), course((13.0, -180.0)), late)
    assert found.begin == pytest.approx(9.5, abs=0.2) and found.end == pytest.approx(17.5, abs=0.2)
    assert half_turns.opposite_turns(course((10.0, 180.0)), None, late) == []


def test_windows_are_cut_around_a_turn_and_open_segments_left_out() -> None:
    turn = [HalfTurn(3.0, 5.0, 180.0)]
    windows = [Window(0.0, 2.0), Window(2.0, 4.0, 0.3), Window(4.5, 9.0)]
    assert half_turns.without(windows, turn, whole=True) == [Window(0.0, 2.0)]
    assert half_turns.without(windows, turn, whole=False) == [
        Window(0.0, 2.0), Window(2.0, 3.0, 0.3), Window(5.0, 9.0),
    ]  # fmt: skip


def test_heading_and_turn_rate_do_not_count_meanwhile(own_twin: Twin) -> None:
    turn = HalfTurn(5.0, 8.0, 180.0)
    windows = [Window(0.0, own_twin.log.span.length)]
    for one in _compared(QUANTITIES["copter"], own_twin.log, own_twin.flown, windows, [turn]):
        counts = bool(((one.time > turn.begin + 0.01) & (one.time < turn.end - 0.01)).any())
        assert counts != (one.quantity.name in ("yaw", "yaw_rate")), one.quantity.name
