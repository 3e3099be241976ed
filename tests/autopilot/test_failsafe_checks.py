# SPDX-License-Identifier: BSD-3-Clause
"""Checks before arming and for failsafes that both firmwares share: laws on their own records."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot import arming_checks, battery
from sitl.autopilot.arming_checks import BATTERY_CAPACITY, BATTERY_FAILSAFE, BATTERY_VOLTAGE, battery_checks
from sitl.autopilot.failsafe_checks import battery_fell_to, is_estimate_bad, is_gcs_lost
from sitl.autopilot.params.parameters import Parameters
from sitl.autopilot.params.system import Battery, Failsafes
from sitl.autopilot.state import BatteryState, Estimate, Failsafe, Sensors


def monitored(**figures: float) -> Battery:
    """Parameters of a battery with voltage and current sensors; all limits that are not given are off."""
    params = Battery()
    params.MONITOR, params.CAPACITY = 4.0, 3000.0
    for name, value in figures.items():
        params[name] = value
    return params


def test_charge_is_counted_from_the_current() -> None:
    state, sensors = BatteryState(), Sensors()
    sensors.battery_voltage, sensors.battery_current = 11.0, 30.0
    for _ in range(1200):  # two minutes
        battery.monitor(state, sensors, monitored())
    assert state.consumed_mah == pytest.approx(1000.0) and state.consumed_wh == pytest.approx(11.0)
    assert state.remaining_pct == pytest.approx(100.0 * 2 / 3)


@pytest.mark.parametrize(("monitor", "voltage"), [(0.0, 0.0), (3.0, 11.0)])
def test_what_is_not_measured_is_unknown(monitor: float, voltage: float) -> None:
    state, sensors = BatteryState(), Sensors()
    sensors.battery_voltage, sensors.battery_current = 11.0, 30.0
    battery.monitor(state, sensors, monitored(MONITOR=monitor))
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


def test_arming_wants_voltage_and_charge() -> None:
    params, state = Parameters(), BatteryState()
    params.ARMING.CHECK = 1.0
    params.BATT.assign(monitored(ARM_VOLT=11.0, ARM_MAH=1000.0))
    state.voltage, state.consumed_mah = 10.0, 2500.0
    assert battery_checks(state, 2, params) == BATTERY_VOLTAGE | BATTERY_CAPACITY | BATTERY_FAILSAFE
    params.ARMING.CHECK = 8.0  # inertial sensors only
    assert battery_checks(state, 2, params) == 0


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


def test_every_check_is_a_bit_of_its_own_and_has_a_text() -> None:
    public = {name: value for name, value in vars(arming_checks).items() if name.isupper() and isinstance(value, int)}
    bits = [value for name, value in public.items() if not name.startswith(("BY_", "CHECK_", "_"))]
    assert sorted(bits) == sorted(arming_checks.TEXTS)
    assert len(set(bits)) == len(bits) and all(bit & (bit - 1) == 0 for bit in bits)


def test_a_missing_home_explains_the_missing_position() -> None:
    missing = arming_checks.WAITING_FOR_HOME | arming_checks.NEED_POSITION
    assert arming_checks.texts(missing, "Arm: ") == ["Arm: AHRS: waiting for home"]
