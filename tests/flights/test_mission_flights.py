# SPDX-License-Identifier: BSD-3-Clause
"""AUTO: every kind of mission item, flown."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sitl.core.mavlink import MavCmd, MavFrame
from sitl.simulation import Core
from tests.flights import aviator
from tests.flights.aviator import AIRFRAMES, AUTO, Aviator, Item
from tests.pilots.witness import LOW

BOTH = pytest.mark.parametrize("frame", AIRFRAMES)
UP = Item(MavCmd.NAV_TAKEOFF, None, 10.0)
DOWN = Item(MavCmd.NAV_LAND)


def fly(core: Core, frame: str, *items: Item, seconds: float = 200.0, **params: float) -> tuple[Aviator, float]:
    """(the pilot after the mission, when it began); ends when disarmed."""
    p = Aviator(core, frame, **params).ready()
    p.start_mission(*items)
    start = p.now
    p.fly(seconds, lambda: not p.armed)
    return p, start


def heading_at(p: Aviator, time: float) -> float:
    """True heading at a time [deg]."""
    rows = p.since(0.0)
    return float(rows[np.argmin(np.abs(rows[:, 0] - time)), 9])


@BOTH
def test_waypoint_delay_and_landing_at_a_place(core: Core, frame: str) -> None:
    p, start = fly(
        core, frame, UP, Item(MavCmd.NAV_WAYPOINT, (20.0, 0.0), 15.0, (5.0,)),
        Item(MavCmd.NAV_WAYPOINT, (20.0, 20.0), 10.0),
        Item(MavCmd.NAV_LAND, (0.0, 20.0)),
    )  # fmt: skip
    assert not p.armed
    assert p.reached == [1, 2, 3]
    assert -p.since(start)[:, 3].min() == pytest.approx(15.0, abs=0.5)
    assert p.pos[:2] == pytest.approx([0.0, 20.0], abs=1.2)
    rows = p.since(start)
    at_rest = rows[(rows[:, 0] < p.reached_at(2)) & (np.linalg.norm(rows[:, 1:4] - [20, 0, -15], axis=1) < 1.5)]
    assert np.ptp(at_rest[:, 0]) > 5.0


@BOTH
def test_return_lands_at_home(core: Core, frame: str) -> None:
    p, start = fly(core, frame, UP, Item(MavCmd.NAV_WAYPOINT, (20.0, 0.0), 10.0), Item(MavCmd.NAV_RETURN_TO_LAUNCH))
    assert not p.armed
    assert p.reached == [1, 2, 3]
    assert -p.since(start)[:, 3].min() == pytest.approx(15.0, abs=0.5)
    assert np.linalg.norm(p.pos[:2]) < 1.2


@BOTH
def test_loiter_turns_both_ways_and_loiter_time(core: Core, frame: str) -> None:
    p, _ = fly(
        core, frame, UP, Item(MavCmd.NAV_LOITER_TIME, (15.0, 0.0), 10.0, (5.0,)),
        Item(MavCmd.NAV_LOITER_TURNS, (30.0, 0.0), 12.0, (2.0, 0.0, 8.0, 1.0)),
        Item(MavCmd.NAV_LOITER_TURNS, (30.0, 30.0), 12.0, (1.0, 0.0, -6.0, 1.0)), DOWN,
    )  # fmt: skip
    assert p.reached == [1, 2, 3, 4]
    rows = np.array(p.rows)  # the vehicle's own position: circles are asked here, the receiver's error elsewhere
    for seq, centre, radius, turns in ((3, (30.0, 0.0), 8.0, 2.0), (4, (30.0, 30.0), 6.0, -1.0)):
        times = (p.reached_at(seq) - abs(turns) * 14.0, p.reached_at(seq))
        part = rows[(rows[:, 0] > times[0]) & (rows[:, 0] < times[1])]
        away = np.hypot(part[:, 1] - centre[0], part[:, 2] - centre[1])
        assert away == pytest.approx(radius, abs=0.5)
        angle = np.unwrap(np.arctan2(part[:, 2] - centre[1], part[:, 1] - centre[0]))
        assert np.sign(angle[-1] - angle[0]) == np.sign(turns)
        assert abs(angle[-1] - angle[0]) > 1.4 * math.pi * abs(turns)


def test_unlimited_loiter_ends_by_set_current(core: Core) -> None:
    p, _ = fly(core, "erle_copter", UP, Item(MavCmd.NAV_LOITER_UNLIM, (15.0, 0.0), 10.0), DOWN, seconds=60.0)
    assert p.armed
    assert p.pos[0] == pytest.approx(15.0, abs=1.5)
    p.send("MISSION_SET_CURRENT", seq=3)
    p.wait_disarmed(40.0)


def test_delay_command(core: Core) -> None:
    p, _ = fly(core, "erle_copter", UP, Item(MavCmd.NAV_DELAY, None, 0.0, (7.0, -1.0, -1.0, -1.0)), DOWN)
    assert p.reached_at(2) - p.reached_at(1) == pytest.approx(7.0, abs=0.2)


@pytest.mark.parametrize(("times", "seconds"), [(2, 200.0), (-1, 120.0)])
def test_jump(core: Core, times: int, seconds: float) -> None:
    p, _ = fly(
        core, "erle_copter", UP, Item(MavCmd.NAV_WAYPOINT, (10.0, 0.0), 10.0),
        Item(MavCmd.NAV_WAYPOINT, (0.0, 0.0), 10.0),
        Item(MavCmd.DO_JUMP, None, 0.0, (2.0, times)), DOWN, seconds=seconds,
    )  # fmt: skip
    rounds = p.reached.count(3)
    assert (rounds == 3 and not p.armed) if times == 2 else (rounds > 8 and p.armed)


@BOTH
def test_speed_and_conditions(core: Core, frame: str) -> None:
    p, start = fly(
        core, frame, UP, Item(MavCmd.DO_CHANGE_SPEED, None, 0.0, (1.0, 2.0, -1.0)),
        Item(MavCmd.NAV_WAYPOINT, (20.0, 0.0), 10.0),
        Item(MavCmd.CONDITION_DISTANCE, None, 0.0, (8.0,)),
        Item(MavCmd.CONDITION_YAW, None, 0.0, (90.0, 20.0, 1.0, 0.0)),
        Item(MavCmd.NAV_WAYPOINT, (40.0, 0.0), 10.0), Item(MavCmd.CONDITION_DELAY, None, 0.0, (3.0,)),
        Item(MavCmd.DO_CHANGE_SPEED, None, 0.0, (1.0, 5.0, -1.0)), Item(MavCmd.NAV_WAYPOINT, (40.0, 20.0), 10.0), DOWN,
    )  # fmt: skip
    rows = p.since(start)
    speed = np.linalg.norm(rows[:, 4:6], axis=1)
    assert speed[rows[:, 0] < p.reached_at(6)].max() == pytest.approx(2.0, abs=0.25)
    assert speed.max() > 2.8
    away = rows[np.argmin(np.abs(rows[:, 0] - p.reached_at(4))), 1]
    assert 40.0 - away == pytest.approx(8.0, abs=1.5)
    assert heading_at(p, p.reached_at(6)) > 30.0
    assert p.reached_at(7) - p.reached_at(6) == pytest.approx(3.0, abs=0.2)


@BOTH
def test_roi_behind_a_take_off_holds_until_it_is_ended(core: Core, frame: str) -> None:
    """It runs when the take-off is done; waypoints do not turn the nose away."""
    p, _ = fly(
        core, frame, UP, Item(MavCmd.DO_SET_ROI_LOCATION, (0.0, 50.0), 0.0),
        Item(MavCmd.NAV_WAYPOINT, (30.0, 0.0), 10.0),
        Item(MavCmd.NAV_WAYPOINT, (30.0, 10.0), 10.0), Item(MavCmd.DO_SET_ROI_NONE),
        Item(MavCmd.NAV_WAYPOINT, (0.0, 10.0), 10.0), DOWN,
    )  # fmt: skip
    assert abs(heading_at(p, p.reached_at(1))) < 15.0
    assert heading_at(p, p.reached_at(3) - 1.0) == pytest.approx(121.0, abs=6.0)
    assert abs(heading_at(p, p.reached_at(6) - 2.0)) > 170.0


def test_a_fixed_yaw_lasts_one_leg(core: Core) -> None:
    """As in ArduPilot the next waypoint points the nose along the path again (WP_YAW_BEHAVIOR not 0)."""
    for behaviour, heading in ((2, 0.0), (0, 90.0)):
        p, _ = fly(
            core, "erle_copter", UP, Item(MavCmd.CONDITION_YAW, None, 0.0, (90.0, 0.0, 1.0, 0.0)),
            Item(MavCmd.NAV_WAYPOINT, (30.0, 0.0), 10.0), Item(MavCmd.NAV_WAYPOINT, (70.0, 0.0), 10.0), DOWN,
            WP_YAW_BEHAVIOR=behaviour,
        )  # fmt: skip
        assert heading_at(p, p.reached_at(3) - 1.0) == pytest.approx(90.0, abs=5.0)
        assert heading_at(p, p.reached_at(4) - 2.0) == pytest.approx(heading, abs=5.0)


@BOTH
def test_frames_of_altitude(core: Core, frame: str) -> None:
    p = Aviator(core, frame).ready()
    ground = float(p.ap.estimate.origin_alt)
    p.start_mission(
        UP, Item(MavCmd.NAV_WAYPOINT, (10.0, 0.0), ground + 20.0, (2.0,), MavFrame.GLOBAL_INT),
        Item(MavCmd.NAV_WAYPOINT, (10.0, 10.0), 15.0, (2.0,), MavFrame.GLOBAL_TERRAIN_ALT_INT),
        Item(MavCmd.NAV_WAYPOINT, (0.0, 0.0), 5.0, (2.0,)), DOWN,
    )  # fmt: skip
    start = p.now
    p.wait_disarmed(120.0)
    rows = p.since(start)
    for seq, height in ((2, 20.0), (3, 15.0), (4, 5.0)):
        assert -rows[np.argmin(np.abs(rows[:, 0] - p.reached_at(seq))), 3] == pytest.approx(height, abs=0.8)


def test_a_mission_that_ends_in_the_air_hovers(core: Core) -> None:
    p, _ = fly(core, "erle_copter", UP, Item(MavCmd.NAV_WAYPOINT, (10.0, 0.0), 10.0), seconds=40.0)
    assert p.armed
    assert p.mode == AUTO
    here = p.pos
    p.fly(10.0)
    assert np.linalg.norm(p.pos - here) < 0.6


@BOTH
def test_auto_on_the_ground_waits_for_a_raised_throttle(core: Core, frame: str) -> None:
    p = Aviator(core, frame).ready()
    assert p.upload(UP, DOWN) == 0
    p.set_mode(aviator.STABILIZE)
    p.sticks(0.5, throttle=LOW)
    p.arm()
    assert p.set_mode(AUTO)
    p.fly(4.0)
    assert p.on_ground
    p.sticks(9.0)
    assert p.height == pytest.approx(10.0, abs=1.5)
    p.wait_disarmed(60.0)


def test_auto_on_the_ground_needs_a_take_off(core: Core) -> None:
    p = Aviator(core).ready()
    assert p.upload(Item(MavCmd.NAV_WAYPOINT, (15.0, 0.0), 10.0), DOWN) == 0
    p.arm()
    assert not p.set_mode(AUTO)
    assert p.ask(300, 0, 0) == 4


def test_a_mission_is_flown_again_after_its_landing(core: Core) -> None:
    p, _ = fly(core, "erle_copter", UP, Item(MavCmd.NAV_WAYPOINT, (10.0, 0.0), 10.0), DOWN)
    assert p.set_mode(aviator.GUIDED)
    p.arm()
    assert p.set_mode(AUTO)
    assert p.ask(300, 0, 0) == 0
    p.wait_disarmed(90.0)
    assert p.reached == [1, 2, 1, 2]


@BOTH
def test_rtl_in_a_corner_and_back(core: Core, frame: str) -> None:
    p = Aviator(core, frame).ready()
    p.start_mission(
        UP, Item(MavCmd.NAV_WAYPOINT, (30.0, 0.0), 10.0), Item(MavCmd.NAV_WAYPOINT, (30.0, 30.0), 10.0), DOWN
    )
    assert p.fly(60.0, lambda: not math.isnan(p.reached_at(2)))
    start = p.now
    assert p.set_mode(aviator.RTL)
    p.fly(3.0)
    assert p.set_mode(AUTO)
    p.wait_disarmed(90.0)
    assert np.abs(p.since(start)[:, 7:9]).max() < 31.0
    assert p.pos[:2] == pytest.approx([30.0, 30.0], abs=1.2)


@pytest.mark.parametrize(
    ("name", "item", "axis", "speeds"),
    [
        ("WPNAV_SPEED", Item(MavCmd.NAV_WAYPOINT, (900.0, 0.0), 10.0), 0, (10.0, 7.0, 9.0)),
        ("WPNAV_SPEED_UP", Item(MavCmd.NAV_WAYPOINT, (0.0, 0.0), 900.0), 2, (-2.5, -6.0, -2.0)),
    ],
)
def test_speeds_set_in_flight_hold_at_once(
    core: Core, name: str, item: Item, axis: int, speeds: tuple[float, ...]
) -> None:
    p = Aviator(core, AIRFRAMES[0]).ready()
    p.start_mission(UP, item)
    p.fly(60.0, lambda: 1 in p.reached)
    for k, speed in enumerate(speeds):
        if k > 0:
            p.set_parameter(name, 100.0 * abs(speed))
        p.fly(12.0)
        assert p.vel[axis] == pytest.approx(speed, abs=0.2)


@pytest.mark.parametrize(("behaviour", "turns"), [(0.0, False), (1.0, True), (2.0, False), (3.0, True)])
def test_return_turns_to_the_heading_of_arming(core: Core, behaviour: float, turns: bool) -> None:
    p = Aviator(core, AIRFRAMES[0], WP_YAW_BEHAVIOR=behaviour).ready()
    before = heading_at(p, p.now)
    turn = Item(MavCmd.CONDITION_YAW, None, 0.0, (90.0, 0.0, 1.0, 1.0))
    p.start_mission(UP, turn, Item(MavCmd.NAV_WAYPOINT, (0.0, -25.0), 10.0), Item(MavCmd.NAV_RETURN_TO_LAUNCH))
    p.fly(120.0, lambda: not p.armed)
    off = (heading_at(p, p.now) - before + 180.0) % 360.0 - 180.0
    assert not p.armed and (abs(off) < 5.0) == turns


def test_a_take_off_never_descends(core: Core) -> None:
    p = Aviator(core, AIRFRAMES[0]).ready()
    p.start_mission(Item(MavCmd.NAV_TAKEOFF, None, -10.0), Item(MavCmd.NAV_DELAY, None, 0.0, (5.0,)), DOWN)
    start = p.now
    p.fly(60.0, lambda: not p.armed)
    assert p.reached == [1, 2] and not p.armed
    assert -p.since(start)[:, 3].min() == pytest.approx(1.0, abs=0.3)
    p = Aviator(core, AIRFRAMES[0]).ready()
    p.start_mission(UP, Item(MavCmd.NAV_TAKEOFF, None, 3.0), Item(MavCmd.NAV_DELAY, None, 0.0, (5.0,)), DOWN)
    p.fly(60.0, lambda: 3 in p.reached)
    assert -p.pos[2] == pytest.approx(10.0, abs=0.5)


def test_spline_waypoints(core: Core) -> None:
    """Against ArduPilot 4.7 with the same items: times from the take-off's end, speeds at the waypoints."""
    p, _ = fly(
        core, "ardupilot_quad", UP, Item(MavCmd.NAV_WAYPOINT, (40.0, 0.0), 15.0),
        Item(MavCmd.NAV_SPLINE_WAYPOINT, (80.0, 20.0), 20.0),
        Item(MavCmd.NAV_SPLINE_WAYPOINT, (80.0, 60.0), 25.0), Item(MavCmd.NAV_WAYPOINT, (40.0, 60.0), 15.0),
        Item(MavCmd.NAV_WAYPOINT, (0.0, 60.0), 15.0), Item(MavCmd.NAV_SPLINE_WAYPOINT, (0.0, 20.0), 15.0, (2.0,)),
        Item(MavCmd.NAV_SPLINE_WAYPOINT, (0.0, 0.0), 10.0), DOWN,
    )  # fmt: skip
    assert p.reached == [1, 2, 3, 4, 5, 6, 7, 8]
    up = p.reached_at(1)
    times = [p.reached_at(seq) - up for seq in range(2, 9)]
    assert times == pytest.approx([8.95, 15.3, 23.55, 30.75, 37.4, 50.7, 59.95], rel=0.05)
    rows = p.since(0.0)
    speeds = [float(np.linalg.norm(rows[np.argmin(np.abs(rows[:, 0] - p.reached_at(seq))), 4:6])) for seq in (2, 3, 4)]
    assert speeds == pytest.approx([6.98, 9.11, 3.88], abs=0.25)  # it speeds up there by 1 m/s each second
    lowest = [
        float(
            np.linalg.norm(rows[(rows[:, 0] > p.reached_at(a)) & (rows[:, 0] < p.reached_at(a + 1)), 4:6], axis=1).min()
        )
        for a in (2, 3)
    ]
    assert lowest == pytest.approx([6.24, 3.14], rel=0.05)


def test_a_mission_ends_at_a_spline_waypoint(core: Core) -> None:
    """It stays there (as ArduPilot does), slow enough for its climb: 25.8 s from 10 m to 60 m, 72 m away."""
    p, _ = fly(core, "ardupilot_quad", UP, Item(MavCmd.NAV_SPLINE_WAYPOINT, (60.0, 40.0), 60.0), seconds=60.0)
    assert p.reached_at(2) - p.reached_at(1) == pytest.approx(25.76, rel=0.05)
    p.fly(5.0)
    assert p.mode == AUTO and p.armed
    assert p.pos == pytest.approx([60.0, 40.0, -60.0], abs=1.0)


def test_loiter_to_altitude(core: Core) -> None:
    """Up on the way, then straight down, and up and down where it is: times as ArduPilot 4.7 takes them."""
    p, _ = fly(
        core, "ardupilot_quad", UP, Item(MavCmd.NAV_LOITER_TO_ALT, (30.0, 0.0), 40.0),
        Item(MavCmd.NAV_LOITER_TO_ALT, None, 20.0), Item(MavCmd.NAV_LOITER_TO_ALT, (30.0, 30.0), 20.0),
        Item(MavCmd.NAV_LOITER_TO_ALT, None, 5.0), Item(MavCmd.NAV_RETURN_TO_LAUNCH),
    )  # fmt: skip
    assert p.reached == [1, 6]  # of LOITER_TO_ALT ArduPilot tells nothing
    begun = {seq: next(t.time for t in p.texts if t.text.startswith(f"Mission: {seq} ")) for seq in range(2, 7)}
    taken = [begun[seq + 1] - begun[seq] for seq in range(2, 6)]
    assert taken == pytest.approx([17.0, 16.35, 8.25, 12.95], rel=0.05, abs=0.5)
    rows = p.since(0.0)
    places = [rows[np.argmin(np.abs(rows[:, 0] - begun[seq + 1])), 1:4] for seq in range(2, 6)]
    for place, wanted in zip(places, [(30, 0, -40), (30, 0, -20), (30, 30, -20), (30, 30, -5)], strict=True):
        assert np.hypot(*(place[:2] - wanted[:2])) < 2.2
        assert place[2] == pytest.approx(wanted[2], abs=0.5)


def test_circles_are_told_and_counted_in_whole_ones(core: Core) -> None:
    """Times are those of a real ArduPilot, which flies 2.25 circles as 2: 18.7 and 18.0 s."""
    p = Aviator(core, "ardupilot_quad").ready()
    p.start_mission(UP, Item(MavCmd.NAV_LOITER_TURNS, (20.0, 0.0), 10.0, (2.25, 0.0, 10.0)), DOWN)
    assert p.fly(120.0, lambda: p.said("Mission: 3 Land"))
    times = {text: time for time, _, text in p.texts}
    told = [times[f"Mission: starting circle {k}/2"] for k in (1, 2, 3)]
    assert np.diff(told) == pytest.approx([18.7, 18.0], abs=0.1)
    assert p.reached_at(2) == pytest.approx(told[2], abs=0.01)


def test_a_part_of_a_circle(core: Core) -> None:
    """Half of one: 9.7 s."""
    p = Aviator(core, "ardupilot_quad").ready()
    p.start_mission(UP, Item(MavCmd.NAV_LOITER_TURNS, (20.0, 0.0), 10.0, (0.5, 0.0, 10.0)), DOWN)
    assert p.fly(120.0, lambda: p.said("Mission: 3 Land"))
    told = [time for time, _, text in p.texts if "starting circle 1/0" in text]
    assert p.reached_at(2) - told[0] == pytest.approx(9.7, abs=0.1)
    assert not p.said("starting circle 2")


def test_states_of_a_mission_that_is_left_and_paused(core: Core) -> None:
    """Left is not started, as ArduPilot tells it; a pause is one only on a way."""
    not_started, active, paused = 2, 3, 4
    p = Aviator(core, "ardupilot_quad").ready()
    p.start_mission(
        UP, Item(MavCmd.NAV_WAYPOINT, (60.0, 0.0), 10.0), Item(MavCmd.NAV_LOITER_TURNS, (60.0, 0.0), 10.0, (1.0,))
    )

    def state() -> tuple[int, int]:
        with p.messages("MISSION_CURRENT") as found:
            p.ask(512, 42)
        return int(found[-1].mission_state), int(found[-1].mission_mode)

    assert state() == (active, 1)
    assert p.ask(193, 0) == 4
    assert p.said("Failed to pause")  # the take-off goes on
    assert p.fly(60.0, lambda: p.said("Mission: 2 WP"))
    p.fly(3.0)
    assert p.ask(193, 0) == 0
    assert state() == (paused, 1)
    p.fly(5.0)
    assert np.linalg.norm(p.vel) < 0.2
    assert p.set_mode(aviator.LOITER)
    assert state() == (paused, 0)
    assert p.set_mode(AUTO)
    p.fly(3.0)
    assert state() == (active, 1) and p.vel[0] > 1.0
    assert p.set_mode(aviator.LOITER)
    assert state() == (not_started, 0)


def test_the_item_is_chosen_again(core: Core) -> None:
    """224: 0 is the first item, there is no -1; outside of AUTO the next navigation command becomes current."""
    p = Aviator(core, "ardupilot_quad").ready()
    p.upload(UP, Item(MavCmd.NAV_WAYPOINT, (20.0, 0.0), 10.0), Item(MavCmd.DO_CHANGE_SPEED, None, 0.0, (1.0, 3.0)),
             Item(MavCmd.NAV_WAYPOINT, (20.0, 20.0), 10.0))  # fmt: skip
    for params, result, current in (((3, 0), 0, 4), ((-1, 1), 2, 4), ((0, 1), 0, 1), ((2.5, 2), 0, 2), ((9, 1), 2, 2)):
        assert p.ask(224, *params) == result
        assert p.ap.modes.nav.mission_current == current
    p.ask(224, 3)
    p.arm()
    assert p.set_mode(aviator.GUIDED)
    p.take_off(10.0)
    assert p.set_mode(AUTO)
    assert [text for _, _, text in p.texts][-2:] == ["Mission: 3 ChangeSpeed", "Mission: 4 WP"]


@pytest.mark.parametrize(("options", "items"), [(0, 2), (1, 0)])
def test_a_boot_clears_the_mission_if_it_is_asked_to(core: Core, options: int, items: int) -> None:
    p = Aviator(core, "ardupilot_quad", MIS_OPTIONS=options).ready()
    p.upload(UP)
    assert len(p.simulation.mission) == 2
    assert p.ask(246, 1) == 0
    p.fly(1.0)
    assert len(p.simulation.mission) == items


def test_a_complete_mission_runs_again_when_it_is_reset(core: Core) -> None:
    """224 with p2 0, and MISSION_SET_CURRENT, choose the item alone; with p2 1 AUTO flies there. So does ArduCopter."""
    p = Aviator(core, AIRFRAMES[0]).ready()
    p.start_mission(UP, Item(MavCmd.NAV_WAYPOINT, (5.0, 0.0), 10.0), Item(MavCmd.NAV_WAYPOINT, (10.0, 0.0), 10.0))
    p.fly(60.0, lambda: 3 in p.reached)
    p.fly(3.0)
    assert p.ask(224, 2, 0) == 0
    p.fly(10.0)
    current = p.message("MISSION_CURRENT")
    assert (current.seq, current.mission_state) == (2, 2) and p.reached == [1, 2, 3] and p.pos[0] > 9.0
    assert p.ask(224, 2, 1) == 0
    p.fly(30.0, lambda: len(p.reached) == 5)
    assert p.reached == [1, 2, 3, 2, 3]
