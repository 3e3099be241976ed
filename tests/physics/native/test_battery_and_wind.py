# SPDX-License-Identifier: BSD-3-Clause
import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pytest import approx

from sitl import vehicles
from sitl.autopilot.copter.parameters import TABLE
from sitl.core import rng as random
from sitl.core.rng import Rng
from sitl.physics.native import battery, wind
from sitl.physics.native.atmosphere import density
from sitl.physics.native.records import BatteryState, Wind
from sitl.vehicle.copter import Copter, apply_sim_parameters


@given(st.floats(-0.5, 1.5), st.floats(0.0, 0.5))
def test_open_circuit_voltage_rises_with_charge(charge, more):
    low, high = battery.open_circuit(charge), battery.open_circuit(charge + more)
    assert 0.0 <= low <= high <= 1.0
    assert low > 0.7 or charge < battery.EMPTY
    assert low > 0.0 or charge <= 0.0


@given(st.floats(battery.EMPTY, 1.0))
def test_open_circuit_voltage_of_a_pack_in_use_is_the_curve(charge):
    k = min(int(charge * 10.0), 9)
    low, high = battery.OPEN_CIRCUIT[k : k + 2]
    assert battery.open_circuit(charge) == low + (charge * 10.0 - k) * (high - low)


def test_open_circuit_voltage_of_an_empty_pack_collapses():
    shares = [battery.open_circuit(battery.EMPTY * part) for part in (0.999999, 0.5, 0.01, 0.0)]
    assert shares == approx([0.740, 0.364, 0.00714, 0.0], rel=2e-3)


def discharge(rig, power):
    battery.discharge(rig.p.battery, power, rig.p.airframe, rig.p.derived.charge_per_amp)


def test_voltage_sags_under_load_and_falls_with_charge(rig):
    r = rig("erle_copter")
    discharge(r, 0.0)
    idle = r.p.battery.voltage
    for _ in range(400):
        discharge(r, 150.0)
    current = r.p.battery.current
    assert current == approx(0.8 + 150.0 / r.p.battery.voltage, rel=1e-6)
    assert idle - r.p.battery.voltage == approx(0.02 * (current - 0.8), abs=0.01)
    assert 1.0 - r.p.battery.charge == approx(current * 1.0 / 3600.0 / 5.0, rel=0.01)
    r.p.battery.charge = 0.0
    discharge(r, 150.0)
    assert r.p.battery.voltage == battery.LEAST * r.p.airframe.battery_voltage_full
    for _ in range(400):
        discharge(r, 150.0)
    assert r.p.battery.charge == 0.0
    assert math.isfinite(r.p.battery.current)


def test_empty_battery_limits_top_speed(rig):
    r = rig("erle_copter")
    r.p.battery.voltage = 9.0
    r.command(0.838)
    r.move(100)
    assert r.p.rotors.speed[0] == approx(838.0 * 9.0 / 10.8, rel=1e-6)


def test_ideal_source_keeps_its_voltage(rig):
    r = rig()
    discharge(r, 354.2)
    assert r.p.battery.voltage == 12.6
    assert r.p.battery.current == approx(28.1, abs=0.05)


def test_the_full_battery_may_have_another_voltage(rig):
    r = rig()
    r.p.battery.full_voltage = 10.0
    discharge(r, 354.2)
    assert r.p.battery.voltage == 10.0
    r = rig("erle_copter")
    idle = r.p.battery.voltage
    r.p.battery.full_voltage = 0.9 * r.p.airframe.battery_voltage_full
    discharge(r, 0.0)
    assert r.p.battery.voltage == approx(0.9 * idle, abs=0.02)


def test_wind_follows_its_setting():
    w, rng = Wind(), Rng()
    random.seed(rng, 1)
    before = rng.s.tolist()
    w.speed, w.direction, w.time_constant = 5.0, 90.0, 0.5
    for _ in range(25):
        wind.blow(w, rng, 10.0)
    assert w.vel.y == approx(-5.0 * (1.0 - math.exp(-1.0)), rel=0.02)
    assert w.vel.x == approx(0.0, abs=1e-12)
    assert rng.s.tolist() == before  # without turbulence the random numbers stay as they are


@pytest.mark.parametrize(("frame", "time_constant"), [("ardupilot_quad", 5.0 / math.tau), ("erle_copter", 5.0)])
def test_ardupilots_wind_changes_by_a_low_pass_of_one_over_its_time_constant(frame, time_constant):
    v = Copter()
    TABLE.set_defaults(v.autopilot.params)
    v.physics.airframe.wind_lag = vehicles.load(frame).value("wind_lag")
    for _ in range(2):
        apply_sim_parameters(v)
        assert v.physics.wind.time_constant == approx(time_constant)


def test_turbulence_has_its_deviation_and_correlation_time():
    w, rng = Wind(), Rng()
    random.seed(rng, 3)
    w.turbulence, w.time_constant = 2.0, 0.2
    gusts = np.empty(4000)
    for k in range(len(gusts)):
        wind.blow(w, rng, 10.0)
        gusts[k] = w.gust.x
    assert gusts.std() == approx(2.0, rel=0.1)
    after_tau = np.corrcoef(gusts[:-10], gusts[10:])[0, 1]  # 10 steps of 20 ms
    assert after_tau == approx((1.0 - 0.1) ** 10, abs=0.08)


@pytest.mark.parametrize("altitude, expected", [(0.0, 1.225), (593.0, 1.15682), (5000.0, 0.73612)])
def test_standard_density(altitude, expected):
    assert density(altitude) == approx(expected, rel=1e-4)


def test_a_rover_without_a_capacity_sags_under_load() -> None:
    """ArduPilot's simulator: 0.7 V at 50 A."""
    properties = SimpleNamespace(battery_voltage_full=12.6, battery_resistance=0.7 / 50.0)
    assert vehicles.load("ardupilot_rover").properties["battery_resistance"] == properties.battery_resistance
    state = BatteryState()
    state.voltage, state.current, state.capacity = 12.6, 13.7, 0.0
    battery.sag(state, properties, 0.0)
    assert state.voltage == pytest.approx(12.6 - 0.014 * 13.7)
    battery.sag(state, properties, 1e-6)
    assert state.voltage == pytest.approx(12.6 - 0.014 * 13.7), "with a capacity ``discharge`` has it"
    state.current = 1e6
    battery.sag(state, properties, 0.0)
    assert state.voltage == pytest.approx(1.26)
