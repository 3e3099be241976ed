# SPDX-License-Identifier: BSD-3-Clause
"""Commands: what copters and rovers accept, deny and do not support."""

from __future__ import annotations

import math
from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.autopilot.navigation.state import BY_LANDING, BY_PATH
from sitl.bridge.services.compass_calibration import CompassCalibrationService
from sitl.core.algebra import quat_from_euler, rotate_inverse
from sitl.core.earth_field import field_ned
from sitl.core.vectors import Euler, Vec3
from tests.bridge.fakes import HOME, Bench

ACCEPTED, TEMPORARILY_REJECTED, DENIED, UNSUPPORTED, FAILED = range(5)


def command_int(bench: Bench, number: int, frame: int, x: int, y: int, z: float, *p: float) -> int:
    values = (*p, *(0.0,) * (4 - len(p)))
    message = mavlink.MAVLink_command_int_message(1, 1, frame, number, 0, 0, *values, x, y, z)
    acks = bench.ask(message, "COMMAND_ACK")
    assert len(acks) == 1 and acks[0].command == number
    return int(acks[0].result)


@pytest.mark.parametrize("number", [0, 16, 34, 187, 2003, 31010, 42423, 65535])
def test_what_is_unknown_is_unsupported(bench: Bench, number: int) -> None:
    assert bench.command(number) == UNSUPPORTED
    assert command_int(bench, number, 0, 0, 0, 0.0) == UNSUPPORTED
    assert bench.autopilot.calls == []


def test_targets(bench: Bench) -> None:
    other = mavlink.MAVLink_command_long_message(2, 1, 400, 0, 1, 0, 0, 0, 0, 0, 0)
    assert bench.ask(other) == []
    assert bench.command(400, 1, system=0, component=0) == ACCEPTED
    assert bench.autopilot.calls == [("arm", False)]


def test_the_vehicle_does_not_answer_itself(bench: Bench) -> None:
    bench.client.mav.srcSystem, bench.client.mav.srcComponent = 1, 1
    assert bench.ask(mavlink.MAVLink_command_long_message(1, 1, 400, 0, 1, 0, 0, 0, 0, 0, 0)) == []


def test_arming(bench: Bench) -> None:
    assert bench.command(400, 1) == ACCEPTED
    assert bench.command(400, 1, 2989) == ACCEPTED
    assert bench.command(400, 1, 21196) == ACCEPTED
    assert bench.command(400, 0) == ACCEPTED  # was not armed
    bench.vehicle.v.autopilot.arming.armed = 1
    assert bench.command(400, 1) == ACCEPTED
    bench.autopilot.ok = False
    assert bench.command(400, 0) == FAILED
    assert bench.command(400, 0, 21196) == FAILED
    assert bench.command(400, 2) == UNSUPPORTED
    calls = [("arm", False), ("arm", True), ("arm", True), ("disarm", False), ("disarm", True)]
    assert bench.autopilot.calls == calls


def test_modes(bench: Bench) -> None:
    assert bench.command(176, 1, 4) == ACCEPTED
    assert bench.command(176, 129, 5) == ACCEPTED
    assert bench.command(176, 0, 4) == DENIED
    ask = mavlink.MAVLink_command_long_message(1, 1, 176, 0, 1, 99, 0, 0, 0, 0, 0)
    answers = bench.ask(ask)
    assert [m.text for m in answers if m.get_type() == "STATUSTEXT"] == ["No such mode 99"]
    assert [m.result for m in answers if m.get_type() == "COMMAND_ACK"] == [FAILED]
    assert bench.command(176, 1, 4.5) == ACCEPTED and bench.autopilot.mode() == 4
    assert bench.command(176, 1, -1) == FAILED
    for number, mode in ((17, 5), (20, 6), (21, 9)):
        assert bench.command(number, 0, 0, 0, math.nan) == ACCEPTED
        assert bench.autopilot.mode() == mode
    old = bench.ask(mavlink.MAVLink_set_mode_message(1, 1, 4), "COMMAND_ACK")
    assert [(m.command, m.result) for m in old] == [(11, ACCEPTED)] and bench.autopilot.mode() == 4


def test_takeoff(bench: Bench) -> None:
    assert bench.command(22, 0, 0, 0, 0, 0, 0, 10.0) == ACCEPTED
    assert command_int(bench, 22, 3, 0, 0, 12.0) == ACCEPTED
    assert command_int(bench, 22, 0, 0, 0, 12.0) == DENIED
    assert bench.autopilot.calls == [("takeoff", 10.0), ("takeoff", 12.0)]


def test_reposition(bench: Bench) -> None:
    assert bench.command(192, -1, 1, 0, 0, -35.0, 149.0, 10) == UNSUPPORTED
    place = (HOME[0] + 1000, HOME[1])
    assert command_int(bench, 192, 3, *place, 10.0, -1, 1) == FAILED  # no origin yet
    bench.vehicle.locate()
    assert command_int(bench, 192, 8, *place, 10.0, -1, 1) == DENIED
    assert command_int(bench, 192, 3, *place, 10.0, -1, 0) == DENIED  # may not change the mode
    assert command_int(bench, 192, 3, *place, 10.0, -1, 1, 0, math.nan) == ACCEPTED
    assert command_int(bench, 192, 0, *place, 594.0) == ACCEPTED
    assert command_int(bench, 192, 0, 910_000_000, 0, 594.0) == DENIED
    targets = [c[1] for c in bench.autopilot.calls if c[0] == "guided_position"]
    assert len(targets) == 2
    for target in targets:
        assert target == pytest.approx((11.13, 0.0, -10.0), abs=0.01)


def test_speed_yaw_pause(bench: Bench) -> None:
    assert bench.command(178, 1, 3, -1) == ACCEPTED
    assert bench.command(178, 1, -5, -1) == DENIED
    assert bench.command(178, 4, 3, -1) == DENIED, "the end of SPEED_TYPE"
    assert bench.command(115, 90, 30, -1, 1) == ACCEPTED
    assert bench.command(115, 361, 30, -1, 1) == FAILED
    assert bench.command(193, 0) == ACCEPTED
    assert bench.command(193, 1) == ACCEPTED
    assert bench.command(193, 2) == DENIED
    yaw = pytest.approx(math.pi / 2), pytest.approx(math.pi / 6)
    assert bench.autopilot.calls == [
        ("change_speed", 1, 3.0), ("condition_yaw", *yaw, -1, True), ("pause", True), ("pause", False)
    ]  # fmt: skip


def test_home(bench: Bench) -> None:
    bench.vehicle.locate()
    assert bench.command(179, 1) == ACCEPTED
    assert command_int(bench, 179, 0, 0, 0, 584.0) == ACCEPTED
    assert command_int(bench, 179, 0, HOME[0], HOME[1], 590.0) == ACCEPTED
    assert command_int(bench, 179, 3, HOME[0], HOME[1], 5.0) == ACCEPTED
    assert command_int(bench, 179, 1, HOME[0], HOME[1], 5.0) == DENIED
    assert command_int(bench, 179, 0, 990_000_000, HOME[1], 5.0) == FAILED
    assert command_int(bench, 179, 0, HOME[0], 1_900_000_000, 5.0) == FAILED
    assert bench.command(179, 0, 0, 0, 0, 99, 0, 0) == FAILED
    calls = bench.autopilot.calls
    assert [c[0] for c in calls] == ["set_home_here", "set_home_here", "set_home", "set_home"]
    assert calls[2][1:4] == (*HOME[:2], 590.0) and calls[3][3] == 589.0


def test_system_commands(bench: Bench) -> None:
    assert bench.command(401) == ACCEPTED
    assert bench.command(246, 2) == UNSUPPORTED
    assert bench.command(245, 0) == DENIED
    assert bench.command(241, 1) == ACCEPTED
    assert bench.command(241, 0, 0, 0, 0, 4) == TEMPORARILY_REJECTED  # gyros are being measured
    assert bench.command(241, 0, 1) == UNSUPPORTED
    assert bench.command(241, 0, 76) == bench.command(241, 0, 0, 0, 0, 76) == ACCEPTED
    assert bench.command(185, 0) == FAILED
    assert bench.command(246, 1) == ACCEPTED and bench.vehicle.reboots == 1
    bench.vehicle.v.autopilot.arming.armed = 1
    assert bench.command(246, 1) == FAILED and bench.vehicle.reboots == 1
    assert bench.command(401) == TEMPORARILY_REJECTED
    assert bench.command(241, 1) == FAILED
    assert bench.command(410) == FAILED
    assert bench.command(246, 0) == FAILED, "armed is said first"
    assert bench.command(520, 1) == ACCEPTED
    assert bench.command(520, 0) == FAILED
    assert [bench.command(2600, x) for x in (0, 1, 2)] == [ACCEPTED, ACCEPTED, FAILED]


def test_mission_commands(bench: Bench) -> None:
    assert bench.command(300) == ACCEPTED
    assert bench.command(300, 1, 2) == DENIED
    assert bench.command(224, 1) == DENIED
    assert bench.command(224, 1.5) == DENIED
    bench.autopilot.ok = False
    assert bench.command(224, 0) == FAILED, "there is no mission"


def test_the_interval_of_a_message_may_be_requested_as_a_message(bench: Bench) -> None:
    bench.command(511, 30, 40_000)
    ask = mavlink.MAVLink_command_long_message(1, 1, 512, 0, 244, 30, 0, 0, 0, 0, 0)
    assert bench.ask(ask, "MESSAGE_INTERVAL")[0].interval_us == 40_000
    assert bench.command(512, 244, 9999) == FAILED


def test_the_other_vehicle_is_chosen(bench: Bench) -> None:
    assert [bench.command(32, number) for number in (7, 0, 256)] == [ACCEPTED, DENIED, DENIED]
    assert bench.vehicle.parameters["FOLL_SYSID"] == 7.0


@pytest.mark.parametrize(("number", "params", "result"), [
    (500, (), ACCEPTED), (2520, (0, 1), ACCEPTED), (10001, (), FAILED), (32000, (0,), ACCEPTED), (32000, (1,), FAILED),
    (42700, (32451,), DENIED), (42701, (0,), DENIED), (42701, (2,), ACCEPTED), (42701, (9,), UNSUPPORTED),
    (5300, (1,), ACCEPTED), (5300, (2,), DENIED), (532, (0,), DENIED), (532, (4,), FAILED), (534, (1,), DENIED),
    (2500, (), FAILED), (2501, (), FAILED), (43003, (), UNSUPPORTED),
])  # fmt: skip
def test_parts_that_are_not_there(bench: Bench, number: int, params: tuple[float, ...], result: int) -> None:
    assert bench.command(number, *params) == result


def test_a_place_that_is_too_high_or_not_on_earth(bench: Bench) -> None:
    bench.vehicle.locate()
    place = (HOME[0] + 1000, HOME[1])
    assert command_int(bench, 201, 3, *place, 83_001.0) == DENIED
    assert command_int(bench, 201, 3, 910_000_000, 0, 10.0) == FAILED
    assert command_int(bench, 179, 3, *place, 10.0, 2) == FAILED, "neither here nor there"


def test_a_repeated_command_is_answered_again(bench: Bench) -> None:
    for confirmation in range(3):
        ask = mavlink.MAVLink_command_long_message(1, 1, 512, confirmation, 148, 0, 0, 0, 0, 0, 0)
        assert [m.get_type() for m in bench.ask(ask)] == ["COMMAND_ACK", "AUTOPILOT_VERSION"]
    version = bench.ask(ask, "AUTOPILOT_VERSION")[0]
    assert version.flight_sw_version >> 16 == 0x0407 and version.capabilities & 0x2000


def test_a_version_1_client_is_answered_in_version_1(bench: Bench) -> None:
    old = bench.connect(version=1)
    old.send(mavlink.MAVLink_command_long_message(1, 1, 512, 0, 148, 0, 0, 0, 0, 0, 0))
    bench.bridge.receive()
    raw = old.link.receive()
    assert raw[0] == 0xFE
    assert [m.get_type() for m in mavlink.MAVLink(None).parse_buffer(raw)] == ["COMMAND_ACK", "AUTOPILOT_VERSION"]
    old.version = 2
    old.send(mavlink.MAVLink_command_long_message(1, 1, 512, 0, 148, 0, 0, 0, 0, 0, 0))
    bench.bridge.receive()
    assert old.link.receive()[0] == 0xFD


GUIDED = 15


@pytest.mark.parametrize("number", [17, 21, 22, 115, 185, 193, 213, 2520])
def test_what_only_copters_do_is_unsupported(rover_bench: Bench, number: int) -> None:
    assert rover_bench.command(number, 1) == UNSUPPORTED
    assert rover_bench.autopilot.calls == []


def test_origin(bench: Bench) -> None:
    assert bench.command(611) == UNSUPPORTED, "single precision cannot say where"
    for frame, x, y in ((0, 0, 0), (0, 1, 2_140_000_000), (3, 1, 1), (1, 1, 1)):
        assert command_int(bench, 611, frame, x, y, 0.0) == DENIED
    assert bench.autopilot.calls == []
    assert command_int(bench, 611, 5, -233223320, 1234567800, 23.67) == ACCEPTED
    assert bench.autopilot.calls == [("set_origin", -233223320, 1234567800, pytest.approx(23.67))]
    bench.autopilot.ok = False
    assert command_int(bench, 611, 0, -233223320, 1234567800, 23.67) == FAILED


def test_a_battery_is_reset(rover_bench: Bench) -> None:
    assert rover_bench.command(42651, 65535, 56) == ACCEPTED
    assert [rover_bench.command(42651, mask, 56) for mask in (0, 2, 65536)] == [ACCEPTED] * 3, "no other is there"
    assert [rover_bench.command(42651, 1, left) for left in (101, -1)] == [ACCEPTED] * 2
    assert rover_bench.autopilot.calls == [("set_battery_left", left) for left in (56.0, 100.0, 0.0)]
    rover_bench.autopilot.ok = False
    assert rover_bench.command(42651, 1, 56) == FAILED


def test_the_banner_and_calibrations_of_compasses_that_are_not_there(bench: Bench) -> None:
    (banner,) = bench.ask(mavlink.MAVLink_command_long_message(1, 1, 42428, 0, *[0] * 7), "STATUSTEXT")
    assert banner.text.startswith("ArduCopter V4.7.0")
    assert bench.command(42424, 8) == bench.command(42425, -1) == bench.command(42426, 8) == FAILED
    assert bench.command(42425) == bench.command(42426) == ACCEPTED  # as ArduPilot: none is under way


def test_vertical_take_off_and_landing_are_the_copters_own(bench: Bench) -> None:
    assert bench.command(84, 0, 0, 0, 0, 0, 0, 15) == bench.command(85) == ACCEPTED
    assert bench.autopilot.calls == [("takeoff", 15.0), ("set_mode", 9)]


def test_speed(rover_bench: Bench) -> None:
    for kind in (0, 1):
        assert rover_bench.command(178, kind, 3) == ACCEPTED
    for kind in (2, 3, 4):
        assert rover_bench.command(178, kind, 3) == DENIED
    assert rover_bench.command(178, 1, math.nan) == DENIED
    rover_bench.autopilot.ok = False
    assert rover_bench.command(178, 1, -5) == FAILED
    assert rover_bench.autopilot.calls == [
        ("change_speed", 0, 3.0), ("change_speed", 1, 3.0), ("change_speed", 1, -5.0)
    ]  # fmt: skip


def test_reverse(rover_bench: Bench) -> None:
    assert [rover_bench.command(194, way) for way in (1, 0)] == [ACCEPTED] * 2
    assert rover_bench.autopilot.calls == [("set_reversed", True), ("set_reversed", False)]


def test_motor_test(rover_bench: Bench) -> None:
    assert rover_bench.command(209, 1, 0, 20, 2) == ACCEPTED
    assert rover_bench.command(209, 2, 1, 1700, 5) == ACCEPTED
    asked = list(rover_bench.autopilot.calls)
    assert asked == [("test_motor", 1, 0.2, 0, 2.0), ("test_motor", 2, 0.0, 1700, 5.0)]
    for refused in ((1, 3, 20, 2), (5, 0, 20, 2), (1, 1, 1e9, 2), (1, 0, 101, 2)):
        assert rover_bench.command(209, *refused) == FAILED
    assert rover_bench.autopilot.calls == asked


@pytest.mark.parametrize(
    ("asked", "given"),
    [
        ((1, 0, 100), (1, 1.0, 0)),
        ((1, 0, 100.5), None),
        ((3, 0, -100), (3, -1.0, 0)),
        ((3, 0, -150), (3, -1.0, 0)),
        ((4, 0, 0), (4, 0.0, 0)),
        ((0, 0, 20), (0, 0.2, 0)),
        ((-1, 0, 20), None),
        ((1, 1, 2200), (1, 0.0, 2200)),
        ((1, 1, 2201), None),
        ((1, 2, 0), (1, 1.0, 0)),  # its pilot holds the stick at the end
        ((1, -1, 0), None),
    ],
)
def test_ends_of_a_motor_test_of_a_rover(rover_bench: Bench, asked: Any, given: Any) -> None:
    """Parts of full throttle are up to 100 % either way, pulses up to 2200 us, motors 0 .. 4."""
    assert rover_bench.command(209, *asked, 2.0) == (FAILED if given is None else ACCEPTED)
    told = [call[1:4] for call in rover_bench.autopilot.calls if call[0] == "test_motor"]
    assert told == ([] if given is None else [given])


def test_no_function_of_a_switch_is_one(bench: Bench, rover_bench: Bench) -> None:
    """For rovers alone, as ArduPilot has it."""
    assert rover_bench.command(218, 0, 0) == ACCEPTED and rover_bench.command(218, 0, 3) == DENIED
    bench.autopilot.ok = False
    assert bench.command(218, 0, 0) == FAILED


def test_modes_of_a_rover(rover_bench: Bench) -> None:
    assert rover_bench.command(176, 1, GUIDED) == ACCEPTED
    assert rover_bench.command(176, 1, 2) == FAILED
    assert rover_bench.command(20) == ACCEPTED and rover_bench.autopilot.mode() == 11


def test_a_camera_is_not_there_to_be_pointed(rover_bench: Bench) -> None:
    assert [rover_bench.command(n, 0, 0, 0, 0, -35, 149, 0) for n in (195, 197, 201)] == [ACCEPTED] * 3
    assert rover_bench.autopilot.calls == []


def test_reposition_of_a_rover(rover_bench: Bench) -> None:
    rover_bench.vehicle.locate()

    def go(flags: int, speed: float = -1.0) -> int:
        message = mavlink.MAVLink_command_int_message(
            1, 1, 3, 192, 0, 0, speed, flags, 0, 0, HOME[0] + 1000, HOME[1], 0.0
        )
        (ack,) = rover_bench.ask(message, "COMMAND_ACK")
        return int(ack.result)

    assert go(0) == DENIED
    assert go(1, speed=1.5) == ACCEPTED and rover_bench.autopilot.mode() == GUIDED
    calls = ["set_mode", "change_reposition_speed", "guided_position"]
    assert [c[0] for c in rover_bench.autopilot.calls] == calls


def test_manual_control_steers_with_y_and_drives_with_z(rover_bench: Bench) -> None:
    rc, p = rover_bench.vehicle.v.autopilot.rc, rover_bench.vehicle.v.autopilot.params
    low, high = int(p.RC3_MIN), int(p.RC3_MAX)
    rover_bench.ask(mavlink.MAVLink_manual_control_message(1, 1000, -1000, 0, 1000, 0))
    assert list(rc.override[:4]) == [int(p.RC1_MIN), 0, (low + high) // 2, 0]
    for z, pulse in ((1000, high), (-1000, low), (500, low + (high - low) * 3 // 4)):
        rover_bench.ask(mavlink.MAVLink_manual_control_message(1, 0, 32767, z, 0, 0))
        assert list(rc.override[:4]) == [int(p.RC1_MIN), 0, pulse, 0]


@pytest.mark.parametrize(("least", "most"), [(1000.0, 2000.0), (1100.0, 1900.0), (0.0, 2000.0), (1.0, 1001.0)])
def test_throttles_of_a_motor_test_are_parts_of_the_motors_range(bench: Bench, least: float, most: float) -> None:
    bench.vehicle.parameters.update({"MOT_PWM_MIN": least, "MOT_PWM_MAX": most})
    half = 0.5 * (least + most)
    asked = ((0, 50.0, 0.5), (0, 0.0, 0.0), (0, 100.0, 1.0), (1, half, 0.5), (1, least, 0.0), (1, most, 1.0))
    for kind, given, _ in asked:
        assert bench.command(209, 3, kind, given, 2.0) == ACCEPTED
    told = [call for call in bench.autopilot.calls if call[0] == "test_motor"]
    assert told == [("test_motor", 3, True, throttle, 2.0) for *_, throttle in asked]


@pytest.mark.parametrize(("least", "most"), [(0.0, 0.0), (1500.0, 1500.0), (2000.0, 1000.0)])
def test_a_range_of_no_pulses_has_no_throttle(bench: Bench, least: float, most: float) -> None:
    bench.vehicle.parameters.update({"MOT_PWM_MIN": least, "MOT_PWM_MAX": most})
    for kind in (0, 1):
        assert bench.command(209, 1, kind, 10.0, 2.0) == ACCEPTED
    assert {call[3] for call in bench.autopilot.calls if call[0] == "test_motor"} == {-1.0}


@pytest.mark.parametrize(
    ("seconds", "count", "each"),
    [(2.0, 1, 2.0), (1000.0, 1, 600.0), (-5.0, 1, 0.0), (2.0, 0, 2.0), (2.0, 2, 4.0), (2.0, 999, 4.0)],
)
def test_a_motor_is_tested_for_its_time_and_while_another_follows_longer(
    bench: Bench, seconds: float, count: float, each: float
) -> None:
    """Ten minutes at most; half of the time and a second more before the next one."""
    assert bench.command(209, 1, 0, 50.0, seconds, count) == ACCEPTED
    assert [call[-1] for call in bench.autopilot.calls if call[0] == "test_motor"] == [each]


def test_motors_are_tested_in_turn_after_pauses_of_half_the_time(bench: Bench) -> None:
    def tested(seconds: float) -> list[tuple[Any, ...]]:
        bench.autopilot.calls.clear()
        bench.run(seconds)
        return [call for call in bench.autopilot.calls if call[0] in ("test_motor", "rest_tested_motor")]

    bench.run(3.0)
    assert bench.command(209, 2, 0, 50.0, 2.0, 3, 2.0) == ACCEPTED
    assert tested(1.9975) == [] and tested(0.0025) == [("rest_tested_motor",)]
    assert tested(0.9975) == [] and tested(0.0025) == [("test_motor", 3, False, 0.5, 4.0)]
    assert tested(3.0) == [("rest_tested_motor",), ("test_motor", 4, False, 0.5, 2.0)]
    assert tested(10.0) == [], "the vehicle's own law ends the last one"


@pytest.mark.parametrize(
    ("params", "given"),
    [
        ((0, 0, 0, 0), (0.0, 0.0, 0, False)), ((360, 10, 1, 1), (360.0, 10.0, 1, True)),
        ((90, -5, -0.5, 0), (90.0, 0.0, -1, False)), ((90, 5, 0.5, 1), (90.0, 5.0, 1, True)),
        ((360.5, 0, 0, 0), None), ((-0.5, 0, 0, 0), None), ((90, 0, 0, 0.5), None), ((90, 0, 0, 2), None),
    ],
)  # fmt: skip
def test_headings_that_can_be_turned_to(bench: Bench, params: Any, given: Any) -> None:
    assert bench.command(115, *params) == (FAILED if given is None else ACCEPTED)
    told = [call[1:] for call in bench.autopilot.calls if call[0] == "condition_yaw"]
    assert told == ([] if given is None else [(math.radians(given[0]), math.radians(given[1]), *given[2:])])


@pytest.mark.parametrize(("number", "p1", "result", "call"), [
    (185, 0.5, FAILED, []), (185, 0.51, ACCEPTED, [("terminate",)]), (188, 0, ACCEPTED, [("go_back", BY_PATH)]),
    (189, 0, ACCEPTED, [("go_back", BY_LANDING)]), (193, 0.9, ACCEPTED, [("pause", True)]), (193, -1, DENIED, []),
    (178, 0, DENIED, []), (32000, 0.5, ACCEPTED, []), (32, 0.5, ACCEPTED, []),
])  # fmt: skip
def test_what_only_copters_do(bench: Bench, number: int, p1: float, result: int, call: Any) -> None:
    assert bench.command(number, p1) == result and bench.autopilot.calls == call


@pytest.mark.parametrize(
    ("location", "asked"),
    [
        ((0, 0, 0.0), [None]), ((0, 0, 5.0), "there"), ((1, 0, 0.0), "there"), ((0, 1, 0.0), "there"),
        ((900_000_001, 0, 0.0), []),
    ],
)  # fmt: skip
def test_the_nose_of_a_copter_is_pointed_at_a_location(bench: Bench, location: Any, asked: Any) -> None:
    result = command_int(bench, 195, 0, *location)
    assert result == (FAILED if asked in ("there", []) else ACCEPTED), "without an origin nowhere is known"
    bench.vehicle.locate()
    bench.autopilot.calls.clear()
    command_int(bench, 195, 0, *location)
    found = [call[1] for call in bench.autopilot.calls if call[0] == "set_roi"]
    assert found == ([bench.bridge.locations.ned(*location, 0)] if asked == "there" else asked)


class Heard:
    """A listener of commands."""

    def __init__(self) -> None:
        self.told: list[tuple[Any, ...]] = []

    def commanded(self, fields: Any, *rest: Any) -> None:
        self.told.append((fields.command, *rest))

    def said(self, severity: int, text: str) -> None: ...


def test_listeners_hear_how_commands_were_understood(bench: Bench) -> None:
    """The frame of a COMMAND_LONG, and whether its p5 and p6 are degrees."""
    bench.vehicle.locate()
    heard: Any = Heard()
    bench.bridge.listeners.append(heard)
    for number in (179, 400, 999):
        bench.command(number)
    assert heard.told == [(179, 0, True, (255, 190), ACCEPTED), (400, 3, False, (255, 190), ACCEPTED),
                          (999, 3, False, (255, 190), UNSUPPORTED)]  # fmt: skip


@pytest.mark.parametrize(
    ("params", "asked"),
    [((3, 1, 0, 2.5, 0), (3.0, True, False, 2.5, False)), ((0, 0, 1, 0, 1), (0.0, False, True, 0.0, True))],
)
def test_how_compasses_are_to_be_calibrated(
    bench: Bench, monkeypatch: pytest.MonkeyPatch, params: Any, asked: Any
) -> None:
    """MAV_CMD_DO_START_MAG_CAL: which, again after a failure, saving, a delay, a reboot."""
    given: list[Any] = []
    monkeypatch.setattr(CompassCalibrationService, "start", lambda service, *what: given.append(what) or ACCEPTED)
    assert bench.command(42424, *params) == ACCEPTED and given == [asked]


@pytest.mark.parametrize("here", [True, False])
def test_offsets_of_compasses_by_a_heading(bench: Bench, here: bool) -> None:
    """What is shown more than the earth's field of a place, of a vehicle that leans and heads east."""
    bench.vehicle.locate()
    v = bench.vehicle.v
    lat, lon = (1e-7 * HOME[0], 1e-7 * HOME[1]) if here else (47.0, 8.0)
    v.autopilot.estimate.euler = Euler(0.1, -0.2, 3.0)
    attitude = quat_from_euler(Euler(0.1, -0.2, math.pi / 2))
    field = rotate_inverse(attitude, Vec3(*field_ned(lat, lon)))
    v.sensors.mag2 = field + Vec3(0.01, -0.02, 0.03)
    assert bench.command(42006, 90, 2, *((0, 0) if here else (lat, lon))) == ACCEPTED
    values = bench.vehicle.parameters
    found = [values[f"COMPASS_OFS2_{axis}"] for axis in "XYZ"]
    assert found == pytest.approx([-10.0, 20.0, -30.0], abs=0.01)
    assert [values[f"COMPASS_{g}2_{axis}"] for g in ("DIA", "ODI") for axis in "XYZ"] == [1.0] * 3 + [0.0] * 3
