# SPDX-License-Identifier: BSD-3-Clause
"""ZIGZAG: points stored with a switch, ways between their lines, sweeps. Values are a real ArduPilot's."""

from __future__ import annotations

import numpy as np
import pytest

from sitl.simulation import Core
from tests.flights.aviator import ZIGZAG, Aviator

AUX = 218
"""MAV_CMD_DO_AUX_FUNCTION"""
POINT, SWEEP = 61, 83
A, MIDDLE, B = 0, 1, 2


def switch(p: Aviator, function: int, position: int, seconds: float = 0.1) -> None:
    """Move a switch, and wait with centred sticks."""
    assert p.ask(AUX, function, position) == 0
    p.sticks(seconds)


def with_points(core: Core, **params: float) -> Aviator:
    """In ZIGZAG at 15 m, nose north, with A where it hovers and B, where it is, 20 m to the east."""
    p = Aviator(core, "ardupilot_quad", RC_OVERRIDE_TIME=-1, **params).hover(15.0)
    p.sticks(0.5)
    assert p.set_mode(ZIGZAG)
    p.sticks(2.0)
    switch(p, POINT, A)
    assert p.said("ZIGZAG: point A stored")
    p.hold(roll=1700)
    assert p.fly(12.0, lambda: p.pos[1] > 11.0)
    p.sticks(10.0)
    switch(p, POINT, B)
    assert p.said("ZIGZAG: point B stored")
    return p


def beside(p: Aviator, place: np.ndarray) -> tuple[float, float]:
    """A true place from A [m]: along A .. B, and at right angles to that, north positive."""
    state = p.ap.modes.zigzag
    along = (np.array(state.b) - np.array(state.a)) / np.linalg.norm(np.array(state.b) - np.array(state.a))
    away = place[:2] - np.array(state.a)
    return float(away @ along), float(away[0] * along[1] - away[1] * along[0])


def given_back(p: Aviator) -> bool:
    """Whether the sticks fly it."""
    return p.texts[-1][2] == "ZIGZAG: manual control"


def test_flies_to_the_line_through_the_point_from_wherever_it_is(core: Core) -> None:
    p = with_points(core)
    b = p.pos.copy()
    p.sticks(4.0, pitch=1300)
    p.sticks(5.0)
    _, north = beside(p, p.pos)
    assert north > 8.0
    start = p.now
    switch(p, POINT, A)
    assert p.said("ZIGZAG: moving to A")
    assert p.fly(20.0, lambda: given_back(p))
    assert p.since(start)[:, 5].min() == pytest.approx(-4.14, abs=0.5), "a real one flies 20 m at 4.14 m/s"
    p.sticks(3.0)
    assert beside(p, p.pos) == pytest.approx((0.0, north), abs=0.7)
    switch(p, POINT, B)
    assert p.fly(20.0, lambda: given_back(p))
    p.sticks(3.0)
    assert beside(p, p.pos) == pytest.approx((beside(p, b)[0], north), abs=0.7)
    assert abs(p.height - 15.0) < 0.5


def test_the_middle_gives_back_to_the_sticks_and_the_yaw_stick_turns_it_meanwhile(core: Core) -> None:
    p = with_points(core)
    switch(p, POINT, A, 2.5)
    p.sticks(1.5, yaw=1650, roll=1900)
    assert 25.0 < p.euler[2] < 110.0
    assert abs(beside(p, p.pos)[1]) < 0.5, "the roll stick does nothing"
    switch(p, POINT, MIDDLE)
    assert given_back(p)
    p.sticks(5.0)
    place = p.pos.copy()
    assert place[1] > 2.0
    p.sticks(3.0)
    assert float(np.hypot(*(p.pos - place)[:2])) < 0.5, "it stays"


@pytest.mark.parametrize(
    ("direction", "north"), ((0, 1.0), (1, -1.0), (2, -1.0), (3, 1.0)), ids=("forward", "right", "backward", "left")
)
def test_the_side_of_a_sweep_is_that_of_the_nose(core: Core, direction: int, north: float) -> None:
    p = with_points(core, ZIGZ_AUTO_ENABLE=1.0, ZIGZ_SIDE_DIST=6.0, ZIGZ_DIRECTION=float(direction))
    p.hold(yaw=1600)
    assert p.fly(8.0, lambda: 40.0 < p.euler[2] < 60.0)
    p.sticks(3.0)
    here = p.pos.copy()
    switch(p, SWEEP, B)
    assert p.fly(15.0, lambda: given_back(p)), "no lines: one way sideways"
    p.sticks(1.0)
    before, after = beside(p, here), beside(p, p.pos)
    assert (after[0] - before[0], after[1] - before[1]) == pytest.approx((0.0, 6.0 * north), abs=0.6)


def test_a_sweep_goes_from_line_to_line_and_waits_at_each_end(core: Core) -> None:
    p = with_points(core, ZIGZ_AUTO_ENABLE=1.0, ZIGZ_SIDE_DIST=5.0, ZIGZ_LINE_NUM=2.0, ZIGZ_WP_DELAY=2.0)
    switch(p, POINT, A)
    assert p.fly(20.0, lambda: given_back(p))
    first = len(p.texts)
    switch(p, SWEEP, B)
    assert p.fly(60.0, lambda: given_back(p))
    said = [(time, text) for time, _, text in p.texts[first:]]
    assert [text for _, text in said] == [
        "ZIGZAG: moving to forward",
        "ZIGZAG: moving to B (line 1/2)",
        "ZIGZAG: moving to forward",
        "ZIGZAG: moving to A (line 2/2)",
        "ZIGZAG: manual control",
    ]
    assert said[1][0] - said[0][0] == pytest.approx(8.0, abs=1.0), "8.0 s and"
    assert said[2][0] - said[1][0] == pytest.approx(11.4, abs=1.0), "11.4 s"
    p.sticks(2.0)
    assert beside(p, p.pos) == pytest.approx((0.0, 10.0), abs=0.7)


def test_a_suspended_sweep_goes_on_with_its_line(core: Core) -> None:
    p = with_points(core, ZIGZ_AUTO_ENABLE=1.0, ZIGZ_SIDE_DIST=5.0, ZIGZ_LINE_NUM=3.0)
    switch(p, POINT, A)
    assert p.fly(20.0, lambda: given_back(p))
    switch(p, SWEEP, B)
    assert p.fly(20.0, lambda: p.said("moving to B (line 1/3)"))
    p.sticks(4.0)
    switch(p, SWEEP, A)
    assert given_back(p)
    p.sticks(4.0)
    place = p.pos.copy()
    assert 2.0 < place[1] < 18.0
    p.sticks(2.0)
    assert float(np.hypot(*(p.pos - place)[:2])) < 0.5
    switch(p, SWEEP, B)
    assert p.texts[-1][2] == "ZIGZAG: moving to B (line 1/3)"
    assert p.fly(20.0, lambda: p.said("moving to A (line 2/3)"))


def test_without_zigz_auto_enable_nothing_sweeps(core: Core) -> None:
    p = with_points(core)
    said = len(p.texts)
    switch(p, SWEEP, B, 2.0)
    assert len(p.texts) == said and float(np.hypot(*p.vel[:2])) < 0.2
