# SPDX-License-Identifier: BSD-3-Clause
"""AUTO: corners, very short and very long legs, wind, and missions that are changed while they are flown."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sitl.core.mavlink import MavCmd
from sitl.simulation import Core
from tests.flights.aviator import AIRFRAMES, AUTO, GUIDED, Aviator, Item

BOTH = pytest.mark.parametrize("frame", AIRFRAMES)
UP = Item(MavCmd.NAV_TAKEOFF, None, 10.0)
DOWN = Item(MavCmd.NAV_LAND)
SQUARE = (UP, *(Item(MavCmd.NAV_WAYPOINT, place, 10.0) for place in ((30.0, 0.0), (30.0, 30.0), (0.0, 30.0))), DOWN)


def under_way(core: Core, frame: str, seconds: float, *items: Item, **params: float) -> Aviator:
    """A mission (the square) that has been flown for a time."""
    p = Aviator(core, frame, **params).ready()
    p.start_mission(*(items or SQUARE))
    p.fly(seconds)
    return p


@BOTH
@pytest.mark.parametrize("angle", [45, 90, 135, 180])
def test_corners(core: Core, frame: str, angle: int) -> None:
    """Cut within WPNAV_RADIUS (2 m) at level height, a sharp one nearly at a stop."""
    a, leg = math.radians(angle), 60.0
    back = (leg + leg * math.cos(a), leg * math.sin(a))
    corner = (Item(MavCmd.NAV_WAYPOINT, place, 10.0) for place in ((leg, 0.0), back))
    p = under_way(core, frame, 45.0, UP, *corner, Item(MavCmd.NAV_RETURN_TO_LAUNCH))
    rows = p.since(0.0)
    near = rows[np.abs(rows[:, 0] - p.reached_at(2)) < 4.0]
    assert np.hypot(near[:, 1] - leg, near[:, 2]).min() < 3.0
    assert np.ptp(near[:, 3]) < 0.4
    assert np.abs(near[:, 7:9]).max() < 31.0
    slowest = np.linalg.norm(near[:, 4:6], axis=1).min()
    assert slowest > 4.0 if angle == 45 else slowest < 4.5
    assert slowest < 0.5 or angle < 180


@BOTH
def test_very_short_legs(core: Core, frame: str) -> None:
    places = [(0.5 * k, 0.3 * (k % 2)) for k in range(1, 12)] + [(5.5, 0.3)] * 3
    p = under_way(core, frame, 60.0, UP, *(Item(MavCmd.NAV_WAYPOINT, place, 10.0) for place in places), DOWN)
    assert not p.armed
    assert len(p.reached) == 1 + len(places)


@pytest.mark.parametrize("wind", [0.0, 10.0])
def test_five_kilometres(core: Core, wind: float) -> None:
    """At 15 m/s and with side wind, climbing all the way."""
    p = under_way(
        core, "erle_copter", 470.0, UP, Item(MavCmd.NAV_WAYPOINT, (5000.0, 0.0), 60.0),
        Item(MavCmd.NAV_WAYPOINT, (5000.0, 300.0), 20.0), DOWN,
        WPNAV_SPEED=1500, SIM_WIND_SPD=wind, SIM_WIND_TURB=wind / 5.0, SIM_WIND_DIR=90,
    )  # fmt: skip
    assert not p.armed
    rows = p.since(0.0)
    way = rows[(rows[:, 1] > 200.0) & (rows[:, 1] < 4800.0) & (rows[:, 0] < p.reached_at(2))]
    assert np.abs(way[:, 2]).max() < 2.0
    assert np.abs(-way[:, 3] - (10.0 + 0.01 * way[:, 1])).max() < 1.0
    assert np.linalg.norm(way[:, 4:6], axis=1).mean() == pytest.approx(15.0, abs=0.3)
    assert p.pos[:2] == pytest.approx([5000.0, 300.0], abs=2.0)


@BOTH
def test_the_square_in_strong_wind_ends_disarmed(core: Core, frame: str) -> None:
    """It stayed armed on the ground: the lean against the wind looked like flight."""
    p = under_way(core, frame, 90.0, SIM_WIND_SPD=9, SIM_WIND_TURB=1.5, SIM_WIND_DIR=45, ANGLE_MAX=4500)
    assert p.reached == [1, 2, 3, 4]
    assert not p.armed


@BOTH
def test_set_current_in_flight(core: Core, frame: str) -> None:
    p = under_way(core, frame, 11.0)
    p.send("MISSION_SET_CURRENT", seq=4)
    start = p.now
    p.wait_disarmed(60.0)
    assert p.reached == [1, 4]
    rows = p.since(start)
    assert np.abs(rows[:, 7:9]).max() < 31.0
    assert p.pos[:2] == pytest.approx([0.0, 30.0], abs=1.2)


@BOTH
def test_upload_in_flight_goes_on_with_the_new_items(core: Core, frame: str) -> None:
    p = under_way(core, frame, 13.0)
    assert (
        p.upload(UP, Item(MavCmd.NAV_WAYPOINT, (0.0, 0.0), 12.0), Item(MavCmd.NAV_WAYPOINT, (-20.0, 0.0), 12.0), DOWN)
        == 0
    )
    p.wait_disarmed(80.0)
    assert p.reached == [1, 2, 3]
    assert p.pos[:2] == pytest.approx([-20.0, 0.0], abs=1.2)


def test_a_running_mission_is_not_cleared(core: Core) -> None:
    p = under_way(core, "erle_copter", 13.0)
    with p.messages("MISSION_ACK") as answers:
        p.send("MISSION_CLEAR_ALL")
        p.fly(0.3)
    assert [answer.type for answer in answers] == [1]
    p.wait_disarmed(80.0)
    assert p.reached == [1, 2, 3, 4]


@BOTH
@pytest.mark.parametrize(("restart", "reached"), [(0, [1, 2, 3, 4]), (1, [1, 2, 1, 2, 3, 4])])
def test_after_guided_it_resumes_or_restarts(core: Core, frame: str, restart: int, reached: list[int]) -> None:
    p = under_way(core, frame, 18.0, MIS_RESTART=restart)
    assert p.set_mode(GUIDED)
    p.setpoint(0xDF8, position=(0.0, 0.0, -15.0))
    p.fly(10.0)
    assert p.set_mode(AUTO)
    p.wait_disarmed(120.0)
    assert p.reached == reached


@BOTH
def test_pause_and_continue(core: Core, frame: str) -> None:
    p = under_way(core, frame, 12.0)
    assert p.ask(193, 0) == 0
    p.fly(6.0)
    here = p.pos
    p.fly(3.0)
    assert np.linalg.norm(p.pos - here) < 0.5
    assert p.ask(193, 1) == 0
    p.wait_disarmed(80.0)
    assert p.reached == [1, 2, 3, 4]


@BOTH
@pytest.mark.parametrize("after", [10.0, 10.8, 11.5, 13.0])
def test_slowing_down_in_the_middle_of_a_leg_never_flies_backwards(core: Core, frame: str, after: float) -> None:
    """With full acceleration on, the jerk limit lets the speed rise on; it then braked to a stop and turned back."""
    p = under_way(core, frame, after)
    assert p.ask(178, 1, 2) == 0
    start = p.now
    p.fly(30.0, lambda: not math.isnan(p.reached_at(2)))
    rows = p.since(start)
    assert rows[:, 4].min() > -0.2, "north"
    assert rows[-1, 1] > 26.0
    p.fly(5.0)
    start = p.now
    p.fly(5.0)
    assert np.linalg.norm(p.since(start)[:, 4:6], axis=1).max() < 2.4
    p.wait_disarmed(80.0)


def test_the_yaw_stick_turns_the_nose(core: Core) -> None:
    p = under_way(core, "erle_copter", 12.0)
    heading = p.euler[2]
    p.sticks(1.5, yaw=1650)
    assert p.euler[2] - heading > 20.0
    p.let_go()
    p.wait_disarmed(80.0)
