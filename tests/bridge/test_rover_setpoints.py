# SPDX-License-Identifier: BSD-3-Clause
"""What ArduRover's rules make of set-points."""

from __future__ import annotations

import math
from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from tests.bridge.fakes import HOME, Bench

POSITION, VELOCITY, YAW, YAW_RATE = 0xDF8, 0xDC7, 0x9FF, 0x5FF
VELOCITY_AND_YAW, VELOCITY_AND_RATE, ALL_BUT_POSITION = 0x9C7, 0x5C7, 0x1C7
WITH_ACCELERATION = 0xC07
GUIDED, WP_SPEED = 15, 2.0


@pytest.fixture
def guided(rover_bench: Bench) -> Bench:
    """In GUIDED, 100 m north and 200 m east of the origin, facing east."""
    rover_bench.vehicle.locate()
    rover_bench.vehicle.v.autopilot.modes.number = GUIDED
    rover_bench.vehicle.v.autopilot.params.WP_SPEED = WP_SPEED
    estimate = rover_bench.vehicle.v.autopilot.estimate
    estimate.euler, estimate.pos = (0.0, 0.0, math.pi / 2), (100.0, 200.0, 0.0)
    return rover_bench


def local(mask: int, frame: int = 1, x: float = 1.0, y: float = 0.0, yaw: float = 0.5, rate: float = 0.25) -> Any:
    """Position (1, 2) and velocity (x, y)."""
    numbers = (1.0, 2.0, 0.0, x, y, 0.0, 7.0, 8.0, 9.0, yaw, rate)
    return mavlink.MAVLink_set_position_target_local_ned_message(0, 1, 1, frame, mask, *numbers)


def attitude(mask: int, thrust: float, yaw: float = 0.0, rate: float = 0.0) -> Any:
    q = [math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2)] if math.isfinite(yaw) else [yaw] * 4
    return mavlink.MAVLink_set_attitude_target_message(0, 1, 1, mask, q, 0.0, 0.0, rate, thrust)


def call(bench: Bench, message: Any) -> tuple[Any, ...]:
    """What the autopilot was asked to do by one set-point."""
    bench.autopilot.calls.clear()
    assert bench.ask(message) == []
    assert len(bench.autopilot.calls) <= 1
    return tuple(bench.autopilot.calls[0]) if bench.autopilot.calls else ()


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
def test_kinds(guided: Bench, mask: int, asked: tuple[Any, ...]) -> None:
    assert call(guided, local(mask)) == asked


def test_a_velocity_is_a_heading_and_a_speed_up_to_the_limit(guided: Bench) -> None:
    name, heading, speed = call(guided, local(VELOCITY, x=-1.0, y=1.0))
    assert name == "guided_heading"
    assert heading == pytest.approx(math.radians(135)) and speed == pytest.approx(math.sqrt(2.0))
    assert call(guided, local(VELOCITY, x=0.0, y=-30.0)) == ("guided_heading", -math.pi / 2, WP_SPEED)


@pytest.mark.parametrize(("mask", "asked"), [
    (VELOCITY_AND_YAW, ("guided_heading", 0.5, -1.0)), (VELOCITY_AND_RATE, ("guided_turn_rate", 0.25, -1.0))
])  # fmt: skip
def test_backward_beside_a_yaw(guided: Bench, mask: int, asked: tuple[Any, ...]) -> None:
    assert call(guided, local(mask, x=-1.0)) == asked


@pytest.mark.parametrize(("frame", "place"), [(1, (1, 2)), (7, (101, 202)), (8, (98, 201)), (9, (98, 201))])
def test_frames_of_positions(guided: Bench, frame: int, place: tuple[float, float]) -> None:
    _, target, _ = call(guided, local(POSITION, frame))
    assert target[:2] == pytest.approx(place)


def test_body_frames_turn_velocities_and_yaws(guided: Bench) -> None:
    _, heading, speed = call(guided, local(VELOCITY, 8))
    assert heading == pytest.approx(math.pi / 2) and speed == pytest.approx(1.0)
    _, heading, _ = call(guided, local(VELOCITY_AND_YAW, 9))
    assert heading == pytest.approx(math.pi / 2 + 0.5)


def test_what_is_ignored(guided: Bench) -> None:
    assert call(guided, local(POSITION, frame=2)) == ()
    guided.vehicle.v.autopilot.estimate.origin_set = 0
    assert call(guided, local(VELOCITY)) == ()
    guided.vehicle.v.autopilot.estimate.origin_set = 1
    guided.vehicle.v.autopilot.modes.number = 4
    assert call(guided, local(VELOCITY)) == call(guided, attitude(7, 0.5)) == ()


def test_an_acceleration_is_refused_with_a_text(guided: Bench) -> None:
    said = guided.ask(local(WITH_ACCELERATION), "STATUSTEXT")
    assert "".join(m.text for m in said) == "Ignoring SET_POSITION_TARGET_LOCAL_NED; set ACC_IGNORE in mask"
    assert guided.autopilot.calls == []


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_a_number_that_is_none_stops_the_vehicle(guided: Bench, bad: float) -> None:
    assert call(guided, local(VELOCITY, x=bad)) == ("guided_stop",)
    assert call(guided, local(VELOCITY_AND_YAW, yaw=bad)) == ("guided_stop",)
    assert call(guided, local(YAW_RATE, rate=bad)) == ("guided_stop",)
    assert call(guided, local(POSITION, x=bad, yaw=bad, rate=bad))[0] == "guided_position", "those are not asked for"
    assert call(guided, attitude(3, bad)) == call(guided, attitude(7, 1.0, yaw=bad)) == ()


@pytest.mark.parametrize("frame", [0, 3, 5, 6, 10, 11])
def test_places_on_the_globe(guided: Bench, frame: int) -> None:
    def place(lat: int, frame: int, alt: float = math.nan) -> Any:
        return mavlink.MAVLink_set_position_target_global_int_message(
            0, 1, 1, frame, POSITION, lat, HOME[1], alt, *(0.0,) * 8
        )

    name, (n, e, _), _ = call(guided, place(HOME[0] + 1000, frame))
    assert name == "guided_position" and (n, e) == pytest.approx((11.13, 0.0), abs=0.01)
    assert call(guided, place(910_000_000, frame)) == ()
    assert call(guided, place(HOME[0], 1)) == ()


def test_attitude_is_heading_or_turn_rate_and_a_share_of_the_speed(guided: Bench) -> None:
    name, heading, speed = call(guided, attitude(7, 0.5, yaw=1.0))
    assert (name, heading, speed) == ("guided_heading", pytest.approx(1.0), pytest.approx(1.0))
    assert call(guided, attitude(3, -3.0, rate=0.5)) == ("guided_turn_rate", 0.5, -WP_SPEED)
    assert call(guided, attitude(0x47, 0.5)) == ()


def test_mission_items_as_targets(guided: Bench) -> None:
    def item(current: int) -> int:
        message = mavlink.MAVLink_mission_item_int_message(
            1, 1, 0, 3, 16, current, 1, 0, 0, 0, 0, HOME[0] + 1000, HOME[1], 0.0
        )
        (ack,) = guided.ask(message, "MISSION_ACK")
        return int(ack.type)

    assert item(2) == 0 and guided.autopilot.calls[-1][0] == "guided_position"
    guided.autopilot.calls.clear()
    assert item(3) == 0 and guided.autopilot.calls == [], "a rover has one height"
