# SPDX-License-Identifier: BSD-3-Clause
"""A rover's failsafes at their edges: what a link, a battery and the estimate ask for, and when it waits."""

from __future__ import annotations

import pytest

from sitl.autopilot.modes import ModeReason
from sitl.autopilot.rover import failsafe
from sitl.autopilot.rover.modes.auto import AUTO
from sitl.autopilot.rover.modes.guided import GUIDED
from sitl.autopilot.rover.modes.hold import HOLD
from sitl.autopilot.rover.modes.loiter import LOITER
from sitl.autopilot.rover.modes.manual import MANUAL
from sitl.autopilot.rover.modes.set_mode import request
from sitl.autopilot.rover.modes.state import Modes
from sitl.autopilot.rover.parameters.safety import Failsafes
from sitl.autopilot.state import Estimate
from tests.autopilot.rover.modes.driven_rover import Rover


@pytest.mark.parametrize(
    ("action", "mode"), ((failsafe.DO_LOITER_OR_HOLD, LOITER), (failsafe.DO_HOLD, HOLD), (failsafe.NOTHING, MANUAL))
)
def test_a_failsafe_may_loiter(rover: Rover, action: int, mode: int) -> None:
    request(rover.v, MANUAL, ModeReason.GCS)
    failsafe.act(rover.v, action, ModeReason.FAILSAFE)
    assert rover.ap.modes.number == mode


def test_without_a_position_a_failsafe_that_would_loiter_holds(rover: Rover) -> None:
    request(rover.v, MANUAL, ModeReason.GCS)
    rover.set_estimate(False)
    rover.speed = 1.0
    failsafe.act(rover.v, failsafe.DO_LOITER_OR_HOLD, ModeReason.FAILSAFE)
    assert rover.ap.modes.number == HOLD


@pytest.mark.parametrize(("since_us", "long"), ((4_000_000, False), (4_000_001, True)))
def test_a_glitch_is_long_after_four_seconds(rover: Rover, since_us: int, long: bool) -> None:
    ekf = rover.ap.ekf
    ekf.gps_glitch, ekf.pos_fused_us, ekf.now_us = True, 7, 7 + since_us
    assert bool(failsafe.is_glitch_long(ekf)) == long


@pytest.mark.parametrize(("action", "mode", "told"), ((0.0, GUIDED, 1), (1.0, HOLD, 2), (2.0, GUIDED, 2)))
def test_fs_ekf_action(rover: Rover, action: float, mode: int, told: int) -> None:
    request(rover.v, GUIDED, ModeReason.GCS)
    rover.run(0.3)
    rover.events()
    rover.ap.params.FS.EKF_ACTION = action
    rover.set_estimate(False)
    while rover.ap.yaw_bank.asked_us == 0:
        rover.step()
    assert rover.ap.modes.failsafe.ekf_count == 8, "after 0.8 s the yaw is asked for"
    rover.run(0.4)
    assert rover.ap.modes.number == mode
    assert len(rover.texts()) == told


@pytest.mark.parametrize(
    ("mode", "options", "testing", "waits"),
    ((MANUAL, 0.0, 0, False), (HOLD, 0.0, 0, True), (HOLD, 1.0, 0, False), (11, 1.0, 0, True), (MANUAL, 0.0, 1, True)),
)
def test_a_lost_link_waits_on_the_way_home_in_hold_and_in_a_motor_test(
    rover: Rover, mode: int, options: float, testing: int, waits: bool
) -> None:
    rover.ap.params.FS.OPTIONS, rover.ap.control.motors.test_motor = options, testing
    assert bool(failsafe.waits(mode, rover.ap.control.motors, rover.ap.params.FS)) == waits


@pytest.mark.parametrize(("level", "wanted"), ((0, failsafe.NOTHING), (1, failsafe.DO_RTL), (2, failsafe.DO_HOLD)))
def test_a_battery_asks_for_what_its_level_says(rover: Rover, level: int, wanted: int) -> None:
    p = rover.ap.params.BATT
    p.FS_LOW_ACT, p.FS_CRT_ACT = 1.0, 2.0
    assert failsafe.battery_action(level, p) == wanted


@pytest.mark.parametrize(("enabled", "mode", "goes_on"), ((2.0, AUTO, True), (1.0, AUTO, False), (2.0, GUIDED, False)))
@pytest.mark.parametrize("link", (failsafe.BIT_RADIO, 2))
def test_a_mission_goes_on_without_a_link_when_told_so(
    rover: Rover, link: int, enabled: float, mode: int, goes_on: bool
) -> None:
    p = rover.ap.params.FS
    p.THR_ENABLE = p.GCS_ENABLE = 1.0
    if link == failsafe.BIT_RADIO:
        p.THR_ENABLE = enabled
    else:
        p.GCS_ENABLE = enabled
    assert bool(failsafe.goes_on(link, mode, p)) == goes_on


def test_an_estimate_that_was_bad_may_be_bad_again() -> None:
    modes, estimate, params = Modes(), Estimate(), Failsafes()
    params.EKF_THRESH, estimate.origin_set, modes.ekf_was_good = 0.8, True, True
    for _ in range(3):
        for good, seen in ((False, failsafe.EKF_FAILS), (True, failsafe.EKF_RECOVERS)):
            estimate.position_ok = good
            told = [failsafe.watch_estimate(modes, estimate, True, params, False) for _ in range(10)]
            assert told == [failsafe.EKF_SAME] * 9 + [seen]
    assert failsafe.watch_estimate(modes, estimate, False, params, False) == failsafe.EKF_SAME, "disarmed it was good"


@pytest.mark.parametrize(
    ("origin", "armed", "threshold", "watched"),
    (
        (0, True, 0.8, False),
        (1, False, 0.8, False),
        (1, True, 0.0, False),
        (1, True, -1.0, False),
        (1, True, 0.8, True),
    ),
)
def test_the_estimate_is_watched_armed_and_with_a_place(
    origin: int, armed: bool, threshold: float, watched: bool
) -> None:
    modes, estimate, params = Modes(), Estimate(), Failsafes()
    params.EKF_THRESH, estimate.origin_set, modes.ekf_was_good = threshold, origin, True
    told = [failsafe.watch_estimate(modes, estimate, armed, params, False) for _ in range(11)]
    assert (failsafe.EKF_FAILS in told) == watched


def test_a_long_glitch_makes_a_good_estimate_bad() -> None:
    modes, estimate, params = Modes(), Estimate(), Failsafes()
    params.EKF_THRESH, estimate.origin_set, modes.ekf_was_good, estimate.position_ok = 0.8, 1, True, 1
    told = [failsafe.watch_estimate(modes, estimate, True, params, True) for _ in range(10)]
    assert told[-1] == failsafe.EKF_FAILS
