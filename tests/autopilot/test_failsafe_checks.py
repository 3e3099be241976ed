# SPDX-License-Identifier: BSD-3-Clause
"""Checks before arming and for failsafes that both firmwares share: laws on their own records."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot import arming_checks, battery, radio_checks
from sitl.autopilot.arming_checks import BATTERY_UNHEALTHY, COMPASSES, battery_checks, compass_checks
from sitl.autopilot.copter.event_list import EVENTS
from sitl.autopilot.events import Events
from sitl.autopilot.failsafe_checks import (
    BATTERY_MISSING,
    battery_fell_to,
    is_estimate_bad,
    is_gcs_lost,
    watch_monitor,
)
from sitl.autopilot.notes import Text
from sitl.autopilot.params.firmware_parameters import Parameters
from sitl.autopilot.params.simulation import DELIVERED
from sitl.autopilot.params.system import Battery, Compass, Failsafes
from sitl.autopilot.state import BatteryState, Estimate, Failsafe, Sensors
from sitl.core.vectors import Vec3


def monitored(**values: float) -> Battery:
    """Parameters of a battery with voltage and current sensors; all limits that are not given are off."""
    params = Battery()
    params.MONITOR, params.CAPACITY, params.VOLT_PIN = 4.0, 3000.0, 13.0
    for name, value in values.items():
        params[name] = value
    return params


def powered(params: Battery) -> BatteryState:
    """A battery that was there at power-on."""
    state = BatteryState()
    battery.power_on(state, params)
    return state


def test_charge_is_counted_from_the_current() -> None:
    state, sensors = powered(monitored()), Sensors()
    sensors.battery_voltage, sensors.battery_current = 11.0, 30.0
    for _ in range(1200):  # two minutes
        battery.monitor(state, sensors, monitored(), 0)
    assert state.consumed_mah == pytest.approx(1000.0) and state.consumed_wh == pytest.approx(11.0)
    assert state.remaining_pct == pytest.approx(100.0 * 2 / 3)


@pytest.mark.parametrize(("monitor", "voltage"), [(0.0, 0.0), (3.0, 11.0)])
def test_what_is_not_measured_is_unknown(monitor: float, voltage: float) -> None:
    params, sensors = monitored(MONITOR=monitor), Sensors()
    state = powered(params)
    sensors.battery_voltage, sensors.battery_current = 11.0, 30.0
    battery.monitor(state, sensors, params, 0)
    assert (state.voltage, state.current, state.remaining_pct) == (voltage, 0.0, -1.0)


def test_a_low_voltage_counts_when_it_lasts() -> None:
    fs, state, params = Failsafe(), BatteryState(), monitored(LOW_VOLT=10.5, LOW_TIMER=10.0)
    found = []
    for second in range(40):
        state.voltage = 10.0 if second not in (5, 6) else 11.0
        found.append(battery_fell_to(fs, state, True, 1_000_000 * (second + 1), params))
    assert found.index(1) == 17 and sum(found) == 1 and fs.battery == 1


@given(st.floats(0.0, 20.0), st.floats(0.0, 4000.0), st.floats(0.0, 20.0), st.floats(0.0, 4000.0))
def test_a_battery_only_gets_worse_and_is_reported_once(volt: float, used: float, low: float, left: float) -> None:
    fs, state = Failsafe(), BatteryState()
    params = monitored(LOW_VOLT=low, CRT_MAH=left)
    state.voltage, state.consumed_mah = volt, used
    levels = [battery_fell_to(fs, state, True, 100_000 * k, params) for k in range(1, 4)]
    assert fs.battery == max(levels) and sum(level != 0 for level in levels) <= 1
    state.voltage, state.consumed_mah = 20.0, 0.0
    assert battery_fell_to(fs, state, True, 500_000, params) == 0 and fs.battery == max(levels)


LIMITS = {"ARM_VOLT": 11.0, "ARM_MAH": 1000.0, "LOW_VOLT": 10.5, "LOW_MAH": 900.0, "CRT_VOLT": 10.2, "CRT_MAH": 800.0}


@pytest.mark.parametrize(
    ("changes", "volt", "used", "failed"),
    [
        ({}, 10.0, 2500.0, arming_checks.BATTERY_VOLTAGE),
        ({"ARM_VOLT": 0.0}, 12.0, 2500.0, arming_checks.BATTERY_CAPACITY),
        ({"ARM_VOLT": 0.0, "ARM_MAH": 0.0}, 10.0, 0.0, arming_checks.BATTERY_FAILSAFE),
        ({"ARM_MAH": 0.0}, 12.0, 2500.0, arming_checks.BATTERY_CAPACITY_FAILSAFE),
        ({"ARM_VOLT": 0.0, "LOW_VOLT": 0.0}, 10.0, 0.0, arming_checks.BATTERY_CRITICAL_VOLTAGE),
        ({"ARM_MAH": 0.0, "LOW_MAH": 0.0}, 12.0, 2500.0, arming_checks.BATTERY_CRITICAL_CAPACITY),
        ({"MONITOR": 3.0}, 12.0, 0.0, arming_checks.BATTERY_UNHEALTHY),
        ({"MONITOR": 0.0}, 12.0, 0.0, arming_checks.BATTERY_UNHEALTHY),
        ({"VOLT_PIN": -1.0}, 12.0, 0.0, arming_checks.BATTERY_UNHEALTHY),
        ({}, 12.0, 0.0, 0),
    ],
)
def test_the_first_thing_wrong_with_the_battery_forbids_arming(
    changes: dict[str, float], volt: float, used: float, failed: int
) -> None:
    params, state = Parameters(), powered(monitored())
    params.ARMING.CHECK = 1.0
    params.BATT.assign(monitored(**{**LIMITS, **changes}))
    state.voltage, state.consumed_mah = volt, used
    assert battery_checks(state, 0, params) == failed
    params.ARMING.CHECK = 8.0  # inertial sensors only
    assert battery_checks(state, 2, params) == 0


def test_a_monitor_that_does_not_exist_forbids_arming_until_it_is_chosen_no_more() -> None:
    params, state = Parameters(), powered(monitored(MONITOR=98.0))
    params.ARMING.CHECK = 1.0
    for monitor, failed in ((98.0, BATTERY_UNHEALTHY), (4.0, BATTERY_UNHEALTHY), (0.0, 0)):
        params.BATT.assign(monitored(MONITOR=monitor))
        assert battery_checks(state, 0, params) == failed


def test_a_monitor_that_fails_in_flight_is_told_once_and_keeps_what_it_measured() -> None:
    fs, events, sensors, params = Failsafe(), Events(), Sensors(), monitored()
    state = powered(params)
    sensors.battery_voltage = 12.0
    for tenth in range(150):
        params.VOLT_PIN = -1.0 if tenth > 20 else 13.0
        sensors.battery_voltage = 12.0 if tenth <= 20 else 11.0
        battery.monitor(state, sensors, params, 100_000 * tenth)
        watch_monitor(fs, state, True, events, 100_000 * tenth)
        assert (events.count, fs.battery_missing) == ((2, True) if tenth > 70 else (0, False)), tenth
    assert state.voltage == 12.0 and not state.healthy and events.a[1] == BATTERY_MISSING
    told = EVENTS[int(events.code[0])].notes(None, events.a[0], 3.0)
    assert told == [Text(4, "Battery 1 is missing, last: 12.00V used 3 mAh")]


def compasses(second: Vec3, params: Compass) -> int:
    """Failed checks with a first compass that shows 0.25 gauss north and 0.5 down, and no third."""
    sensors = Sensors()
    sensors.mag, sensors.mag2 = Vec3(0.25, 0.0, 0.5), second
    params.OFS.X, params.OFS.Y, params.OFS.Z = DELIVERED
    for diagonal in (params.DIA, params.DIA2):
        diagonal.X = diagonal.Y = diagonal.Z = 1.0
    return compass_checks(sensors, params)


@pytest.mark.parametrize(
    ("second", "agrees"),
    [
        ((0.0, 0.0, 0.0), True),  # there is none
        ((0.25, 0.0, 0.5), True),
        ((0.44, 0.0, 0.5), True),
        ((0.46, 0.0, 0.5), False),  # 0.2 gauss longer in the x-y plane
        ((0.16, 0.16, 0.5), True),
        ((0.12, 0.22, 0.5), False),  # 61 degrees in that plane
        ((0.25, 0.0, -0.1), True),
        ((0.25, 0.0, -0.2), False),  # more than 90 degrees in space
        ((0.0, 0.0, 0.5), False),
    ],
)
def test_compasses_must_agree(second: tuple[float, float, float], agrees: bool) -> None:
    params = Compass()
    params.USE2 = 1.0
    assert compasses(Vec3(*second), params) == (0 if agrees else COMPASSES)
    params.USE2 = 0.0
    assert compasses(Vec3(*second), params) == 0


def test_an_offset_of_a_compass_is_added_to_what_it_shows() -> None:
    params = Compass()
    params.USE2 = 1.0
    assert compasses(Vec3(0.25, -1.0, 0.5), params) == COMPASSES
    params.OFS2.Y = 1000.0
    assert compasses(Vec3(0.25, -1.0, 0.5), params) == 0


def test_a_ground_station_is_lost_only_when_it_was_there() -> None:
    fs, params = Failsafe(), Failsafes()
    params.GCS_ENABLE, params.GCS_TIMEOUT = 1.0, 5.0
    assert not is_gcs_lost(fs, 60_000_000, params)
    fs.gcs_us = 1_000_000
    assert not is_gcs_lost(fs, 6_000_000, params) and is_gcs_lost(fs, 6_000_001, params)


def test_without_a_position_the_estimate_is_bad() -> None:
    fs, est = Failsafe(), Estimate()
    assert is_estimate_bad(fs, est, 0.8, 0.0)
    est.position_ok = True
    assert not is_estimate_bad(fs, est, 0.8, 0.0)
    est.variance_vel, est.variance_mag = 0.9, float("nan")  # a filter about to restart says nothing
    assert not is_estimate_bad(fs, est, 0.8, 0.0)
    est.variance_mag = 0.9
    assert is_estimate_bad(fs, est, 0.8, 0.0)


NUMBERS = ("_SHIFT", "SECTORS", "REFUSED")
"""Ends of names of constants that are no bits."""


def test_every_check_is_a_bit_of_its_own_and_has_a_text() -> None:
    public = {name: value for name, value in vars(arming_checks).items() if name.isupper() and type(value) is int}
    bits = [
        value
        for name, value in public.items()
        if not (name.startswith(("BY_", "CHECK_", "COMPASS_", "_")) or name.endswith(NUMBERS))
    ]
    assert sorted(bits) == sorted(arming_checks.TEXTS)
    bits += [*radio_checks.OFF_CENTRE.values(), radio_checks.PARAMETERS]
    assert len(set(bits)) == len(bits) and all(bit & (bit - 1) == 0 for bit in bits)


def test_a_missing_home_explains_the_missing_position() -> None:
    missing = arming_checks.WAITING_FOR_HOME | arming_checks.NEED_POSITION
    assert arming_checks.texts(missing, Parameters(), "Arm: ") == ["Arm: AHRS: waiting for home"]
