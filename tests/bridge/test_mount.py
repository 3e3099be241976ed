# SPDX-License-Identifier: BSD-3-Clause
"""The gimbal on servo outputs: answers, flags and pulses are those of a real ArduPilot with the same parameters."""

from __future__ import annotations

import math
from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.autopilot.aux_switch import HIGH, LOW
from sitl.autopilot.mission.item import MissionItem
from sitl.core.algebra import euler_of
from sitl.core.mavlink import MavCmd, MavFrame
from sitl.core.vectors import Euler, Quat, Vec3
from tests.bridge.fakes import HOME, Bench, FakeRover, FakeVehicle

ACCEPTED, FAILED = 0, 4
CONFIGURE, CONTROL, PITCH_YAW, GIVE = 204, MavCmd.DO_MOUNT_CONTROL, MavCmd.DO_GIMBAL_MANAGER_PITCHYAW, 1001
ROI, NO_ROI, REQUEST = MavCmd.DO_SET_ROI_LOCATION, MavCmd.DO_SET_ROI_NONE, 512
RETRACT, NEUTRAL, LEVEL, YAW_LOCK, FROM_NOSE = 1, 2, 12, 16, 32
NAN = math.nan


def bench(vehicle: FakeVehicle | None = None, **params: float) -> Bench:
    """A gimbal with three axes on outputs 9, 10, 11: yaw, pitch, roll."""
    vehicle = vehicle or FakeVehicle()
    vehicle.locate()
    axes = {"SERVO9_FUNCTION": 6.0, "SERVO10_FUNCTION": 7.0, "SERVO11_FUNCTION": 8.0}
    vehicle.parameters.update({"MNT1_TYPE": 1.0} | axes | params)
    return Bench(vehicle)


def pulses(b: Bench, seconds: float = 0.1) -> tuple[int, ...]:
    """Of yaw, pitch and roll, after some time."""
    b.run(seconds)
    now = {call[1]: call[2] for call in b.autopilot.calls if call[0] == "set_servo"}
    return tuple(now.get(n, 0) for n in (9, 10, 11))


def told(b: Bench) -> tuple[Any, Euler]:
    """GIMBAL_DEVICE_ATTITUDE_STATUS: the message, and its angles [deg]."""
    (m,) = b.telemetry("GIMBAL_DEVICE_ATTITUDE_STATUS")
    return m, Euler(*map(math.degrees, euler_of(Quat(*m.q))))


@pytest.mark.parametrize("vehicle", [FakeVehicle, FakeRover])
def test_without_a_gimbal(vehicle: type[FakeVehicle]) -> None:
    b = bench(vehicle(), MNT1_TYPE=0.0)
    for number in (CONFIGURE, CONTROL, PITCH_YAW, GIVE):
        assert b.command(number, 1, 1) == FAILED
    for number in (ROI, NO_ROI, 198, 201):
        assert b.command(number, 0, 0, 0, 0, -35.3, 149.1, 10) == ACCEPTED
    assert b.command(REQUEST, 285) == ACCEPTED  # as in ArduPilot, which sends nothing then
    assert pulses(b, 1.0) == (0, 0, 0)


@pytest.mark.parametrize(
    ("angles", "wanted"),
    [((-30, 0, 45, 0, 0, 0, 2), (1600, 1536, 1500)), ((20, 10, -90, 0, 0, 0, 2), (1300, 1900, 1633))],
)
def test_angles_of_the_old_command(angles: tuple[float, ...], wanted: tuple[int, ...]) -> None:
    b = bench()
    assert b.command(CONTROL, *angles) == ACCEPTED
    assert pulses(b) == wanted
    m, euler = told(b)
    assert m.flags == LEVEL | FROM_NOSE
    assert euler == pytest.approx((angles[1], angles[0], angles[2]), abs=0.01)


@pytest.mark.parametrize(
    ("pitch", "yaw", "wanted"),
    [(-20, 30, (1566, 1609, 1500)), (-95, 300, (1366, 1100, 1500)), (0, 0, (1500, 1754, 1500))],
)
def test_angles_of_the_gimbal_manager(pitch: float, yaw: float, wanted: tuple[int, ...]) -> None:
    b = bench()
    assert b.command(PITCH_YAW, pitch, yaw) == ACCEPTED
    assert pulses(b) == wanted
    assert b.command(PITCH_YAW, pitch, yaw, 0, 0, 0, 0, 2) == FAILED  # another gimbal


def test_yaw_from_north_and_rates() -> None:
    b = bench()
    b.vehicle.v.autopilot.estimate.euler = Euler(0.0, 0.0, math.radians(80.0))
    assert b.command(PITCH_YAW, -20, 30, 0, 0, YAW_LOCK) == ACCEPTED
    assert pulses(b) == (1388, 1609, 1500)
    assert told(b)[0].flags == LEVEL | FROM_NOSE | YAW_LOCK
    assert b.command(PITCH_YAW, NAN, NAN, -5, 10, YAW_LOCK) == ACCEPTED
    b.run(1.0)
    assert told(b)[1][1:] == pytest.approx((-25.0, -40.0), abs=0.3)
    b.run(60.0)
    assert told(b)[1].pitch == pytest.approx(-90.0, abs=0.1)
    assert b.command(PITCH_YAW, NAN, 10, NAN, NAN) == FAILED


@pytest.mark.parametrize("heading", [0.0, 90.0])
def test_it_stays_level(heading: float) -> None:
    b = bench()
    estimate = b.vehicle.v.autopilot.estimate
    estimate.euler = Euler(math.radians(10.0), math.radians(-15.0), math.radians(heading))
    assert b.command(PITCH_YAW, -30, 0) == ACCEPTED
    b.run(0.1)
    assert told(b)[1].pitch == pytest.approx(-15.0, abs=0.5)
    assert told(b)[1].roll == pytest.approx(-10.0, abs=0.5)


def test_folded_neutral_and_back() -> None:
    b = bench(MNT1_RETRACT_Y=-80.0, MNT1_NEUTRAL_Z=36.0)
    assert b.command(CONTROL, 0, 0, 0, 0, 0, 0, 0) == ACCEPTED
    assert (pulses(b), told(b)[0].flags) == ((1500, 1172, 1500), LEVEL | FROM_NOSE | RETRACT)
    assert b.command(PITCH_YAW, 0, 0, 0, 0, NEUTRAL) == ACCEPTED
    assert (pulses(b), told(b)[0].flags) == ((1580, 1754, 1500), LEVEL | FROM_NOSE | NEUTRAL)
    assert b.command(CONFIGURE, 2) == ACCEPTED
    assert b.command(CONFIGURE, 5) == FAILED
    assert b.command(CONTROL, 0, 0, 0, 0, 0, 0, 7) == FAILED
    b.bridge.switched(27, HIGH)
    assert pulses(b)[1] == 1172
    b.bridge.switched(27, LOW)
    assert pulses(b) == (1500, 1500, 1500)  # sticks, which there are none


def test_sticks_turn_it() -> None:
    b = bench(RC6_OPTION=213.0, RC8_OPTION=214.0, RC6_MIN=1000.0, RC6_MAX=2000.0)
    rc = b.vehicle.v.autopilot.rc
    for stick, wanted in ((1000, 1100), (1500, 1500), (2000, 1900), (1750, 1700)):
        rc.channels[5] = stick
        assert pulses(b)[1] == pytest.approx(wanted, abs=1)
    b.vehicle.parameters["MNT1_RC_RATE"] = 20.0
    rc.channels[5], rc.channels[7] = 1000, 1500
    before = told(b)[1].pitch
    b.run(1.0)
    assert told(b)[1].pitch - before == pytest.approx(-20.0, abs=0.5)
    assert told(b)[0].flags == LEVEL | FROM_NOSE
    b.bridge.switched(163, HIGH)
    assert told(b)[0].flags == LEVEL | FROM_NOSE | YAW_LOCK


def test_a_region_of_interest() -> None:
    """To the north, 20 m away and 20 m below."""
    b = bench()
    estimate = b.vehicle.v.autopilot.estimate
    estimate.pos, estimate.euler = Vec3(0.0, 0.0, -30.0), Euler(0.0, 0.0, math.radians(45.0))
    there = MissionItem(ROI, MavFrame.GLOBAL_RELATIVE_ALT_INT, x=HOME[0] + 1797, y=HOME[1], z=10.0)
    b.bridge.carry_out(there)
    b.run(0.1)
    assert told(b)[1] == pytest.approx((0.0, -45.0, -45.0), abs=0.2)
    assert ("set_roi", None) in b.autopilot.calls  # the nose does not turn
    b.bridge.carry_out(MissionItem(NO_ROI))
    assert pulses(b) == (1500, 1500, 1500)
    b.autopilot.calls.clear()
    assert b.command(ROI, 0, 0, 0, 0, there.x * 1e-7, there.y * 1e-7, 10.0) == ACCEPTED
    b.run(0.1)
    assert told(b)[1] == pytest.approx((0.0, -45.0, -45.0), abs=0.5)
    assert not [call for call in b.autopilot.calls if call[0] == "set_roi"]
    assert b.command(NO_ROI) == ACCEPTED
    assert pulses(b) == (1500, 1500, 1500)


def test_a_gimbal_without_yaw_leaves_turning_to_the_nose() -> None:
    b = bench(SERVO9_FUNCTION=0.0)
    assert b.command(ROI, 0, 0, 0, 0, -35.3, 149.1, 10) == ACCEPTED
    assert [call[0] for call in b.autopilot.calls if call[0] == "set_roi"] == ["set_roi"]


def test_who_has_control() -> None:
    b = bench()
    (m,) = b.telemetry("GIMBAL_MANAGER_INFORMATION")
    assert (m.cap_flags, m.gimbal_device_id, m.pitch_max) == (206847, 1, pytest.approx(math.radians(20.0)))
    (m,) = b.telemetry("GIMBAL_MANAGER_STATUS")
    assert (m.primary_control_sysid, m.primary_control_compid) == (0, 0), "nobody yet"
    for system, component, result in ((256, 0, FAILED), (-1, 0, FAILED), (0, 256, FAILED), (255, 0, ACCEPTED)):
        assert b.command(GIVE, system, component) == result
    (m,) = b.ask(mavlink.MAVLink_command_long_message(1, 1, GIVE, 0, 7, 8, 0, 0, 0, 0, 0), "GIMBAL_MANAGER_STATUS")
    assert (m.primary_control_sysid, m.primary_control_compid) == (7, 8), "told at once"
    assert b.command(GIVE, -2, -2) == ACCEPTED
    (m,) = b.telemetry("GIMBAL_MANAGER_STATUS")
    assert (m.primary_control_sysid, m.primary_control_compid, m.flags) == (255, 190, LEVEL)


def test_missions_turn_it() -> None:
    b = bench()
    b.bridge.carry_out(MissionItem(CONTROL, p1=-30.0, p3=45.0))
    assert pulses(b)[:2] == (1600, 1536)
    b.bridge.carry_out(MissionItem(PITCH_YAW, p1=-20.0, p2=30.0))
    assert pulses(b)[:2] == (1566, 1609)


@pytest.mark.parametrize("mode", [2, 3, 4, 6])
def test_a_gimbal_that_nobody_has_told_anything_looks_straight_ahead(mode: int) -> None:
    """MNT1_DEFLT_MODE: angles of MAVLink, sticks, a location, home; none of them is there."""
    vehicle = FakeVehicle()
    b = bench(vehicle, MNT1_DEFLT_MODE=float(mode))
    b.run(0.1)
    m, euler = told(b)
    if mode == 2:
        assert euler == pytest.approx((0.0, 0.0, 0.0), abs=1e-6) and m.flags == LEVEL | FROM_NOSE
    assert all(map(math.isfinite, euler))


def test_what_it_tells_has_the_time_since_boot() -> None:
    b = bench()
    b.run(12.5)
    b.client.receive()
    for name in ("DEVICE_ATTITUDE_STATUS", "MANAGER_INFORMATION", "MANAGER_STATUS"):
        (m,) = b.telemetry(f"GIMBAL_{name}")
        assert (m.time_boot_ms, m.gimbal_device_id) == (12_500, 1)


def test_it_is_turned_fifty_times_a_second() -> None:
    b = bench()
    b.run(0.1)
    b.autopilot.calls.clear()
    b.run(1.0)
    assert sum(call[:2] == ("set_servo", 9) for call in b.autopilot.calls) == 50


@pytest.mark.parametrize(
    ("item", "rpy"),
    [
        (MissionItem(ROI, MavFrame.GLOBAL_RELATIVE_ALT, x=HOME[0] + 1797, y=HOME[1], z=0.0), (0.0, -56.3, 0.0)),
        (MissionItem(ROI, MavFrame.GLOBAL_RELATIVE_ALT), (0.0, -35.0, 0.0)),
    ],
)
def test_a_region_at_height_zero_is_one_and_one_without_a_location_is_none(item: MissionItem, rpy: Any) -> None:
    """Ahead is the middle of each axis, where the sticks would be."""
    b = bench()
    b.vehicle.v.autopilot.estimate.pos = Vec3(0.0, 0.0, -30.0)
    b.bridge.carry_out(item)
    b.run(0.1)
    assert told(b)[1] == pytest.approx(rpy, abs=0.1)


def test_the_nose_is_freed_for_regions_of_interest_alone_and_by_a_gimbal_that_turns() -> None:
    for yaw, item, freed in ((6.0, MissionItem(NO_ROI), [None]), (6.0, MissionItem(CONTROL, p1=-30.0), []),
                             (0.0, MissionItem(NO_ROI), [])):  # fmt: skip
        b = bench(SERVO9_FUNCTION=yaw)
        b.bridge.carry_out(item)
        assert [call[1] for call in b.autopilot.calls if call[0] == "set_roi"] == freed


def test_home_is_looked_at_from_wherever_it_is() -> None:
    b = bench()
    estimate, home = b.vehicle.v.autopilot.estimate, b.vehicle.v.autopilot.home
    home.pos, estimate.pos = Vec3(10.0, 20.0, -2.0), Vec3(10.0, 50.0, -32.0)
    estimate.euler = Euler(0.0, 0.0, math.radians(-60.0))
    assert b.command(CONTROL, 0, 0, 0, 0, 0, 0, 6) == ACCEPTED
    b.run(0.1)
    m, euler = told(b)
    assert euler == pytest.approx((0.0, -45.0, -30.0), abs=0.1) and m.flags == LEVEL | FROM_NOSE | YAW_LOCK


@pytest.mark.parametrize("numbers", [(NAN, 0.0, 0.0), (0.0, NAN, 0.0), (0.0, 0.0, math.inf)])
def test_angles_of_a_mission_that_are_none_leave_it_as_it_is(numbers: Any) -> None:
    b = bench()
    assert b.command(CONTROL, -30, 0, 45, 0, 0, 0, 2) == ACCEPTED
    b.bridge.carry_out(MissionItem(CONTROL, p1=numbers[0], p2=numbers[1], p3=numbers[2]))
    assert pulses(b)[:2] == (1600, 1536)


@pytest.mark.parametrize(
    ("values", "result"),
    [
        ((NAN, NAN, NAN, 5.0), FAILED), ((NAN, NAN, 5.0, NAN), FAILED), ((10.0, NAN, 5.0, NAN), FAILED),
        ((0, 0, 0, 0, -1), FAILED), ((0, 0, 0, 0, 2.0**31), FAILED), ((0, 0, 0, 0, 0, 0, 1), ACCEPTED),
    ],
)  # fmt: skip
def test_what_the_gimbal_manager_takes(values: Any, result: int) -> None:
    assert bench().command(PITCH_YAW, *values) == result


def test_rates_from_the_nose_and_angles_of_the_old_command_are_no_lock() -> None:
    b = bench()
    b.vehicle.v.autopilot.estimate.euler = Euler(0.0, 0.0, math.radians(80.0))
    assert b.command(PITCH_YAW, -20, 30, 0, 0, YAW_LOCK) == ACCEPTED
    b.run(0.1)
    assert b.command(PITCH_YAW, NAN, NAN, 0, -10) == ACCEPTED
    b.run(1.0)
    assert told(b)[1].yaw == pytest.approx(-60.0, abs=0.3), "it goes on from where it was"
    assert told(b)[0].flags == LEVEL | FROM_NOSE
    assert b.command(PITCH_YAW, -20, 30, 0, 0, YAW_LOCK) == ACCEPTED
    assert b.command(CONTROL, -20, 0, 30, 0, 0, 0, 2) == ACCEPTED
    b.run(0.1)
    assert told(b)[1].yaw == pytest.approx(30.0, abs=0.01) and told(b)[0].flags == LEVEL | FROM_NOSE


def test_an_axis_without_an_output_stays_and_one_without_a_range_is_in_its_middle() -> None:
    b = bench(SERVO11_FUNCTION=0.0, SERVO9_FUNCTION=0.0, MNT1_PITCH_MIN=-10.0, MNT1_PITCH_MAX=-10.0)
    b.vehicle.v.autopilot.estimate.euler = Euler(0.0, 0.0, 1.0)
    assert b.command(CONTROL, -30, 20, 45, 0, 0, 0, 2) == ACCEPTED
    assert pulses(b) == (0, 1500, 0)
    assert told(b)[1] == pytest.approx((0.0, -10.0, 0.0), abs=1e-4)


@pytest.mark.parametrize(("lean", "pitch"), [(0.0, -30.0), (10.0, -30.0), (10.0, -15.0)])
def test_without_a_yaw_axis_it_stays_level_along_the_nose(lean: float, pitch: float) -> None:
    b = bench(SERVO9_FUNCTION=0.0)
    b.vehicle.v.autopilot.estimate.euler = Euler(0.0, math.radians(lean), 0.0)
    assert b.command(PITCH_YAW, pitch, 60.0) == ACCEPTED
    b.run(0.1)
    assert told(b)[1] == pytest.approx((0.0, pitch - lean, 0.0), abs=0.01)


@pytest.mark.parametrize(("pitch", "is_steep"), [(-84.0, False), (-85.5, True), (-88.0, True)])
def test_straight_down_it_does_not_roll(pitch: float, is_steep: bool) -> None:
    """From 85 degrees on, where roll and yaw turn it about the same axis."""
    b = bench()
    b.vehicle.v.autopilot.estimate.euler = Euler(math.radians(2.0), 0.0, 0.0)
    assert b.command(PITCH_YAW, pitch, 0.0) == ACCEPTED
    b.run(0.1)
    euler = told(b)[1]
    assert (abs(euler.pitch) > 85.0) == is_steep and (abs(euler.roll) < 0.01) == is_steep


@pytest.mark.parametrize(
    ("pulse", "turned", "share"),
    [(0, 0, 0.0), (1000, 0, -1.0), (900, 0, -1.0), (1400, 0, 0.0), (1200, 0, -0.5), (1700, 0, 0.5), (2100, 0, 1.0),
     (1700, 1, -0.5)],
)  # fmt: skip
@pytest.mark.parametrize(("option", "axis", "output"), [(212.0, "ROLL", 2), (213.0, "PITCH", 1), (214.0, "YAW", 0)])
@pytest.mark.parametrize("channel", [1, 16])
def test_a_stick_may_be_on_any_channel(
    pulse: int, turned: int, share: float, option: float, axis: str, output: int, channel: int
) -> None:
    """RCn_OPTION 212 roll, 213 pitch, 214 yaw; its middle is RCn_TRIM."""
    ends = {"MIN": 1000.0, "TRIM": 1400.0, "MAX": 2000.0, "REVERSED": float(turned), "OPTION": option}
    limits = {f"MNT1_{axis}_MIN": -40.0, f"MNT1_{axis}_MAX": 40.0}
    b = bench(**limits, **{f"RC{channel}_{name}": value for name, value in ends.items()})
    b.vehicle.v.autopilot.rc.channels[channel - 1] = pulse
    assert pulses(b)[output] == 1500 + round(400 * share)


def test_a_stick_without_travel_is_in_its_middle_and_a_switch_ends_the_lock_of_the_sticks() -> None:
    b = bench(RC6_OPTION=213.0, RC6_MIN=1000.0, RC6_TRIM=2000.0, RC6_MAX=2000.0)
    b.vehicle.v.autopilot.rc.channels[5] = 2100
    assert pulses(b)[1] == 1500
    for position, flags in ((HIGH, YAW_LOCK), (LOW, 0)):
        b.bridge.switched(163, position)
        assert told(b)[0].flags == LEVEL | FROM_NOSE | flags


def test_rates_of_the_sticks_turn_each_axis_to_its_end() -> None:
    b = bench(RC6_OPTION=212.0, RC7_OPTION=214.0, MNT1_RC_RATE=20.0, MNT1_ROLL_MIN=-15.0, MNT1_YAW_MAX=120.0)
    channels = b.vehicle.v.autopilot.rc.channels
    channels[5], channels[6] = int(b.vehicle.parameters["RC6_MIN"]), int(b.vehicle.parameters["RC7_MAX"])
    b.run(0.5)
    assert (told(b)[1].roll, told(b)[1].yaw) == pytest.approx((-10.0, 10.0), abs=0.5)
    b.run(10.0)
    assert (told(b)[1].roll, told(b)[1].yaw) == pytest.approx((-15.0, 120.0), abs=0.01)
