# SPDX-License-Identifier: BSD-3-Clause
"""Every kind of rover mission item, driven in plain Python."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sitl.autopilot.command_results import CommandResult
from sitl.autopilot.copter.mission import COMMANDS as COPTER
from sitl.autopilot.estimation.estimator_events import EKF_ORIGIN_SET
from sitl.autopilot.events import emit
from sitl.autopilot.mission.item import MissionItem
from sitl.autopilot.mission.mission import Mission
from sitl.autopilot.mission.validate import check
from sitl.autopilot.notes import ItemReached, Text
from sitl.autopilot.rover import arming
from sitl.autopilot.rover.mission import COMMANDS
from sitl.autopilot.rover.modes import guided_setpoints
from sitl.autopilot.rover.modes.auto import AUTO
from sitl.autopilot.rover.modes.manual import MANUAL
from sitl.autopilot.rover.modes.set_mode import request
from sitl.core.mavlink import MavCmd, MavMissionResult
from tests.autopilot.rover.modes.driven_rover import Rover
from tests.autopilot.rover.navigation.rover_on_mission import Missionary, at

WP = MavCmd.NAV_WAYPOINT


def test_delay_and_texts() -> None:
    p = Missionary().drive(at(WP, 15.0, 0.0, p1=3.0), at(WP, 15.0, 10.0))
    assert math.isfinite(p.until(1))
    arrival = next(t for t, note in p.notes if "Loiter for" in str(note))
    assert p.said()[1] == "Reached waypoint #1. Loiter for 3 seconds"
    assert p.reached(1) == pytest.approx(arrival + 3.0, abs=0.05)
    assert math.isfinite(p.until(2))


def test_loiter_time_and_nav_delay() -> None:
    p = Missionary().drive(
        at(MavCmd.NAV_LOITER_TIME, 12.0, 0.0, p1=2.0), MissionItem(MavCmd.NAV_DELAY, p1=4.0), at(WP, 20.0, 0.0)
    )
    first, second = p.until(1), p.until(2)
    assert second - first == pytest.approx(4.0, abs=0.1)
    assert math.isfinite(p.until(3))
    assert "Finished active loiter" in p.said()
    assert "Delaying 4 sec" in p.said()


def test_loiter_unlimited_says_that_it_is_there_and_stays() -> None:
    p = Missionary().drive(at(MavCmd.NAV_LOITER_UNLIM, 10.0, 0.0), at(WP, 20.0, 0.0))
    p.run(30.0)
    assert p.reached(1) is None
    assert p.said() == ["Mission: 1 LoitUnlim", "Reached waypoint #1"]
    assert p.position == pytest.approx((10.0, 0.0), abs=0.5)


@pytest.mark.parametrize("radius", [8.0, -8.0])
def test_turns_around_a_place(radius: float) -> None:
    p = Missionary().drive(at(MavCmd.NAV_LOITER_TURNS, 15.0, 0.0, p1=1.0, p3=radius), at(WP, 0.0, 0.0))
    rows = []
    while p.reached(1) is None and p.time < 90.0:
        p.step()
        rows.append(p.position)
    seen = np.array(rows) - (15.0, 0.0)
    circling = seen[len(seen) // 2 :]
    assert np.hypot(*circling.T) == pytest.approx(8.0, abs=1.5)
    angle = np.unwrap(np.arctan2(circling[:, 1], circling[:, 0]))
    assert math.copysign(1.0, angle[-1] - angle[0]) == math.copysign(1.0, radius)
    assert math.isfinite(p.until(2))


def test_return() -> None:
    p = Missionary().drive(at(WP, 20.0, 0.0), MissionItem(MavCmd.NAV_RETURN_TO_LAUNCH))
    assert math.isfinite(p.until(2))
    assert p.position == pytest.approx((0.0, 0.0), abs=3.0)


def test_reverse_and_speed() -> None:
    p = Missionary().drive(
        MissionItem(MavCmd.DO_CHANGE_SPEED, p2=2.0),
        MissionItem(MavCmd.DO_SET_REVERSE, p1=1.0),
        at(WP, -20.0, 0.0),
        at(WP, -20.0, 9.0),
    )
    p.run(7.0)
    assert "speed: 2.0 m/s" in p.said()
    assert -2.2 < p.speed < -1.5
    assert abs(math.degrees(p.heading)) < 10.0
    assert math.isfinite(p.until(3))
    assert math.isfinite(p.until(4))
    assert request(p.v, MANUAL, 2) == 0
    assert p.ap.modes.nav.drive.reversed == 0


def test_a_speed_that_is_none_changes_nothing() -> None:
    p = Missionary().drive(at(WP, 15.0, 0.0), MissionItem(MavCmd.DO_CHANGE_SPEED, p2=0.0), at(WP, 30.0, 0.0))
    p.until(3)
    assert not any("speed" in text for text in p.said())


def test_turn_to_a_heading_at_a_speed() -> None:
    p = Missionary().drive(MissionItem(MavCmd.NAV_SET_YAW_SPEED, p1=90.0, p2=1.0), at(WP, 20.0, 10.0))
    assert p.until(1) < 10.0
    assert math.degrees(p.heading) == pytest.approx(90.0, abs=6.0)
    relative = Missionary()
    relative.place(0.0, 0.0, math.radians(30.0))
    relative.drive(MissionItem(MavCmd.NAV_SET_YAW_SPEED, p1=-60.0, p2=1.0, p3=1.0), at(WP, 20.0, 10.0))
    relative.until(1)
    assert math.degrees(relative.heading) == pytest.approx(-30.0, abs=6.0)


def test_guided_within_a_mission() -> None:
    """It takes set-points until its time is over; GUIDED_ENABLE 0 is passed over."""
    p = Missionary().drive(
        MissionItem(MavCmd.DO_GUIDED_LIMITS, p1=6.0),
        MissionItem(MavCmd.NAV_GUIDED_ENABLE, p1=1.0),
        MissionItem(MavCmd.NAV_GUIDED_ENABLE, p1=0.0),
        at(WP, 10.0, 0.0),
    )
    p.run(0.1)
    assert guided_setpoints.set_heading_and_speed(p.ap.modes, p.v.time_us, 0.0, 1.0) == CommandResult.OK
    begun = p.time
    second = p.until(2)
    assert p.position[0] > 1.0
    assert second == pytest.approx(begun + 6.0, abs=0.2)
    assert p.until(3) == pytest.approx(second, abs=0.1)
    assert math.isfinite(p.until(4))


def test_conditions_hold_back_what_follows_them() -> None:
    p = Missionary().drive(
        MissionItem(MavCmd.CONDITION_DELAY, p1=3.0), MissionItem(MavCmd.DO_CHANGE_SPEED, p2=2.0),
        MissionItem(MavCmd.CONDITION_DISTANCE, p1=10.0), MissionItem(MavCmd.DO_CHANGE_SPEED, p2=1.0), at(WP, 40.0, 0.0),
        at(WP, 60.0, 0.0),
    )  # fmt: skip
    while p.reached(4) is None and p.time < 60.0:
        p.step()
    first, second = p.reached(2), p.reached(4)
    assert first == pytest.approx(3.0, abs=0.1)
    assert second is not None and second > 5.0
    assert 40.0 - p.position[0] == pytest.approx(10.0, abs=0.3)


def test_jump() -> None:
    p = Missionary().drive(
        at(WP, 10.0, 0.0), at(WP, 10.0, 10.0), MissionItem(MavCmd.DO_JUMP, p1=1.0, p2=1.0), at(WP, 0.0, 0.0)
    )
    assert math.isfinite(p.until(4))
    assert [t for t in p.said() if t.startswith("Mission: 1")] == ["Mission: 1 WP"] * 2
    assert "Mission: 3 Jump 1/1" in p.said()


def test_leaving_and_coming_back_goes_on_with_the_item() -> None:
    p = Missionary().drive(at(WP, 15.0, 0.0), at(WP, 15.0, 15.0), at(WP, 0.0, 15.0))
    p.until(1)
    p.run(1.0)
    assert request(p.v, MANUAL, 2) == 0
    p.run(3.0)
    assert request(p.v, AUTO, 2) == 0
    p.run(0.1)
    assert p.said()[-1] == "Mission: 2 WP"
    assert math.isfinite(p.until(3))


def test_disarmed_it_waits_and_goes_on_with_the_item() -> None:
    p = Missionary().drive(at(WP, 15.0, 0.0), at(WP, 15.0, 15.0), at(WP, 0.0, 15.0))
    p.until(1)
    assert arming.disarm(p.v, 1, 0) == 1
    p.run(3.0)
    p.arm()
    assert math.isfinite(p.until(3))
    assert p.said().count("Mission: 1 WP") == 1
    assert request(p.v, MANUAL, 2) == 0
    assert arming.disarm(p.v, 1, 0) == 1
    p.run(0.1)
    assert p.ap.modes.nav.mission_current == 0


def test_without_an_origin_it_waits() -> None:
    p = Missionary()
    assert arming.disarm(p.v, 1, 0) == 1
    p.ap.estimate.origin_set = 0
    p.drive(at(WP, 15.0, 0.0))
    p.run(1.0)
    assert p.said() == []
    p.ap.estimate.origin_set = 1
    emit(p.ap.events, p.v.time_us, EKF_ORIGIN_SET, 0.0, 0.0)
    p.run(0.1)
    assert p.said() == ["Mission: 1 WP"]
    assert p.ap.modes.nav.target[0] == pytest.approx(15.0, abs=0.1)


def test_what_only_the_other_firmware_carries_out() -> None:
    for command in (MavCmd.NAV_TAKEOFF, MavCmd.NAV_LAND, MavCmd.CONDITION_YAW):
        assert check(MissionItem(command), COMMANDS.taken) == MavMissionResult.UNSUPPORTED
    for command in (MavCmd.DO_SET_REVERSE, MavCmd.NAV_SET_YAW_SPEED):
        assert check(MissionItem(command), COPTER.taken) == MavMissionResult.UNSUPPORTED


def test_what_it_does_not_carry_out_is_passed_over() -> None:
    p = Missionary()
    assert p.sequencer is not None
    items = [at(WP, 0.0, 0.0), MissionItem(MavCmd.NAV_TAKEOFF), MissionItem(MavCmd.CONDITION_YAW), at(WP, 10.0, 0.0)]
    p.sequencer.set_mission(p.v, Mission.of(items))
    notes = p.sequencer.start(p.v)
    assert [note.text for note in notes if isinstance(note, Text)] == [
        "Mission: 1 Takeoff",
        "Mission: 2 CondYaw",
        "Mission: 3 WP",
        "Skipping invalid cmd #115",
    ]
    assert ItemReached(2) in notes and p.ap.modes.nav.command_seq == 3


@pytest.mark.parametrize(("given", "delay"), [(0.25, 0.25), (3.0, 3.0), (-1.0, 0.0)])
def test_a_delay_is_what_its_item_says(given: float, delay: float) -> None:
    rover = Rover()
    COMMANDS.give(rover.v, 1, MissionItem(MavCmd.NAV_DELAY, p1=given))
    assert rover.ap.modes.nav.delay == delay
