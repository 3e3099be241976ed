# SPDX-License-Identifier: BSD-3-Clause
"""Failsafes: what sets them off, when, and what follows."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.estimation.state import Ekf
from sitl.autopilot.rover import failsafe, pilot
from sitl.autopilot.rover.modes.auto import AUTO
from sitl.autopilot.rover.modes.guided import GUIDED
from sitl.autopilot.rover.modes.hold import HOLD
from sitl.autopilot.rover.modes.manual import MANUAL
from sitl.autopilot.rover.modes.rtl import RTL
from sitl.autopilot.rover.modes.set_mode import request
from sitl.autopilot.rover.modes.smart_rtl import SMART_RTL
from sitl.autopilot.rover.modes.state import BIT_GCS, BIT_RADIO, LinksState, Modes
from sitl.autopilot.rover.parameters.safety import Failsafes
from sitl.autopilot.state import Estimate
from tests.autopilot.rover.modes.driven_rover import Rover


def driving(**params: float) -> Rover:
    rover = Rover(**params).arm()
    rover.run(1.5)
    rover.place(20.0, 0.0)
    rover.sticks(throttle=1600)
    rover.run(0.5)
    rover.events()
    return rover


@pytest.mark.parametrize(("place", "mode"), [(20.0, MANUAL), (40.0, HOLD)])
def test_a_fence_is_watched_while_it_drives(place: float, mode: int) -> None:
    rover = driving(FENCE_ENABLE=1.0, FENCE_TYPE=2.0, FENCE_RADIUS=30.0, FENCE_ACTION=2.0)
    assert request(rover.v, MANUAL, 1) == 0
    rover.place(place, 0.0)
    rover.run(0.5)
    assert rover.ap.modes.number == mode
    assert (rover.ap.fence.breached != 0) == (mode == HOLD)


def lose_radio(rover: Rover, seconds: float) -> None:
    rover.sticks(throttle=890)
    rover.run(seconds)


def test_a_lost_radio_centres_the_sticks_at_once_and_acts_later() -> None:
    rover = driving()
    lose_radio(rover, 0.04)
    assert pilot.sticks(rover.ap.modes.pilot, rover.ap.params) == (0.0, 0.0)
    rover.run(0.5)
    assert rover.ap.control.motors.throttle == 0.0
    assert rover.ap.modes.number == MANUAL
    rover.run(1.1)
    assert rover.ap.modes.number == HOLD
    assert rover.texts()[0] == "Radio Failsafe"


@pytest.mark.parametrize(
    ("action", "mode"), [(0, MANUAL), (1, RTL), (2, HOLD), (3, SMART_RTL), (4, SMART_RTL)], ids=str
)
def test_fs_action(action: int, mode: int) -> None:
    rover = driving(FS_ACTION=float(action))
    lose_radio(rover, 1.7)
    assert rover.ap.modes.number == mode


def test_smart_rtl_without_a_path_becomes_rtl_or_hold() -> None:
    for action, mode in ((3, RTL), (4, HOLD)):
        rover = driving(FS_ACTION=float(action), SRTL_POINTS=0.0)
        lose_radio(rover, 1.7)
        assert rover.ap.modes.number == mode


def test_a_radio_that_returns_in_time_is_forgiven() -> None:
    rover = driving()
    lose_radio(rover, 1.4)
    rover.sticks(throttle=1500)
    rover.run(2.0)
    assert rover.ap.modes.number == MANUAL
    assert rover.texts() == []


def test_cleared_is_said_and_the_mode_stays() -> None:
    rover = driving()
    lose_radio(rover, 2.0)
    assert rover.ap.rc.override[2] == 0  # overrides are dropped: the receiver takes over
    rover.run(0.1)
    assert rover.texts() == ["Radio Failsafe", "Radio Failsafe Cleared"]
    assert rover.ap.modes.number == HOLD


def test_hold_is_left_alone_unless_fs_options_says_so() -> None:
    for options, mode in ((0.0, HOLD), (1.0, RTL)):
        rover = driving(FS_ACTION=1.0, FS_OPTIONS=options)
        request(rover.v, HOLD, 2)
        lose_radio(rover, 2.0)
        assert rover.ap.modes.number == mode


def test_a_mission_goes_on_without_radio_when_told_so() -> None:
    rover = driving(FS_THR_ENABLE=2.0)
    rover.ap.modes.mission_count = 2
    assert request(rover.v, AUTO, 2) == 0
    rover.events()
    lose_radio(rover, 2.0)
    assert rover.ap.modes.number == AUTO
    assert rover.texts()[:2] == ["Radio Failsafe", "Failsafe - Continuing Auto Mode"]


def test_ground_station_lost() -> None:
    rover = driving(FS_GCS_ENABLE=1.0)
    rover.ap.modes.failsafe.gcs_us = int(rover.v.time_us)
    rover.run(6.4)
    assert rover.ap.modes.number == MANUAL
    rover.run(0.4)
    assert rover.ap.modes.number == HOLD
    assert rover.texts() == ["GCS Failsafe"]


@pytest.mark.parametrize(("action", "mode"), [(1, RTL), (2, HOLD), (3, SMART_RTL)])
def test_battery_low(action: int, mode: int) -> None:
    rover = driving(BATT_LOW_VOLT=10.5, BATT_LOW_TIMER=1.0, BATT_FS_LOW_ACT=float(action))
    rover.v.sensors.battery_voltage = 10.0
    rover.run(1.3)
    assert rover.ap.modes.number == mode


def test_battery_critical_may_disarm() -> None:
    rover = driving(BATT_CRT_VOLT=10.4, BATT_LOW_TIMER=1.0, BATT_FS_CRT_ACT=5.0)
    rover.v.sensors.battery_voltage = 10.0
    rover.run(1.3)
    assert rover.ap.arming.armed == 0


def test_bad_estimate_ends_modes_that_need_a_position() -> None:
    rover = driving()
    request(rover.v, GUIDED, 2)
    rover.events()
    rover.set_estimate(False)
    rover.run(0.8)
    assert rover.ap.modes.number == GUIDED
    rover.run(0.4)
    assert rover.ap.modes.number == HOLD
    assert rover.texts() == ["EKF variance", "EKF failsafe"]
    rover.set_estimate(True)
    rover.run(1.3)
    assert rover.texts() == ["EKF failsafe cleared"]


def test_bad_estimate_is_no_matter_in_manual_nor_before_it_was_good() -> None:
    rover = driving()
    rover.set_estimate(False)
    rover.run(2.0)
    assert rover.ap.modes.number == MANUAL
    never = Rover()
    never.set_estimate(False)
    never.arm().run(3.0)
    assert "EKF variance" not in never.texts()


@given(st.lists(st.tuples(st.sampled_from([BIT_RADIO, BIT_GCS]), st.booleans()), max_size=20))
def test_links_are_lost_since_the_first_of_them_and_over_with_the_last(seen: list[tuple[int, bool]]) -> None:
    links, lost, since = LinksState(), set(), 0
    for k, (bit, bad) in enumerate(seen, 1):
        links.acted = links.bad
        before = set(lost)
        (lost.add if bad else lost.discard)(bit)
        since = k if lost and not before else since
        assert failsafe.note_link(links, bit, bad, k) == bool(before and not lost)
        assert (links.bad, links.since_us) == (sum(lost), since)


def test_a_bad_estimate_counts_after_a_second_and_only_once_it_has_been_good() -> None:
    modes, estimate, params = Modes(), Estimate(), Failsafes()
    params.EKF_THRESH, estimate.origin_set = 0.8, True

    def watch(periods: int, good: bool) -> list[int]:
        estimate.position_ok = good
        return [failsafe.watch_estimate(modes, estimate, True, params, False) for _ in range(periods)]

    same, fails, recovers = failsafe.EKF_SAME, failsafe.EKF_FAILS, failsafe.EKF_RECOVERS
    assert watch(30, False) == [same] * 30
    assert watch(1, True) == [same]
    assert watch(12, False) == [same] * 9 + [fails] + [same] * 2
    assert watch(12, True) == [same] * 9 + [recovers] + [same] * 2
    watch(10, False)
    assert failsafe.watch_estimate(modes, estimate, False, params, False) == recovers


def test_a_rover_trusts_no_position_after_four_seconds_of_a_glitch() -> None:
    ekf = Ekf()
    ekf.gps_glitch, ekf.pos_fused_us = True, 10_000_000
    for now, long in ((13.9, False), (14.1, True)):
        ekf.now_us = round(now * 1e6)
        assert failsafe.is_glitch_long(ekf) == long
    ekf.gps_glitch = False
    assert not failsafe.is_glitch_long(ekf)


def test_a_loss_is_acted_upon_after_more_than_fs_timeout() -> None:
    for late, acted in ((0, False), (1, True)):
        rover = driving(FS_TIMEOUT=1.5)
        v, links = rover.v, rover.ap.modes.links
        failsafe.watch(v, BIT_RADIO, True)
        v.time_us += 1_500_000 + late
        failsafe.watch(v, BIT_RADIO, True)
        assert (links.acted != 0) == acted
