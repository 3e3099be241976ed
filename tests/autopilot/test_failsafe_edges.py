# SPDX-License-Identifier: BSD-3-Clause
"""Failsafes of both firmwares at their edges: when exactly a limit counts, what is said, what the log gets."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot import failsafe_checks
from sitl.autopilot.copter import failsafe as copter
from sitl.autopilot.copter.failsafe_actions import NO_RETURN_PATH
from sitl.autopilot.events import Events
from sitl.autopilot.failsafe_checks import (
    BATTERY_CRITICAL,
    BATTERY_LOW,
    BATTERY_MISSING,
    EKF,
    EVENT_BATTERY_CRITICAL,
    EVENT_BATTERY_LOW,
    EVENT_BATTERY_MISSING,
    FAILSAFE,
    GCS,
    GLITCH,
    MISSING,
    RADIO,
    TERRAIN,
    UNHEALTHY_US,
    VARIANCE,
    VIBRATION,
    battery_fell_to,
    is_estimate_bad,
    is_gcs_lost,
    is_low,
    is_radio_bad,
    is_used_up,
    low_pass,
    low_since,
    report,
    report_battery,
    watch_monitor,
)
from sitl.autopilot.notes import Text
from sitl.autopilot.params.radio import RcMap
from sitl.autopilot.params.system import Battery, Failsafes
from sitl.autopilot.rover import failsafe as rover
from sitl.autopilot.state import BatteryState, Estimate, Failsafe, Radio
from sitl.core.mavlink import MavSeverity

KINDS = (RADIO, GCS, BATTERY_LOW, BATTERY_CRITICAL, EKF, BATTERY_MISSING, VIBRATION, TERRAIN, VARIANCE, GLITCH)
ON = {
    RADIO: "Radio Failsafe",
    GCS: "GCS Failsafe",
    BATTERY_LOW: "Battery Failsafe",
    BATTERY_CRITICAL: "Battery Failsafe",
    EKF: "EKF Failsafe",
    BATTERY_MISSING: "Battery Failsafe",
    VIBRATION: "Vibration compensation ON",
    VARIANCE: "EKF variance",
    GLITCH: "GPS Glitch or Compass error",
}
OFF = {
    RADIO: "Radio Failsafe Cleared",
    GCS: "GCS Failsafe Cleared",
    EKF: "EKF Failsafe Cleared",
    GLITCH: "Glitch cleared",
    VIBRATION: "Vibration compensation OFF",
}
CRITICAL = {EKF, VARIANCE, VIBRATION, GLITCH}


def test_kinds_have_numbers_of_their_own() -> None:
    assert len(set(KINDS)) == len(KINDS) and rover.CONTINUES not in KINDS


@pytest.mark.parametrize("kind", KINDS)
def test_each_kind_says_its_text_with_its_severity(kind: int) -> None:
    for how, texts in ((1.0, ON), (0.0, OFF)):
        severity = MavSeverity.CRITICAL if kind in CRITICAL else MavSeverity.WARNING
        wanted = [Text(severity, texts[kind])] if kind in texts else []
        assert copter.FAILSAFE.notes(None, float(kind), how) == wanted


@pytest.mark.parametrize(
    ("kind", "on", "severity", "said"),
    (
        (RADIO, 1.0, MavSeverity.WARNING, "Radio Failsafe"),
        (RADIO, 0.0, MavSeverity.INFO, "Radio Failsafe Cleared"),
        (EKF, 1.0, MavSeverity.CRITICAL, "EKF failsafe"),
        (EKF, 0.0, MavSeverity.CRITICAL, "EKF failsafe cleared"),
        (VARIANCE, 1.0, MavSeverity.CRITICAL, "EKF variance"),
        (rover.CONTINUES, 1.0, MavSeverity.WARNING, "Failsafe - Continuing Auto Mode"),
        (rover.CONTINUES, 0.0, MavSeverity.INFO, None),
        (BATTERY_LOW, 0.0, MavSeverity.INFO, None),
    ),
)
def test_a_rover_says_its_own(kind: int, on: float, severity: int, said: str | None) -> None:
    assert rover.FAILSAFE.notes(None, float(kind), on) == ([Text(severity, said)] if said else [])


@pytest.mark.parametrize(
    ("kind", "subsystem"), ((RADIO, 5), (BATTERY_LOW, 6), (BATTERY_CRITICAL, 6), (GCS, 8), (EKF, 17), (TERRAIN, 23))
)
def test_the_log_has_an_error_of_the_subsystem(kind: int, subsystem: int) -> None:
    """LogErrorSubsystem and FAILSAFE_OCCURRED, _RESOLVED of ArduPilot's logs."""
    assert FAILSAFE.rows(None, float(kind), 3.0) == [("ERR", (subsystem, 1))]
    assert FAILSAFE.rows(None, float(kind), 0.0) == [("ERR", (subsystem, 0))]


@pytest.mark.parametrize("kind", (VARIANCE, GLITCH, VIBRATION, BATTERY_MISSING))
def test_other_kinds_are_logged_elsewhere(kind: int) -> None:
    assert FAILSAFE.rows(None, float(kind), 1.0) == []


@pytest.mark.parametrize(
    ("which", "how", "said"),
    (
        (EKF, copter.EKF_LANDS, "EKF Failsafe: changed to LAND Mode"),
        (EKF, copter.EKF_HOLDS, "EKF Failsafe: changed to ALT_HOLD Mode"),
        (EKF, 1, "EKF Failsafe"),
        (RADIO, copter.BATTERY_LANDS, "Radio + Battery Failsafe - Continuing Landing"),
        (RADIO, copter.DISARMS, "Radio Failsafe - Disarming"),
        (GCS, copter.DISARMS, "GCS Failsafe - Disarming"),
        (RADIO, copter.AUTO_GOES_ON, "Radio Failsafe - Continuing Auto"),
        (GCS, copter.AUTO_GOES_ON, "GCS Failsafe - Continuing Auto Mode"),
        (GCS, copter.PILOT_GOES_ON, "GCS Failsafe - Continuing Pilot Control"),
        (RADIO, copter.GUIDED_GOES_ON, "Radio Failsafe - Continuing Guided Mode"),
        (RADIO, copter.LANDING_GOES_ON, "Radio Failsafe - Continuing Landing"),
        (TERRAIN, copter.ACTS, None),
    ),
)
def test_what_follows_is_said_with_it(which: int, how: int, said: str | None) -> None:
    assert copter.text(which, how) == said


@pytest.mark.parametrize(
    ("does", "by_mission", "said"),
    (
        (copter.DO_RTL, 0.0, "SmartRTL Unavailable, Trying RTL Mode"),
        (copter.DO_LAND, 0.0, "SmartRTL Unavailable, Using Land Mode"),
        (copter.DO_RTL, 1.0, "Trying RTL Mode"),
    ),
)
def test_what_is_done_instead_of_a_way_back_is_said(does: int, by_mission: float, said: str) -> None:
    assert NO_RETURN_PATH.notes(None, float(does), by_mission) == [Text(MavSeverity.WARNING, said)]


@pytest.mark.parametrize(
    ("level", "event", "kind", "text"),
    (
        (1, EVENT_BATTERY_LOW, BATTERY_LOW, "Battery 1 is low 10.46V used 1235 mAh"),
        (2, EVENT_BATTERY_CRITICAL, BATTERY_CRITICAL, "Battery 1 is critical 10.46V used 1235 mAh"),
        (MISSING, EVENT_BATTERY_MISSING, BATTERY_MISSING, "Battery 1 is missing, last: 10.46V used 1235 mAh"),
    ),
)
def test_a_battery_is_reported_with_its_voltage_and_charge(level: int, event: Any, kind: int, text: str) -> None:
    events, battery = Events(), BatteryState()
    battery.voltage, battery.consumed_mah = 10.456, 1234.6
    report_battery(events, 7, level, battery)
    assert (events.count, events.code[0], events.code[1], events.a[1], events.b[1]) == (2, event, FAILSAFE, kind, 1.0)
    assert event.notes(None, events.a[0], events.b[0]) == [Text(MavSeverity.WARNING, text)]
    assert events.time_us[0] == events.time_us[1] == 7


def test_a_battery_that_is_well_is_not_reported() -> None:
    events = Events()
    report_battery(events, 7, 0, BatteryState())
    report(events, 7, GCS, False)
    assert (events.count, events.a[0], events.b[0]) == (1, GCS, 0.0)


@pytest.mark.parametrize(
    ("voltage", "limit", "low"), ((10.5, 10.5, False), (10.49, 10.5, True), (0.0, 0.0, False), (-1.0, 0.0, False))
)
def test_a_voltage_is_low_below_its_limit(voltage: float, limit: float, low: bool) -> None:
    assert is_low(voltage, limit) == low


@pytest.mark.parametrize(
    ("used", "limit", "monitor", "up"),
    ((2700.0, 300.0, 4.0, False), (2700.1, 300.0, 4.0, True), (9e9, 0.0, 4.0, False), (2900.0, 300.0, 3.0, False)),
)
def test_charge_is_used_up_below_its_limit_where_it_is_measured(
    used: float, limit: float, monitor: float, up: bool
) -> None:
    p = Battery()
    p.CAPACITY, p.MONITOR = 3000.0, monitor
    assert is_used_up(used, limit, p) == up


def test_a_voltage_is_low_since_it_was_first() -> None:
    assert (low_since(0, True, 5), low_since(3, True, 5), low_since(3, False, 5)) == (5, 3, 0)


@pytest.mark.parametrize(("lasts_us", "level"), ((9_999_999, 0), (10_000_000, 2)))
@pytest.mark.parametrize("name", ("LOW", "CRT"))
def test_a_low_voltage_counts_after_all_of_its_timer(name: str, lasts_us: int, level: int) -> None:
    fs, battery, p = Failsafe(), BatteryState(), Battery()
    p.MONITOR, p.LOW_TIMER, battery.voltage = 3.0, 10.0, 9.0
    p[f"{name}_VOLT"] = 9.5
    assert battery_fell_to(fs, battery, True, 1_000_000, p) == 0
    found = battery_fell_to(fs, battery, True, 1_000_000 + lasts_us, p)
    assert found == (min(level, 1) if name == "LOW" else level)


@pytest.mark.parametrize(("monitor", "armed"), ((2.9, True), (0.0, True), (4.0, False)))
def test_without_a_monitor_or_disarmed_a_battery_is_not_watched(monitor: float, armed: bool) -> None:
    fs, battery, p = Failsafe(), BatteryState(), Battery()
    p.MONITOR, p.LOW_VOLT, p.CRT_VOLT, battery.voltage = monitor, 10.0, 10.0, 9.0
    fs.battery_low_us = fs.battery_critical_us = 5
    assert battery_fell_to(fs, battery, armed, 100_000_000, p) == 0
    assert (fs.battery_low_us, fs.battery_critical_us, fs.battery) == (0, 0, 0)


def test_a_critical_battery_stays_so_and_is_not_low_again() -> None:
    fs, battery, p = Failsafe(), BatteryState(), Battery()
    p.MONITOR, p.LOW_VOLT, p.CRT_VOLT, p.LOW_TIMER, battery.voltage = 4.0, 10.5, 10.0, 0.0, 9.0
    assert [battery_fell_to(fs, battery, True, k, p) for k in (1, 2)] == [2, 0]
    battery.voltage = 10.2
    assert battery_fell_to(fs, battery, True, 3, p) == 0 and fs.battery == 2


def test_a_low_battery_may_become_critical() -> None:
    fs, battery, p = Failsafe(), BatteryState(), Battery()
    p.MONITOR, p.LOW_VOLT, p.CRT_VOLT, p.LOW_TIMER, battery.voltage = 4.0, 10.5, 10.0, 0.0, 10.2
    assert battery_fell_to(fs, battery, True, 1, p) == 1
    battery.voltage = 9.9
    assert battery_fell_to(fs, battery, True, 2, p) == 2


@pytest.mark.parametrize(
    ("silent_us", "armed", "driver", "level", "missing"),
    (
        (UNHEALTHY_US, True, 4, 0, False),
        (UNHEALTHY_US + 1, True, 4, 0, True),
        (UNHEALTHY_US + 1, False, 4, 0, False),
        (UNHEALTHY_US + 1, True, 0, 0, False),
        (UNHEALTHY_US + 1, True, 4, 1, False),
    ),
)
def test_a_monitor_is_missing_after_five_seconds_in_flight(
    silent_us: int, armed: bool, driver: int, level: int, missing: bool
) -> None:
    fs, battery, events = Failsafe(), BatteryState(), Events()
    battery.healthy_us, battery.driver, fs.battery = 1_000, driver, level
    for _ in range(2):
        watch_monitor(fs, battery, armed, events, 1_000 + silent_us)
    assert UNHEALTHY_US == 5_000_000 and bool(fs.battery_missing) == missing
    assert events.count == (2 if missing else 0), "once"


@pytest.mark.parametrize(
    ("heard", "fitted", "works", "pulse", "bad"),
    (
        (0, 0, 0, 900, False),  # there is none
        (1, 0, 0, 1500, True),
        (0, 1, 0, 1500, True),
        (1, 0, 1, 975, False),
        (1, 0, 1, 974, True),
        (0, 1, 1, 974, True),
        (0, 0, 1, 974, False),
    ),
)
def test_a_radio_is_bad_that_is_silent_or_low(heard: int, fitted: int, works: int, pulse: int, bad: bool) -> None:
    rc, rcmap = Radio(), RcMap()
    rcmap.THROTTLE = 3.0
    rc.receiver_us, rc.has_receiver, rc.receiver_ok, rc.channels[2] = heard, fitted, works, pulse
    assert bool(is_radio_bad(rc, rcmap, 975.0)) == bad


@pytest.mark.parametrize(
    ("enabled", "last", "now", "lost"),
    ((0.0, 1, 99_000_000, False), (2.0, 1, 5_000_001, False), (2.0, 1, 5_000_002, True), (1.0, 0, 99_000_000, False)),
)
def test_a_ground_station_is_lost_after_fs_gcs_timeout_where_enabled(
    enabled: float, last: int, now: int, lost: bool
) -> None:
    fs, p = Failsafe(), Failsafes()
    p.GCS_ENABLE, p.GCS_TIMEOUT, fs.gcs_us = enabled, 5.0, last
    assert bool(is_gcs_lost(fs, now, p)) == lost


@pytest.mark.parametrize(
    ("vel", "pos", "mag", "bad"),
    (
        (0.8, 0.8, 0.0, True),  # at the limit is over it
        (0.8, 0.0, 0.8, True),
        (0.0, 0.8, 0.8, True),
        (1.6, 0.0, 0.0, True),  # twice over counts double
        (1.59, 0.0, 0.0, False),
        (0.79, 0.8, 0.0, False),
        (0.8, 0.79, 0.79, False),
        (0.0, 9.0, 0.0, False),  # the position counts with another only
        (0.0, 0.0, 9.0, False),
    ),
)
def test_two_ratios_make_an_estimate_bad(vel: float, pos: float, mag: float, bad: bool) -> None:
    fs, est = Failsafe(), Estimate()
    est.position_ok, est.variance_vel, est.variance_pos, est.variance_mag = 1, vel, pos, mag
    assert bool(is_estimate_bad(fs, est, 0.8, 0.0)) == bad
    est.position_ok = 0
    assert is_estimate_bad(fs, est, 0.8, 0.0)


def test_ratios_are_filtered_at_the_cutoff() -> None:
    fs, est = Failsafe(), Estimate()
    est.variance_vel, est.variance_pos, est.variance_mag = 1.0, 2.0, 3.0
    is_estimate_bad(fs, est, 0.8, 5.0)
    gain = 0.1 / (0.1 + 1.0 / (math.tau * 5.0))
    assert (fs.ekf_vel, fs.ekf_pos, fs.ekf_mag) == pytest.approx((gain, 2.0 * gain, 3.0 * gain))
    assert low_pass(0.5, math.nan, 0.3) == 0.5 and low_pass(0.5, 1.5, 0.25) == 0.75


def test_texts_are_of_the_shared_table() -> None:
    assert failsafe_checks.text(99, True) is None and copter.text(99, 1) is None and rover.text(99, 1) is None
