# SPDX-License-Identifier: BSD-3-Clause
"""What ArduCopter's and ArduRover's rules make of set-points."""

from __future__ import annotations

import math
from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from tests.bridge.fakes import HOME, Bench

POSITION, VELOCITY, ACCELERATION, POS_VEL = 0xDF8, 0xDC7, 0xC3F, 0xDC0


@pytest.fixture
def guided(bench: Bench) -> Bench:
    bench.vehicle.locate()
    bench.vehicle.v.autopilot.modes.number = 4
    estimate = bench.vehicle.v.autopilot.estimate
    estimate.euler, estimate.pos = (0.0, 0.0, math.pi / 2), (100.0, 200.0, -10.0)
    return bench


def local(
    mask: int, frame: int = 1, p: Any = (1, 2, -3), v: Any = (4, 5, 6), a: Any = (7, 8, 9), yaw: Any = (0.5, 0.25)
) -> Any:
    return mavlink.MAVLink_set_position_target_local_ned_message(0, 1, 1, frame, mask, *p, *v, *a, *yaw)


def call(bench: Bench, message: Any) -> tuple[Any, ...]:
    """What the autopilot was asked to do by one set-point."""
    bench.autopilot.calls.clear()
    assert bench.ask(message) == []
    assert len(bench.autopilot.calls) <= 1
    return tuple(bench.autopilot.calls[0]) if bench.autopilot.calls else ()


def test_kinds(guided: Bench) -> None:
    no_yaw = (False, 0.0, False, 0.0, False)
    assert call(guided, local(POSITION)) == ("guided_position", (1, 2, -3), no_yaw)
    assert call(guided, local(VELOCITY)) == ("guided_velocity", (4, 5, 6), (0, 0, 0), no_yaw)
    assert call(guided, local(0xC07)) == ("guided_velocity", (4, 5, 6), (7, 8, 9), no_yaw)
    assert call(guided, local(POS_VEL)) == ("guided_position_velocity", (1, 2, -3), (4, 5, 6), (0, 0, 0), no_yaw)
    assert call(guided, local(0xC00)) == ("guided_position_velocity", (1, 2, -3), (4, 5, 6), (7, 8, 9), no_yaw)
    assert call(guided, local(ACCELERATION)) == ("guided_acceleration", (7, 8, 9), no_yaw)


def test_mavsdk_masks(guided: Bench) -> None:
    assert call(guided, local(2503)) == ("guided_velocity", (4, 5, 6), (0, 0, 0), (True, 0.5, False, 0.25, False))
    assert call(guided, local(2552))[0] == "guided_position"
    name, velocity, _, yaw = call(guided, local(1479, frame=8))
    assert name == "guided_velocity" and velocity == pytest.approx((-5.0, 4.0, 6.0))
    assert yaw == (False, 0.5, True, 0.25, True)


@pytest.mark.parametrize(("frame", "place"), [
    (1, (1, 2, -3)), (7, (101, 202, -13)), (8, (98, 201, -13)), (9, (98, 201, -13))
])  # fmt: skip
def test_local_frames(guided: Bench, frame: int, place: tuple[float, ...]) -> None:
    assert call(guided, local(POSITION, frame))[1] == pytest.approx(place)


@pytest.mark.parametrize("message", [
    local(POSITION, frame=0), local(POSITION, frame=12), local(0xFFF), local(0xC38),
    local(VELOCITY, v=(math.nan, 0, 0)), local(POSITION, p=(0, math.inf, 0)), local(2503, yaw=(math.nan, 0)),
])  # fmt: skip
def test_what_cannot_be_flown_stops(guided: Bench, message: Any) -> None:
    assert call(guided, message) == ("guided_stop",)


def test_numbers_that_are_ignored_may_be_anything(guided: Bench) -> None:
    bad = (math.nan,) * 3
    assert call(guided, local(POSITION, v=bad, a=bad, yaw=bad[:2]))[0] == "guided_position"


def test_a_force_is_not_flown(guided: Bench) -> None:
    assert call(guided, local(ACCELERATION | 0x200)) == ()


@pytest.mark.parametrize("mode", [0, 3, 5, 6, 9])
def test_other_modes_ignore_set_points(guided: Bench, mode: int) -> None:
    guided.vehicle.v.autopilot.modes.number = mode
    assert call(guided, local(POSITION)) == ()
    assert call(guided, mavlink.MAVLink_set_attitude_target_message(0, 1, 1, 0, [1, 0, 0, 0], 0, 0, 0, 0.5)) == ()


@pytest.mark.parametrize(("frame", "z"), [(0, 594.0), (5, 594.0), (3, 10.0), (6, 10.0), (10, 10.0), (11, 10.0)])
def test_global_frames(guided: Bench, frame: int, z: float) -> None:
    message = mavlink.MAVLink_set_position_target_global_int_message(
        0, 1, 1, frame, POSITION, HOME[0] + 1000, HOME[1], z, 0, 0, 0, 0, 0, 0, 0, 0
    )
    name, place, _ = call(guided, message)
    assert name == "guided_position" and place == pytest.approx((11.132, 0.0, -10.0), abs=0.01)


def test_global_places_that_do_not_exist(guided: Bench) -> None:
    def at(frame: int, lat: int, alt: float) -> Any:
        return mavlink.MAVLink_set_position_target_global_int_message(
            0, 1, 1, frame, POSITION, lat, HOME[1], alt, 0, 0, 0, 0, 0, 0, 0, 0
        )

    assert call(guided, at(1, HOME[0], 10.0)) == ("guided_stop",)
    assert call(guided, at(6, HOME[0], math.nan)) == ("guided_stop",)
    assert call(guided, at(6, 2_000_000_000, 10.0)) == ()


def test_attitude(guided: Bench) -> None:
    def target(mask: int, q: Any = (2, 0, 0, 0), thrust: float = 0.5) -> Any:
        return mavlink.MAVLink_set_attitude_target_message(0, 1, 1, mask, list(q), 0.1, 0.2, 0.3, thrust)

    name, q, rates, thrust = call(guided, target(7))
    assert (name, q, rates, thrust) == ("guided_attitude", (1, 0, 0, 0), (0, 0, 0), 0.5)
    name, q, rates, _ = call(guided, target(128))
    assert q is None and rates == pytest.approx((0.1, 0.2, 0.3))
    assert call(guided, target(7 | 64)) == ()
    for bad in (target(0, (0, 0, 0, 0)), target(0, (math.nan, 0, 0, 0)), target(7, thrust=math.inf)):
        assert call(guided, bad) == ()


YAW, YAW_RATE = 0x9FF, 0x5FF
VELOCITY_AND_YAW, VELOCITY_AND_RATE, ALL_BUT_POSITION = 0x9C7, 0x5C7, 0x1C7
WITH_ACCELERATION = 0xC07
GUIDED, WP_SPEED = 15, 2.0


@pytest.fixture
def guided_rover(rover_bench: Bench) -> Bench:
    """In GUIDED, 100 m north and 200 m east of the origin, facing east."""
    rover_bench.vehicle.locate()
    rover_bench.vehicle.v.autopilot.modes.number = GUIDED
    rover_bench.vehicle.v.autopilot.params.WP_SPEED = WP_SPEED
    estimate = rover_bench.vehicle.v.autopilot.estimate
    estimate.euler, estimate.pos = (0.0, 0.0, math.pi / 2), (100.0, 200.0, 0.0)
    return rover_bench


def rover_local(mask: int, frame: int = 1, x: float = 1.0, y: float = 0.0, yaw: float = 0.5, rate: float = 0.25) -> Any:
    """Position (1, 2) and velocity (x, y)."""
    numbers = (1.0, 2.0, 0.0, x, y, 0.0, 7.0, 8.0, 9.0, yaw, rate)
    return mavlink.MAVLink_set_position_target_local_ned_message(0, 1, 1, frame, mask, *numbers)


def attitude(mask: int, thrust: float, yaw: float = 0.0, rate: float = 0.0) -> Any:
    q = [math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2)] if math.isfinite(yaw) else [yaw] * 4
    return mavlink.MAVLink_set_attitude_target_message(0, 1, 1, mask, q, 0.0, 0.0, rate, thrust)


@pytest.mark.parametrize(("mask", "asked"), [
    (POSITION, ("guided_position", (1.0, 2.0, 0.0), None)),
    (0x1C0, ("guided_position", (1.0, 2.0, 0.0), None)),  # a position comes before all else
    (VELOCITY, ("guided_heading", 0.0, 1.0)),
    (VELOCITY_AND_YAW, ("guided_heading", 0.5, 1.0)),
    (VELOCITY_AND_RATE, ("guided_turn_rate", 0.25, 1.0)),
    (YAW, ("guided_heading", 0.5, 0.0)),
    (YAW_RATE, ("guided_turn_rate", 0.25, 0.0)),
    (ALL_BUT_POSITION, ()),
    (0xDFF, ()),
])  # fmt: skip
def test_kinds_of_a_rover(guided_rover: Bench, mask: int, asked: tuple[Any, ...]) -> None:
    assert call(guided_rover, rover_local(mask)) == asked


def test_a_velocity_is_a_heading_and_a_speed_up_to_the_limit(guided_rover: Bench) -> None:
    name, heading, speed = call(guided_rover, rover_local(VELOCITY, x=-1.0, y=1.0))
    assert name == "guided_heading"
    assert heading == pytest.approx(math.radians(135)) and speed == pytest.approx(math.sqrt(2.0))
    assert call(guided_rover, rover_local(VELOCITY, x=0.0, y=-30.0)) == ("guided_heading", -math.pi / 2, WP_SPEED)


@pytest.mark.parametrize(("mask", "asked"), [
    (VELOCITY_AND_YAW, ("guided_heading", 0.5, -1.0)), (VELOCITY_AND_RATE, ("guided_turn_rate", 0.25, -1.0))
])  # fmt: skip
def test_backward_beside_a_yaw(guided_rover: Bench, mask: int, asked: tuple[Any, ...]) -> None:
    assert call(guided_rover, rover_local(mask, x=-1.0)) == asked


@pytest.mark.parametrize(("frame", "place"), [(1, (1, 2)), (7, (101, 202)), (8, (98, 201)), (9, (98, 201))])
def test_frames_of_positions(guided_rover: Bench, frame: int, place: tuple[float, float]) -> None:
    _, target, _ = call(guided_rover, rover_local(POSITION, frame))
    assert target[:2] == pytest.approx(place)


def test_body_frames_turn_velocities_and_yaws(guided_rover: Bench) -> None:
    _, heading, speed = call(guided_rover, rover_local(VELOCITY, 8))
    assert heading == pytest.approx(math.pi / 2) and speed == pytest.approx(1.0)
    _, heading, _ = call(guided_rover, rover_local(VELOCITY_AND_YAW, 9))
    assert heading == pytest.approx(math.pi / 2 + 0.5)


def test_what_is_ignored(guided_rover: Bench) -> None:
    assert call(guided_rover, rover_local(POSITION, frame=2)) == ()
    guided_rover.vehicle.v.autopilot.estimate.origin_set = 0
    assert call(guided_rover, rover_local(VELOCITY)) == ()
    guided_rover.vehicle.v.autopilot.estimate.origin_set = 1
    guided_rover.vehicle.v.autopilot.modes.number = 4
    assert call(guided_rover, rover_local(VELOCITY)) == call(guided_rover, attitude(7, 0.5)) == ()


def test_an_acceleration_is_refused_with_a_text(guided_rover: Bench) -> None:
    said = guided_rover.ask(rover_local(WITH_ACCELERATION), "STATUSTEXT")
    assert "".join(m.text for m in said) == "Ignoring SET_POSITION_TARGET_LOCAL_NED; set ACC_IGNORE in mask"
    assert guided_rover.autopilot.calls == []


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_a_number_that_is_none_stops_the_vehicle(guided_rover: Bench, bad: float) -> None:
    assert call(guided_rover, rover_local(VELOCITY, x=bad)) == ("guided_stop",)
    assert call(guided_rover, rover_local(VELOCITY_AND_YAW, yaw=bad)) == ("guided_stop",)
    assert call(guided_rover, rover_local(YAW_RATE, rate=bad)) == ("guided_stop",)
    assert call(guided_rover, rover_local(POSITION, x=bad, yaw=bad, rate=bad))[0] == "guided_position", (
        "those are not asked for"
    )
    assert call(guided_rover, attitude(3, bad)) == call(guided_rover, attitude(7, 1.0, yaw=bad)) == ()


@pytest.mark.parametrize("frame", [0, 3, 5, 6, 10, 11])
def test_places_on_the_globe(guided_rover: Bench, frame: int) -> None:
    def place(lat: int, frame: int, alt: float = math.nan) -> Any:
        return mavlink.MAVLink_set_position_target_global_int_message(
            0, 1, 1, frame, POSITION, lat, HOME[1], alt, *(0.0,) * 8
        )

    name, (n, e, _), _ = call(guided_rover, place(HOME[0] + 1000, frame))
    assert name == "guided_position" and (n, e) == pytest.approx((11.13, 0.0), abs=0.01)
    assert call(guided_rover, place(910_000_000, frame)) == ()
    assert call(guided_rover, place(HOME[0], 1)) == ()


def test_attitude_is_heading_or_turn_rate_and_a_share_of_the_speed(guided_rover: Bench) -> None:
    name, heading, speed = call(guided_rover, attitude(7, 0.5, yaw=1.0))
    assert (name, heading, speed) == ("guided_heading", pytest.approx(1.0), pytest.approx(1.0))
    assert call(guided_rover, attitude(3, -3.0, rate=0.5)) == ("guided_turn_rate", 0.5, -WP_SPEED)
    assert call(guided_rover, attitude(0x47, 0.5)) == ()


def test_mission_items_as_targets(guided_rover: Bench) -> None:
    def item(current: int) -> int:
        message = mavlink.MAVLink_mission_item_int_message(
            1, 1, 0, 3, 16, current, 1, 0, 0, 0, 0, HOME[0] + 1000, HOME[1], 0.0
        )
        (ack,) = guided_rover.ask(message, "MISSION_ACK")
        return int(ack.type)

    assert item(2) == 0 and guided_rover.autopilot.calls[-1][0] == "guided_position"
    guided_rover.autopilot.calls.clear()
    assert item(3) == 0 and guided_rover.autopilot.calls == [], "a rover has one height"
