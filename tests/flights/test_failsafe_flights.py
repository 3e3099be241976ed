# SPDX-License-Identifier: BSD-3-Clause
"""Failsafes in the air: ground station, radio, battery, GPS; crashes and termination."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.recorded.pilot import ARM
from sitl.core.mavlink import MavCmd
from sitl.simulation import Core
from tests.flights.aviator import (
    AIRFRAMES,
    ALT_HOLD,
    AUTO,
    BRAKE,
    GUIDED,
    LAND,
    LOITER,
    RTL,
    SMART_RTL,
    STABILIZE,
    Aviator,
    Item,
)

BOTH = pytest.mark.parametrize("frame", AIRFRAMES)


def beat(p: Aviator) -> None:
    """A ground station's heartbeat."""
    p.send("HEARTBEAT", type=6, autopilot=8, system_status=4, mavlink_version=3)


@pytest.mark.parametrize(
    ("choice", "mode"), [(0, GUIDED), (1, RTL), (2, RTL), (3, SMART_RTL), (5, LAND), (7, BRAKE), (99, RTL)]
)
def test_ground_station_lost(core: Core, choice: int, mode: int) -> None:
    p = Aviator(core, FS_GCS_ENABLE=choice).hover()
    beat(p)
    p.fly(4.5)
    assert p.mode == GUIDED
    p.fly(1.0)
    assert p.mode == mode
    assert p.said("GCS Failsafe") == (choice != 0)
    beat(p)
    p.fly(1.0)
    assert p.said("GCS Failsafe Cleared") == (choice != 0)
    assert p.mode == mode, "the mode stays"


@BOTH
@pytest.mark.parametrize("mode", [STABILIZE, LOITER, GUIDED])
def test_transmitter_lost(core: Core, frame: str, mode: int) -> None:
    """Overrides last three seconds; then silence for one second means RTL, which lands."""
    p = Aviator(core, frame).hover()
    p.sticks(0.5)
    p.set_mode(mode)
    p.sticks(1.0)
    p.set_parameter("SIM_RC_FAIL", 1)
    p.let_go()
    start = p.now
    assert p.fly(6.0, lambda: p.mode == RTL)
    assert p.now - start == pytest.approx(4.0, abs=0.2)
    assert p.said("Radio Failsafe")
    p.wait_disarmed(80.0)
    assert np.linalg.norm(p.pos[:2]) < 1.2


@pytest.mark.parametrize(("choice", "mode"), [(0, LOITER), (1, RTL), (3, LAND), (7, BRAKE)])
def test_throttle_below_the_failsafe_pulse(core: Core, choice: int, mode: int) -> None:
    p = Aviator(core, FS_THR_ENABLE=choice).hover(20.0)
    p.sticks(0.5)
    p.set_mode(LOITER)
    p.sticks(1.0, throttle=900)
    assert p.mode == mode
    p.sticks(1.0)
    assert p.said("Radio Failsafe Cleared") == (choice != 0)


def test_mission_goes_on_without_radio_when_told(core: Core) -> None:
    for options, mode in ((0, RTL), (1, AUTO)):
        p = Aviator(core, FS_OPTIONS=options).ready()
        p.start_mission(Item(MavCmd.NAV_TAKEOFF, None, 10.0), Item(MavCmd.NAV_LOITER_UNLIM, (10.0, 0.0), 10.0))
        p.fly(12.0)
        p.set_parameter("SIM_RC_FAIL", 1)
        p.fly(3.0)
        assert p.mode == mode


@pytest.mark.parametrize(
    ("params", "mode"),
    [
        ({"BATT_LOW_VOLT": 12.45, "BATT_FS_LOW_ACT": 2}, RTL),
        ({"BATT_LOW_VOLT": 12.45, "BATT_FS_LOW_ACT": 0}, GUIDED),
        ({"BATT_LOW_VOLT": 0, "BATT_CRT_VOLT": 12.45, "BATT_FS_CRT_ACT": 1}, LAND),
        ({"BATT_LOW_VOLT": 0, "BATT_LOW_MAH": 4950, "BATT_FS_LOW_ACT": 1}, LAND),
    ],
)
def test_battery(core: Core, params: dict, mode: int) -> None:
    p = Aviator(core, **params).hover()
    p.fly(20.0)
    assert p.mode == mode
    assert p.said("Battery 1 is")


def test_voltage_of_the_simulated_battery(core: Core) -> None:
    """Low, then critical, each after its ten seconds; BATTERY_STATUS tells of it; on the ground nobody arms with it."""
    p = Aviator(core, "ardupilot_quad", BATT_LOW_VOLT=11.5, BATT_CRT_VOLT=10.5, BATT_FS_LOW_ACT=2, BATT_FS_CRT_ACT=1)
    p.hover(20.0)
    p.set_parameter("SIM_BATT_VOLTAGE", 11.4)
    p.fly(9.0)
    assert (p.mode, p.ap.battery.voltage) == (GUIDED, pytest.approx(11.4))
    p.fly(2.0)
    assert (
        p.mode == RTL
        and p.said("Battery 1 is low 11.40V used ")
        and p.said("Battery Failsafe")
        and p.ap.modes.failsafe.battery == 1
    )
    p.set_parameter("SIM_BATT_VOLTAGE", 10.4)
    p.fly(11.0)
    assert p.mode == LAND and p.said("Battery 1 is critical 10.40V used ") and p.ap.modes.failsafe.battery == 2
    p.wait_disarmed(60.0)
    p.set_mode(GUIDED)
    assert p.ask(ARM, 1) == 4 and p.said("Battery 1 low voltage failsafe")


def test_a_battery_monitor_that_fails_in_flight(core: Core) -> None:
    p = Aviator(core).hover()
    p.set_parameter("BATT_VOLT_PIN", -1)
    p.fly(4.5)
    assert not p.said("Battery 1 is missing")
    p.fly(1.0)
    assert p.said("Battery 1 is missing, last: 12.") and p.said("Battery Failsafe") and p.mode == GUIDED
    assert p.set_mode(LAND)
    p.wait_disarmed(60.0)
    p.set_mode(GUIDED)
    assert p.ask(ARM, 1) == 4 and p.said("Battery 1 unhealthy")


@pytest.mark.parametrize("enabled", [0, 1])
def test_vibration_spoils_the_height_unless_it_is_compensated(core: Core, enabled: int) -> None:
    """A bias of 2 m/s^2 in both accelerometers: the compensated copter is back at its height, the other not."""
    p = Aviator(core, "ardupilot_quad", FS_VIBE_ENABLE=enabled).hover(20.0)
    p.sticks(0.5)
    p.set_mode(LOITER)
    p.sticks(1.0)
    p.set_parameter("SIM_ACC1_BIAS_Z", 2.0)
    p.set_parameter("SIM_ACC2_BIAS_Z", 2.0)
    p.sticks(4.5)
    assert p.said("Vibration compensation ON") == bool(enabled)
    assert (p.height < 22.5) == bool(enabled), p.height
    assert p.set_mode(LAND)
    p.fly(40.0, lambda: p.height < 2.0)
    assert p.height < 2.0
    p.set_parameter("SIM_ACC1_BIAS_Z", 0.0)
    p.set_parameter("SIM_ACC2_BIAS_Z", 0.0)
    p.fly(25.0)
    assert p.said("Vibration compensation OFF") == bool(enabled)


@BOTH
@pytest.mark.parametrize(("mode", "then"), [(LOITER, LAND), (GUIDED, LAND), (RTL, LAND), (ALT_HOLD, ALT_HOLD)])
def test_gps_lost(core: Core, frame: str, mode: int, then: int) -> None:
    """Modes that need a position become LAND, without one; it lands, and cannot be armed where one is needed."""
    p = Aviator(core, frame).hover(15.0)
    p.sticks(0.5)
    p.set_mode(mode)
    p.sticks(2.0)
    p.set_parameter("SIM_GPS1_ENABLE", 0)
    p.sticks(12.0)
    assert p.mode == then
    assert p.said("EKF variance") and p.said("EKF Failsafe")
    assert bool(p.said("changed to LAND Mode")) == (then != mode)
    assert p.set_mode(LAND)
    p.wait_disarmed(60.0)
    p.let_go()
    p.set_mode(GUIDED)
    assert p.ask(ARM, 1) == 4
    assert p.said("Bad fix") or p.said("Need Position")
    assert p.set_mode(STABILIZE)
    p.sticks(0.5, throttle=1000)
    assert p.ask(ARM, 1) == 0


def test_without_position_such_modes_are_refused_in_the_air(core: Core) -> None:
    p = Aviator(core).hover(15.0)
    p.sticks(0.5)
    p.set_mode(ALT_HOLD)
    p.set_parameter("SIM_GPS1_ENABLE", 0)
    p.sticks(10.0)
    for mode in (LOITER, GUIDED, AUTO, RTL, BRAKE):
        assert not p.set_mode(mode)
    assert p.mode == ALT_HOLD


def test_gps_comes_back(core: Core) -> None:
    p = Aviator(core).hover(15.0)
    p.sticks(0.5)
    p.set_parameter("SIM_GPS1_ENABLE", 0)
    p.sticks(9.0)
    assert p.mode == LAND
    p.set_parameter("SIM_GPS1_ENABLE", 1)
    p.sticks(4.0)
    assert p.said("EKF Failsafe Cleared")
    assert p.set_mode(LOITER)
    p.sticks(4.0)
    assert np.linalg.norm(p.vel[:2]) < 0.3
    assert np.linalg.norm(np.array(p.ap.estimate.pos) - p.pos) < 1.5


@BOTH
@pytest.mark.parametrize("mode", [GUIDED, LOITER, RTL])
def test_crash_disarms(core: Core, frame: str, mode: int) -> None:
    """Two motors of one side stop: it tips over and lies there."""
    p = Aviator(core, frame).hover(5.0)
    p.sticks(0.5)
    p.set_mode(mode)
    p.set_parameter("SIM_ENGINE_FAIL", 9 if frame == "erle_copter" else 1)
    p.wait_disarmed(15.0)
    assert p.said("Crash: Disarming")


@BOTH
def test_a_weak_motor_is_trimmed_out(core: Core, frame: str) -> None:
    p = Aviator(core, frame).hover()
    p.set_parameter("SIM_ENGINE_MUL", 0.8)
    p.set_parameter("SIM_ENGINE_FAIL", 1)
    p.fly(10.0)
    assert np.linalg.norm(p.pos - [0.0, 0.0, -10.0]) < 1.0
    assert np.abs(p.euler[:2]).max() < 2.0
    p.set_mode(LAND)
    p.wait_disarmed(40.0)


def test_termination_stops_the_motors(core: Core) -> None:
    p = Aviator(core).hover()
    assert p.ask(185, 1) == 0
    p.fly(3.0)
    assert not p.armed
    assert p.on_ground
