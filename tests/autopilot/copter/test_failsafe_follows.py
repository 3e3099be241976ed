# SPDX-License-Identifier: BSD-3-Clause
"""What follows a copter's failsafes: the next best where an action cannot be had, landings that go on, on the ground
nothing but disarming."""

from __future__ import annotations

from typing import Any

import pytest

from sitl.autopilot.arming_checks import ArmingMethod
from sitl.autopilot.copter import failsafe
from sitl.autopilot.copter import failsafe_actions as actions
from sitl.autopilot.copter.failsafe_actions import NO_RETURN_PATH
from sitl.autopilot.copter.modes import rtl
from sitl.autopilot.failsafe_checks import EKF, FAILSAFE, GCS, RADIO, VARIANCE
from sitl.autopilot.modes import ModeReason
from tests.autopilot.copter.steady_copter import codes, fly, told

STABILIZE, ALT_HOLD, AUTO, GUIDED, LOITER, RTL, LAND, BRAKE, SMART_RTL = 0, 2, 3, 4, 5, 6, 9, 17, 21
NO_POSITION = "position"


def act(v: Any, action: int) -> Any:
    failsafe.act(v, action, ModeReason.RADIO_FAILSAFE, ArmingMethod.RADIO_FAILSAFE)
    return v.autopilot


@pytest.mark.parametrize(
    ("choice", "radio", "gcs", "battery"),
    (
        (0, actions.NOTHING, actions.NOTHING, actions.NOTHING),
        (1, actions.DO_RTL, actions.DO_RTL, actions.DO_LAND),
        (2, actions.DO_RTL, actions.DO_RTL, actions.DO_RTL),
        (3, actions.DO_LAND, actions.DO_SMART_RTL, actions.DO_SMART_RTL),
        (4, actions.DO_SMART_RTL, actions.DO_SMART_RTL_OR_LAND, actions.DO_SMART_RTL_OR_LAND),
        (5, actions.DO_SMART_RTL_OR_LAND, actions.DO_LAND, actions.DO_STOP),
        (6, actions.DO_AUTO_RTL, actions.DO_AUTO_RTL, actions.DO_AUTO_RTL),
        (7, actions.DO_BRAKE, actions.DO_BRAKE, actions.DO_BRAKE),
        (8, actions.DO_LAND, actions.DO_RTL, actions.NOTHING),
        (-1, actions.DO_LAND, actions.DO_RTL, actions.NOTHING),
    ),
)
def test_choices_of_the_parameters_mean_what_ardupilot_documents(
    choice: int, radio: int, gcs: int, battery: int
) -> None:
    """FS_THR_ENABLE, FS_GCS_ENABLE, BATT_FS_LOW_ACT."""
    got = (actions.radio_action(choice), actions.gcs_action(choice), actions.battery_action(choice))
    assert got == (radio, gcs, battery)


@pytest.mark.parametrize(
    ("action", "lacks", "mode", "waits"),
    (
        (actions.DO_LAND, "", LAND, True),
        (actions.DO_RTL, "", RTL, False),
        (actions.DO_RTL, NO_POSITION, LAND, True),
        (actions.DO_BRAKE, "", BRAKE, False),
        (actions.DO_BRAKE, NO_POSITION, LAND, True),
        (actions.DO_SMART_RTL, NO_POSITION, LAND, True),
        (actions.DO_SMART_RTL_OR_LAND, "", LAND, True),
        (actions.DO_AUTO_RTL, "", RTL, False),
        (actions.DO_AUTO_RTL, NO_POSITION, LAND, True),
        (actions.NOTHING, "", GUIDED, False),
    ),
)
def test_what_cannot_be_had_becomes_the_next_best_and_a_landing_waits(
    flying: Any, action: int, lacks: str, mode: int, waits: bool
) -> None:
    if lacks == NO_POSITION:
        flying.autopilot.estimate.position_ok = 0
    ap = act(flying, action)
    assert (ap.modes.number, bool(ap.modes.land.pause)) == (mode, waits)
    if action != actions.NOTHING:
        assert ap.modes.reason == ModeReason.RADIO_FAILSAFE


def test_a_mission_without_a_part_that_returns_becomes_rtl_and_that_is_told(flying: Any) -> None:
    act(flying, actions.DO_AUTO_RTL)
    assert told(flying, NO_RETURN_PATH) == [(float(actions.DO_RTL), 1.0)]


@pytest.mark.parametrize(("action", "does"), ((actions.DO_SMART_RTL, 2.0), (actions.DO_SMART_RTL_OR_LAND, 1.0)))
def test_a_missing_path_is_told(flying: Any, action: int, does: float) -> None:
    act(flying, action)
    assert told(flying, NO_RETURN_PATH) == [(does, 0.0)]


@pytest.mark.parametrize(("mode", "action"), ((RTL, actions.DO_RTL), (LAND, actions.DO_LAND)))
def test_a_mode_that_is_flown_already_is_not_begun_anew(flying: Any, mode: int, action: int) -> None:
    fly(flying, mode)
    flying.autopilot.modes.rtl.state = rtl.LOITER
    ap = act(flying, action)
    assert (ap.modes.number, ap.modes.rtl.state, bool(ap.modes.land.pause)) == (mode, rtl.LOITER, False)
    assert codes(flying) == []


@pytest.mark.parametrize(("options", "mode"), ((8.0, LAND), (0.0, RTL), (16.0, RTL)))
def test_a_landing_goes_on_with_its_option(flying: Any, options: float, mode: int) -> None:
    fly(flying, LAND)
    flying.autopilot.params.FS.OPTIONS = options
    assert act(flying, actions.DO_RTL).modes.number == mode


@pytest.mark.parametrize(
    ("mode", "landed", "closed", "action", "armed"),
    (
        (GUIDED, 1, 0, actions.DO_RTL, False),
        (GUIDED, 0, 1, actions.DO_RTL, True),  # its throttle is not the stick's
        (STABILIZE, 0, 1, actions.DO_RTL, False),
        (STABILIZE, 1, 0, actions.DO_RTL, True),
        (GUIDED, 0, 0, actions.DO_STOP, False),
        (GUIDED, 1, 0, actions.NOTHING, True),
    ),
)
def test_it_disarms_where_that_is_safe_or_asked_for(
    flying: Any, mode: int, landed: int, closed: int, action: int, armed: bool
) -> None:
    fly(flying, mode)
    flying.autopilot.arming.landed, flying.autopilot.modes.pilot.throttle_zero = landed, closed
    assert bool(act(flying, action).arming.armed) == armed


def test_disarmed_nothing_follows(flying: Any) -> None:
    flying.autopilot.arming.armed = 0
    assert act(flying, actions.DO_RTL).modes.number == GUIDED


@pytest.mark.parametrize(
    ("mode", "options", "radio", "gcs"),
    (
        (AUTO, 1, failsafe.AUTO_GOES_ON, failsafe.ACTS),
        (AUTO, 2, failsafe.ACTS, failsafe.AUTO_GOES_ON),
        (AUTO, 0, failsafe.ACTS, failsafe.ACTS),
        (GUIDED, 4, failsafe.GUIDED_GOES_ON, failsafe.ACTS),
        (GUIDED, 3, failsafe.ACTS, failsafe.ACTS),
        (LOITER, 16, failsafe.ACTS, failsafe.PILOT_GOES_ON),
        (AUTO, 16, failsafe.ACTS, failsafe.ACTS),
        (LOITER, 15, failsafe.ACTS, failsafe.ACTS),
    ),
)
def test_fs_options_lets_modes_go_on(mode: int, options: int, radio: int, gcs: int) -> None:
    assert (failsafe.without_radio(mode, options), failsafe.without_gcs(mode, options)) == (radio, gcs)


@pytest.mark.parametrize(
    ("level", "low", "critical", "lands"),
    (
        (0, 1.0, 1.0, False),
        (1, 1.0, 2.0, True),
        (1, 2.0, 1.0, False),
        (2, 2.0, 1.0, True),
        (2, 1.0, 2.0, False),
        (1, 5.0, 0.0, True),
    ),
)
def test_a_battery_is_why_it_lands_when_its_action_says_so(
    flying: Any, level: int, low: float, critical: float, lands: bool
) -> None:
    p, fs = flying.autopilot.params.BATT, flying.autopilot.modes.failsafe
    fs.battery, p.FS_LOW_ACT, p.FS_CRT_ACT = level, low, critical
    assert bool(failsafe.battery_lands(fs, p)) == lands


@pytest.mark.parametrize(
    ("armed", "landed", "mode", "for_battery", "options", "how"),
    (
        (0, 0, GUIDED, False, 0, failsafe.ACTS),
        (1, 1, GUIDED, False, 0, failsafe.DISARMS),
        (1, 0, LAND, True, 0, failsafe.BATTERY_LANDS),
        (1, 0, LAND, False, 8, failsafe.LANDING_GOES_ON),
        (1, 0, LAND, False, 0, failsafe.AUTO_GOES_ON),
        (1, 0, GUIDED, True, 8, failsafe.AUTO_GOES_ON),
    ),
)
def test_what_follows_the_loss_of_a_link(
    flying: Any, armed: int, landed: int, mode: int, for_battery: bool, options: int, how: int
) -> None:
    """``AUTO_GOES_ON`` stands for what else would."""
    ap = fly(flying, mode).autopilot
    ap.arming.armed, ap.arming.landed = armed, landed
    got = failsafe.follows(ap.modes, ap.arming, failsafe.AUTO_GOES_ON, options, for_battery)
    assert got == how


@pytest.mark.parametrize(
    ("how", "mode"),
    (
        (failsafe.ACTS, RTL),
        (failsafe.LANDING_GOES_ON, LAND),
        (failsafe.BATTERY_LANDS, LAND),
        (failsafe.AUTO_GOES_ON, GUIDED),
    ),
)
def test_the_loss_is_told_and_done(flying: Any, how: int, mode: int) -> None:
    failsafe.lose(flying, GCS, how, actions.DO_RTL, ModeReason.GCS_FAILSAFE, ArmingMethod.GCS_FAILSAFE)
    assert told(flying, FAILSAFE) == [(float(GCS), float(how))] and flying.autopilot.modes.number == mode


@pytest.mark.parametrize(
    ("enabled", "threshold", "pulse", "lost"),
    ((0.0, 975.0, 900, False), (1.0, 975.0, 974, True), (1.0, 950.0, 960, False)),
)
def test_fs_thr_value_counts_where_fs_thr_enable_is_set(
    flying: Any, enabled: float, threshold: float, pulse: int, lost: bool
) -> None:
    ap = flying.autopilot
    ap.params.FS.THR_ENABLE, ap.params.FS.THR_VALUE, ap.rc.channels[2] = enabled, threshold, pulse
    for _ in range(3):
        failsafe.watch_radio(flying)
    assert bool(ap.modes.failsafe.radio) == lost
    ap.rc.channels[2] = 1500
    for _ in range(3):
        failsafe.watch_radio(flying)
    wanted = [(float(RADIO), float(failsafe.ACTS)), (float(RADIO), 0.0)]
    assert told(flying, FAILSAFE) == (wanted if lost else [])


@pytest.mark.parametrize(("level", "mode"), ((1, RTL), (2, LAND)), ids=("low", "critical"))
def test_a_battery_does_what_its_level_asks_for(flying: Any, level: int, mode: int, monkeypatch: Any) -> None:
    p = flying.autopilot.params.BATT
    p.FS_LOW_ACT, p.FS_CRT_ACT = 2.0, 1.0
    monkeypatch.setattr(failsafe, "battery_fell_to", lambda *args: level)
    failsafe.watch_battery(flying)
    assert (flying.autopilot.modes.number, flying.autopilot.modes.reason) == (mode, ModeReason.BATTERY_FAILSAFE)


@pytest.mark.parametrize(
    ("mode", "action", "ends"),
    (
        (GUIDED, 0, False),
        (GUIDED, 1, True),
        (GUIDED, 2, True),
        (ALT_HOLD, 1, False),
        (ALT_HOLD, 2, False),
        (ALT_HOLD, 3, True),
        (LAND, 0, True),
    ),
)
def test_a_bad_estimate_ends_modes_that_need_a_position_or_with_3_all(mode: int, action: int, ends: bool) -> None:
    assert bool(failsafe.ends_for_estimate(mode, action)) == ends


def test_a_landing_goes_on_without_a_position(flying: Any) -> None:
    ap = fly(flying, LAND).autopilot
    ap.modes.land.with_position = 1
    assert failsafe.act_on_estimate(flying) == 1
    assert (ap.modes.number, ap.modes.land.with_position, bool(ap.modes.land.pause)) == (LAND, 0, False)


def test_a_bad_estimate_is_told_after_a_second_and_when_it_is_over_and_asks_for_the_yaw_before(flying: Any) -> None:
    ap = flying.autopilot
    ap.estimate.position_ok = 0
    for k in range(10):
        flying.time_us += 100_000
        failsafe.watch_estimate(flying)
        asked = ap.yaw_bank.asked_us
        assert (asked != 0) == (k >= 7)
    assert asked == flying.time_us - 200_000, "once"
    assert told(flying, FAILSAFE) == [(float(VARIANCE), 1.0), (float(EKF), float(failsafe.EKF_LANDS))]
    ap.estimate.position_ok = 1
    for _ in range(10):
        assert ap.modes.failsafe.ekf == 1
        failsafe.watch_estimate(flying)
    assert told(flying, FAILSAFE)[2:] == [(float(EKF), 0.0)]
