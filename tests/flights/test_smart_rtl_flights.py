# SPDX-License-Identifier: BSD-3-Clause
"""SMART_RTL: the way out flown back, without its loops."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.recorded.pilot import ARM
from sitl.simulation import Core
from tests.flights.aviator import GUIDED, LOITER, POSITION, SMART_RTL, Aviator


def away(core: Core, *places: tuple[float, float, float], frame: str = "ardupilot_quad", **params: float) -> Aviator:
    """Flown in GUIDED to places, NED from the origin [m], and stopped at each."""
    p = Aviator(core, frame, **params).hover(10.0)
    for place in places:
        p.setpoint(POSITION, position=place)
        assert p.fly(60.0, lambda place=place: float(np.linalg.norm(p.pos - np.array(place))) < 1.0), f"at {p.pos}"
        p.fly(2.0)
    return p


def nearest(p: Aviator, since: float, place: tuple[float, float, float]) -> float:
    """Least distance from a place since a time [m]."""
    return float(np.linalg.norm(p.since(since)[:, 1:4] - np.array(place), axis=1).min())


CORNER, END = (30.0, 0.0, -15.0), (30.0, 40.0, -20.0)


def test_flies_back_the_way_it_came_and_lands(core: Core) -> None:
    p = away(core, CORNER, END)
    start, yaw = p.now, p.euler[2]
    assert p.set_mode(SMART_RTL)
    p.wait_disarmed(120.0)
    assert nearest(p, start, CORNER) < 2.5, "round the corner, not across"
    assert nearest(p, start, (0.0, 0.0, -2.0)) < 0.7, "the way ends 2 m above its beginning"
    assert nearest(p, start, (15.0, 20.0, -17.5)) > 8.0
    assert float(np.hypot(*p.pos[:2])) < 0.7
    assert np.abs((p.since(start)[:, 9] - yaw + 180.0) % 360.0 - 180.0).max() < 5.0, "heading kept (WP_YAW_BEHAVIOR 2)"


def test_loops_are_left_out(core: Core) -> None:
    p = away(core, (20.0, 0.0, -10.0), (20.0, 20.0, -10.0), (0.0, 20.0, -10.0), (5.0, 0.0, -10.0), (5.0, -15.0, -10.0))
    start = p.now
    assert p.set_mode(SMART_RTL)
    p.wait_disarmed(120.0)
    assert p.since(start)[:, 2].max() < 3.0 and p.since(start)[:, 1].max() < 8.0, (
        "straight from where it crossed itself"
    )


def test_goes_on_where_it_was_left(core: Core) -> None:
    p = away(core, CORNER, END)
    assert p.set_mode(SMART_RTL)
    p.fly(4.0)
    assert p.set_mode(LOITER)
    p.sticks(4.0)
    start = p.now
    assert p.set_mode(SMART_RTL)
    p.sticks(40.0)
    assert nearest(p, start, CORNER) < 2.5 and float(np.hypot(*p.pos[:2])) < 1.0


@pytest.mark.parametrize(("options", "turns"), ((0, True), (4, False)))
def test_the_yaw_stick_turns_it_unless_told_otherwise(core: Core, options: int, turns: bool) -> None:
    p = away(core, CORNER, END, SRTL_OPTIONS=options)
    yaw = p.euler[2]
    assert p.set_mode(SMART_RTL)
    p.sticks(1.5, yaw=1700)
    assert (abs(p.euler[2] - yaw) > 20.0) == turns


def test_stays_at_rtl_alt_final(core: Core) -> None:
    p = away(core, CORNER, RTL_ALT_FINAL=600)
    assert p.set_mode(SMART_RTL)
    p.fly(40.0)
    assert p.ap.arming.armed and p.height == pytest.approx(6.0, abs=0.3)
    assert float(np.hypot(*p.pos[:2])) < 0.7


def test_a_path_without_room_is_given_up(core: Core) -> None:
    p = Aviator(core, "ardupilot_quad", SRTL_POINTS=10.0, SRTL_ACCURACY=0.5).hover(10.0)
    for k in range(14):
        p.setpoint(POSITION, position=(4.0 * k, 6.0 * (k % 2), -10.0 - (k % 3)))
        p.fly(3.5)
    assert p.said("SmartRTL Low on space!") and p.said("SmartRTL deactivated: buffer full")
    assert not p.set_mode(SMART_RTL) and p.mode == GUIDED
    assert p.said("Mode change to SMARTRTL failed: init failed")


def test_without_a_position_there_is_no_path(core: Core) -> None:
    p = Aviator(core)
    p.fly(3.0)
    assert not p.set_mode(SMART_RTL)
    p.ready()
    assert p.set_mode(SMART_RTL)
    assert p.ask(ARM, 1) == 4
