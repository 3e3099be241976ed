# SPDX-License-Identifier: BSD-3-Clause
"""Arrangements of motors: what holds of every one that can hover level without a turn."""

from __future__ import annotations

import pytest

from sitl.autopilot.copter.control.frames import FRAMES, I_TYPE, OCTA, PLUS, QUAD, Y6, Y6F, H, V, frame_of

EVERY = pytest.mark.parametrize("frame", FRAMES.values(), ids=[f"{first}-{second}" for first, second in FRAMES])


@EVERY
def test_equal_thrust_neither_leans_nor_turns(frame):
    centred = 0.05 if frame == FRAMES[OCTA, V] else 1e-12  # ArduPilot's numbers of that one are rounded
    assert sum(motor.forward for motor in frame) == pytest.approx(0.0, abs=centred)
    assert sum(motor.right for motor in frame) == pytest.approx(0.0, abs=1e-12)
    assert sum(motor.yaw for motor in frame) == pytest.approx(0.0, abs=1e-12)


@EVERY
def test_each_motor_has_a_mirror_on_the_other_side(frame):
    places = sorted((round(motor.forward, 9), round(motor.right, 9) + 0.0) for motor in frame)
    assert places == sorted((round(motor.forward, 9), round(-motor.right, 9) + 0.0) for motor in frame)


def test_a_y6_takes_every_type_and_others_only_their_own():
    assert frame_of(Y6, PLUS) is not None and frame_of(Y6, Y6F) != frame_of(Y6, PLUS)
    assert frame_of(QUAD, Y6F) is None and frame_of(99, PLUS) is None


@pytest.mark.parametrize(
    ("kind", "inner"), ((H, "forward"), (I_TYPE, "right")), ids=("H: two rows from front to back", "I: two across")
)
def test_two_rows_of_four_are_evenly_spaced(kind: int, inner: str) -> None:
    """Corners have all of both parts, the motors between them a third of one."""
    rows: dict[float, list[float]] = {}
    for motor in FRAMES[OCTA, kind]:
        other = motor.right if inner == "forward" else motor.forward
        rows.setdefault(other, []).append(getattr(motor, inner))
    assert sorted(rows) == [-1.0, 1.0]
    for row in rows.values():
        assert sorted(row) == pytest.approx([-1.0, -1.0 / 3.0, 1.0 / 3.0, 1.0])


@EVERY
def test_no_motor_is_where_another_is_unless_they_turn_against_each_other(frame):
    places = [(round(motor.forward, 9), round(motor.right, 9)) for motor in frame]
    for place in set(places):
        turns = [motor.yaw for motor, at in zip(frame, places, strict=True) if at == place]
        assert len(turns) == 1 or sum(turns) == pytest.approx(0.0)


@EVERY
def test_motors_turn_both_ways_and_none_stands_still(frame):
    assert {motor.yaw > 0.0 for motor in frame} == {True, False}
    assert all(0.5 <= abs(motor.yaw) <= 1.0 for motor in frame)
