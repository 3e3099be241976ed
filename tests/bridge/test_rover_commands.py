# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from tests.bridge.fakes import HOME, Bench

ACCEPTED, TEMPORARILY_REJECTED, DENIED, UNSUPPORTED, FAILED = range(5)
GUIDED = 15


@pytest.mark.parametrize("number", [17, 21, 22, 115, 185, 193])
def test_what_only_copters_do_is_unsupported(rover_bench: Bench, number: int) -> None:
    assert rover_bench.command(number, 1) == UNSUPPORTED
    assert rover_bench.autopilot.calls == []


def test_speed(rover_bench: Bench) -> None:
    for kind in (0, 1):
        assert rover_bench.command(178, kind, 3) == ACCEPTED
    for kind in (2, 3, 9, 0.5):
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


def test_heading_and_speed(rover_bench: Bench) -> None:
    assert rover_bench.command(213, 90, 1.5, 0) == ACCEPTED
    assert rover_bench.command(213, -45, -1, 1) == ACCEPTED
    rover_bench.autopilot.ok = False
    assert rover_bench.command(213, 90, 1.5, 0) == FAILED
    ahead, change, _ = rover_bench.autopilot.calls
    assert ahead == ("guided_heading", pytest.approx(math.pi / 2), 1.5)
    assert change == ("guided_heading_change", pytest.approx(-math.pi / 4), -1.0)


def test_motor_test(rover_bench: Bench) -> None:
    assert rover_bench.command(209, 1, 0, 20, 2) == ACCEPTED
    assert rover_bench.command(209, 2, 1, 1700, 5) == ACCEPTED
    asked = list(rover_bench.autopilot.calls)
    assert asked == [("test_motor", 1, 0.2, 0, 2.0), ("test_motor", 2, 0.0, 1700, 5.0)]
    for refused in ((1, 2, 20, 2), (1.5, 0, 20, 2), (1, 1, 1e9, 2)):
        assert rover_bench.command(209, *refused) == FAILED
    assert rover_bench.autopilot.calls == asked


def test_modes(rover_bench: Bench) -> None:
    assert rover_bench.command(176, 1, GUIDED) == ACCEPTED
    assert rover_bench.command(176, 1, 2) == FAILED
    assert rover_bench.command(20) == ACCEPTED and rover_bench.autopilot.mode() == 11


def test_a_camera_is_not_there_to_be_pointed(rover_bench: Bench) -> None:
    assert [rover_bench.command(n, 0, 0, 0, 0, -35, 149, 0) for n in (195, 197, 201)] == [ACCEPTED] * 3
    assert rover_bench.autopilot.calls == []


def test_reposition(rover_bench: Bench) -> None:
    rover_bench.vehicle.locate()

    def go(flags: int, speed: float = -1.0) -> int:
        message = mavlink.MAVLink_command_int_message(
            1, 1, 3, 192, 0, 0, speed, flags, 0, 0, HOME[0] + 1000, HOME[1], 0.0
        )
        (ack,) = rover_bench.ask(message, "COMMAND_ACK")
        return int(ack.result)

    assert go(0) == DENIED
    assert go(1, speed=1.5) == ACCEPTED and rover_bench.autopilot.mode() == GUIDED
    assert [c[0] for c in rover_bench.autopilot.calls] == ["set_mode", "guided_position", "change_speed"]


def test_manual_control_steers_with_y_and_drives_with_z(rover_bench: Bench) -> None:
    rc, p = rover_bench.vehicle.v.autopilot.rc, rover_bench.vehicle.v.autopilot.params
    low, high = int(p.RC3_MIN), int(p.RC3_MAX)
    rover_bench.ask(mavlink.MAVLink_manual_control_message(1, 1000, -1000, 0, 1000, 0))
    assert list(rc.override[:4]) == [int(p.RC1_MIN), 0, (low + high) // 2, 0]
    for z, pulse in ((1000, high), (-1000, low), (500, low + (high - low) * 3 // 4)):
        rover_bench.ask(mavlink.MAVLink_manual_control_message(1, 0, 32767, z, 0, 0))
        assert list(rc.override[:4]) == [int(p.RC1_MIN), 0, pulse, 0]
