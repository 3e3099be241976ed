# SPDX-License-Identifier: BSD-3-Clause
"""Failsafes: what starts them, what they do."""

from __future__ import annotations

import math

import pytest

from sitl.autopilot import failsafe_checks, smart_rtl_path
from sitl.autopilot.arming_checks import ArmingMethod
from sitl.autopilot.copter import failsafe, pilot
from sitl.autopilot.copter.failsafe_actions import NO_RETURN_PATH
from sitl.autopilot.failsafe_checks import FAILSAFE
from sitl.autopilot.modes import MODE_REFUSED
from sitl.autopilot.state import Failsafe
from tests.autopilot.copter.steady_copter import codes, fly, wait

STABILIZE, ALT_HOLD, AUTO, GUIDED, LOITER, RTL, LAND, BRAKE, SMART_RTL = 0, 2, 3, 4, 5, 6, 9, 17, 21


def test_three_bad_frames_lose_the_radio_and_three_good_ones_find_it() -> None:
    state = Failsafe()
    frames = (True, True, False, True, True, True, False, False, True, False)
    changed = [failsafe.count_radio(state, bad) for bad in frames]
    assert changed == [False] * 5 + [True] + [False] * 2 + [False, True]
    assert not state.radio


def test_a_second_of_a_bad_estimate_counts() -> None:
    state = Failsafe()
    for _ in range(10):
        assert state.ekf == 0
        failsafe.count_estimate(state, True)
    for _ in range(10):
        assert state.ekf == 1
        failsafe.count_estimate(state, False)
    assert (state.ekf, state.ekf_count) == (0, 0)


def lay_path(v):
    """SMART_RTL has a way back."""
    ap = v.autopilot
    smart_rtl_path.begin(ap.modes.path, ap.estimate.pos, True, v.time_us, ap.params.SRTL)


def lose_gcs(v):
    v.autopilot.modes.failsafe.gcs_us = v.time_us
    wait(v, 5.1)
    failsafe.watch_gcs(v)


@pytest.mark.parametrize(
    ("choice", "mode"),
    ((0, GUIDED), (1, RTL), (3, SMART_RTL), (4, SMART_RTL), (5, LAND), (6, RTL), (7, BRAKE), (99, RTL), (-1, RTL)),
)
def test_ground_station_lost(flying, choice, mode):
    lay_path(flying)
    flying.autopilot.params.FS_GCS_ENABLE = float(choice)
    lose_gcs(flying)
    assert flying.autopilot.modes.number == mode
    assert flying.autopilot.modes.failsafe.gcs == int(choice != 0)


def test_a_ground_station_that_never_was_is_not_lost(flying):
    flying.autopilot.params.FS_GCS_ENABLE = 1.0
    wait(flying, 100.0)
    failsafe.watch_gcs(flying)
    assert flying.autopilot.modes.number == GUIDED


def test_the_ground_station_comes_back(flying):
    flying.autopilot.params.FS_GCS_ENABLE = 1.0
    lose_gcs(flying)
    flying.autopilot.modes.failsafe.gcs_us = flying.time_us
    failsafe.watch_gcs(flying)
    assert flying.autopilot.modes.failsafe.gcs == 0
    assert flying.autopilot.modes.number == RTL
    assert codes(flying).count(FAILSAFE) == 2


@pytest.mark.parametrize(
    ("mode", "options", "stays"),
    ((AUTO, 2, True), (AUTO, 0, False), (LOITER, 16, True), (LOITER, 0, False), (GUIDED, 18, False)),
)
def test_options_let_a_mode_go_on_without_ground_station(flying, mode, options, stays):
    fly(flying, mode)
    flying.autopilot.params.FS_GCS_ENABLE = 1.0
    flying.autopilot.params.FS_OPTIONS = float(options)
    lose_gcs(flying)
    assert (flying.autopilot.modes.number == mode) == stays


@pytest.mark.parametrize(
    ("mode", "options", "says", "after"),
    (
        (LOITER, 0, "GCS Failsafe", RTL),
        (LOITER, 16, "GCS Failsafe - Continuing Pilot Control", LOITER),
        (AUTO, 2, "GCS Failsafe - Continuing Auto Mode", AUTO),
        (LAND, 8, "GCS Failsafe - Continuing Landing", LAND),
        (LAND, 0, "GCS Failsafe", RTL),
        (GUIDED, 26, "GCS Failsafe", RTL),
    ),
)
def test_what_follows_a_lost_ground_station_is_said(flying, mode, options, says, after):
    fly(flying, mode)
    flying.autopilot.params.FS_GCS_ENABLE = 1.0
    flying.autopilot.params.FS_OPTIONS = float(options)
    lose_gcs(flying)
    ring = flying.autopilot.events
    found = [k for k in range(ring.count) if ring.code[k] == FAILSAFE]
    assert [failsafe.text(int(ring.a[k]), int(ring.b[k])) for k in found] == [says]
    assert flying.autopilot.modes.number == after


def test_what_follows_a_lost_radio_is_said(flying):
    ap = flying.autopilot
    ap.params.FS_OPTIONS = 4.0
    ap.rc.channels[2] = 950
    for _ in range(3):
        failsafe.watch_radio(flying)
    k = ap.events.count - 1
    said = failsafe.text(int(ap.events.a[k]), int(ap.events.b[k]))
    assert (ap.modes.number, said) == (GUIDED, "Radio Failsafe - Continuing Guided Mode")
    assert failsafe.text(int(ap.events.a[k]), failsafe.AUTO_GOES_ON) == "Radio Failsafe - Continuing Auto"


@pytest.mark.parametrize(("action", "after"), ((1, LAND), (2, RTL), (0, RTL)))
def test_a_lost_radio_does_not_end_a_landing_for_the_battery(flying, action, after):
    fly(flying, LAND)
    ap = flying.autopilot
    ap.params.BATT_FS_CRT_ACT, ap.modes.failsafe.battery = float(action), 2
    ap.rc.channels[2] = 950
    for _ in range(3):
        failsafe.watch_radio(flying)
    said = {failsafe.text(int(a), int(b)) for a, b in zip(ap.events.a, ap.events.b, strict=True)}
    assert ap.modes.number == after
    assert ("Radio + Battery Failsafe - Continuing Landing" in said) == (after == LAND)


def test_on_the_ground_a_failsafe_disarms(flying):
    flying.autopilot.arming.landed = 1
    flying.autopilot.params.FS_GCS_ENABLE = 1.0
    lose_gcs(flying)
    assert flying.autopilot.arming.armed == 0


@pytest.mark.parametrize(
    ("choice", "mode"),
    ((0, LOITER), (1, RTL), (3, LAND), (4, SMART_RTL), (5, SMART_RTL), (6, RTL), (7, BRAKE), (99, LAND)),
)
def test_radio_lost_after_three_frames(flying, choice, mode):
    lay_path(flying)
    fly(flying, LOITER)
    ap = flying.autopilot
    ap.params.FS_THR_ENABLE = float(choice)
    ap.rc.channels[2] = 950
    failsafe.watch_radio(flying)
    failsafe.watch_radio(flying)
    assert ap.modes.number == LOITER
    failsafe.watch_radio(flying)
    assert ap.modes.number == mode


def test_without_receiver_the_radio_is_lost_and_the_sticks_are_centred(flying):
    fly(flying, LOITER)
    ap = flying.autopilot
    ap.rc.has_receiver = 0
    wait(flying, 1.1)
    for _ in range(3):
        pilot.read(flying)
        failsafe.watch_radio(flying)
    assert ap.modes.failsafe.radio == 1
    assert (ap.modes.number, ap.modes.pilot.throttle, pilot.climb_rate(ap.modes, ap.rc, ap.params)) == (RTL, 0.0, 0.0)
    ap.rc.has_receiver = 1
    for _ in range(4):
        pilot.read(flying)
        failsafe.watch_radio(flying)
    assert ap.modes.failsafe.radio == 0


@pytest.mark.parametrize(
    ("action", "mode"), ((failsafe.DO_SMART_RTL, RTL), (failsafe.DO_SMART_RTL_OR_LAND, LAND)), ids=("rtl", "land")
)
def test_without_a_path_smart_rtl_becomes_another_mode_and_that_is_told(flying, action, mode):
    failsafe.act(flying, action, 3, ArmingMethod.RADIO_FAILSAFE)
    assert flying.autopilot.modes.number == mode
    assert codes(flying)[:2] == [MODE_REFUSED, NO_RETURN_PATH]


def test_rtl_without_position_becomes_a_landing_that_waits(flying):
    fly(flying, ALT_HOLD)
    flying.autopilot.estimate.position_ok = 0
    failsafe.act(flying, failsafe.DO_RTL, 3, ArmingMethod.RADIO_FAILSAFE)
    assert flying.autopilot.modes.number == LAND
    assert flying.autopilot.modes.land.pause == 1


@pytest.mark.parametrize(
    ("action", "mode", "armed"),
    (
        (0, GUIDED, 1),
        (1, LAND, 1),
        (2, RTL, 1),
        (3, SMART_RTL, 1),
        (4, SMART_RTL, 1),
        (5, GUIDED, 0),
        (6, RTL, 1),
        (7, BRAKE, 1),
    ),
)
def test_battery_low_for_its_timer(flying, action, mode, armed):
    lay_path(flying)
    ap = flying.autopilot
    ap.params.BATT_MONITOR, ap.params.BATT_FS_LOW_ACT = 4.0, float(action)
    ap.battery.voltage = 10.4
    failsafe.watch_battery(flying)
    wait(flying, 9.9)
    failsafe.watch_battery(flying)
    assert ap.modes.failsafe.battery == 0
    wait(flying, 0.2)
    failsafe.watch_battery(flying)
    assert (ap.modes.failsafe.battery, ap.modes.number, ap.arming.armed) == (1, mode, armed)


def test_a_dip_of_the_voltage_is_forgiven(flying):
    ap = flying.autopilot
    ap.params.BATT_MONITOR = 4.0
    for voltage in (10.4, 11.0, 10.4):
        ap.battery.voltage = voltage
        failsafe.watch_battery(flying)
        wait(flying, 6.0)
    assert ap.modes.failsafe.battery == 0


def test_charge_critical_at_once(flying):
    ap = flying.autopilot
    ap.params.BATT_MONITOR, ap.params.BATT_CRT_MAH, ap.params.BATT_FS_CRT_ACT = 4.0, 300.0, 1.0
    ap.battery.voltage, ap.battery.consumed_mah = 12.0, 3100.0
    failsafe.watch_battery(flying)
    assert (ap.modes.failsafe.battery, ap.modes.number) == (2, LAND)


@pytest.mark.parametrize(
    ("mode", "action", "after"),
    (
        (GUIDED, 1, LAND),
        (GUIDED, 2, ALT_HOLD),
        (GUIDED, 0, GUIDED),
        (ALT_HOLD, 1, ALT_HOLD),
        (ALT_HOLD, 3, LAND),
    ),
)
def test_estimator_lost_for_a_second(flying, mode, action, after):
    fly(flying, mode)
    ap = flying.autopilot
    ap.params.FS_EKF_ACTION, ap.estimate.position_ok = float(action), 0
    for _ in range(9):
        failsafe.watch_estimate(flying)
    assert ap.modes.number == mode
    failsafe.watch_estimate(flying)
    assert (ap.modes.number, ap.modes.failsafe.ekf) == (after, 1)
    ring, codes_of = ap.events, list(ap.events.code)
    said = [failsafe.text(int(ring.a[k]), int(ring.b[k])) for k, code in enumerate(codes_of) if code == FAILSAFE]
    follows = "" if after == mode else f": changed to {'LAND' if after == LAND else 'ALT_HOLD'} Mode"
    assert said == ["EKF variance", f"EKF Failsafe{follows}"]
    if after == LAND:
        assert ap.modes.land.with_position == 0


@pytest.mark.parametrize(
    ("vel", "pos", "mag", "bad"),
    (
        (0.0, 5.0, 0.0, False),
        (0.9, 0.0, 0.0, False),
        (0.9, 0.9, 0.0, True),
        (0.9, 0.0, 0.9, True),
        (1.7, 0.0, 0.0, True),
        (0.0, 0.0, 0.9, False),
    ),
)
def test_two_test_ratios_count(flying, vel, pos, mag, bad):
    ap = flying.autopilot
    est = ap.estimate
    est.variance_vel, est.variance_pos, est.variance_mag = vel, pos, mag
    for _ in range(20):
        found = failsafe_checks.is_estimate_bad(ap.modes.failsafe, est, ap.params.FS.EKF_THRESH, ap.params.FS.EKF_FILT)
    assert found == bad


def test_texts():
    assert failsafe_checks.text(failsafe_checks.RADIO, True) == "Radio Failsafe"
    assert failsafe_checks.text(failsafe_checks.GCS, False) == "GCS Failsafe Cleared"
    assert failsafe_checks.text(failsafe_checks.BATTERY_LOW, False) is None


def test_a_variance_that_is_no_number_does_not_blind_the_failsafe(flying):
    ap = flying.autopilot
    ap.estimate.variance_vel = math.nan
    failsafe.watch_estimate(flying)
    ap.estimate.variance_vel = ap.estimate.variance_mag = 5.0
    for _ in range(40):
        failsafe.watch_estimate(flying)
    assert ap.modes.failsafe.ekf != 0
