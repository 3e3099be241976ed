# SPDX-License-Identifier: BSD-3-Clause
"""What ArduRover's rules make of set-points."""

from __future__ import annotations

import math
from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.autopilot.rover.modes.auto import AUTO, GUIDED_IN_MISSION, ON_PATH
from sitl.autopilot.rover.modes.guided import GUIDED, HEADING_AND_SPEED, POSITION, STOP, TURN_RATE_AND_SPEED
from sitl.autopilot.rover.modes.guided_setpoints import SETPOINT_IGNORED
from sitl.bridge.bridge import Bridge
from sitl.bridge.links import InProcessLink
from sitl.bridge.rover.setpoints import attitude_target, position_target_global, position_target_local
from sitl.bridge.services.setpoint_messages import (
    SetAttitudeTarget,
    SetPositionTargetGlobalInt,
    SetPositionTargetLocalNed,
)
from sitl.vehicle.rover import Rover
from tests.bridge.fakes import HOME, Bench, Client, FakeRover, filled

ONLY_POSITION, VELOCITY, YAW, YAW_RATE = 0xDF8, 0xDC7, 0x9FF, 0x5FF
VELOCITY_AND_YAW, VELOCITY_AND_RATE, ALL_BUT_POSITION = 0x9C7, 0x5C7, 0x1C7
WITH_ACCELERATION = 0xC07
WP_SPEED = 2.0
NOW = 5_000_000


@pytest.fixture
def v() -> Rover:
    """In GUIDED, 100 m north and 200 m east of the origin, facing east."""
    vehicle = FakeRover()
    vehicle.locate()
    rover: Rover = vehicle.v
    rover.time_us = NOW
    rover.autopilot.modes.number = GUIDED
    rover.autopilot.params.WP.SPEED = WP_SPEED
    rover.autopilot.estimate.euler = (0.0, 0.0, math.pi / 2)
    rover.autopilot.estimate.pos = (100.0, 200.0, 0.0)
    return rover


def local(mask: int, frame: int = 1, vx: float = 1.0, vy: float = 0.0, **more: float) -> Any:
    """Position (1, 2) and velocity (vx, vy)."""
    fields = {"x": 1.0, "y": 2.0, "afx": 7.0, "yaw": 0.5, "yaw_rate": 0.25, **more}
    return filled(SetPositionTargetLocalNed, coordinate_frame=frame, type_mask=mask, vx=vx, vy=vy, **fields)


def place(lat: int, frame: int, mask: int = ONLY_POSITION) -> Any:
    fields = {"lat_int": lat, "lon_int": HOME[1], "alt": math.nan}
    return filled(SetPositionTargetGlobalInt, coordinate_frame=frame, type_mask=mask, vx=1.0, **fields)


def attitude(mask: int, thrust: float, yaw: float = 0.0, rate: float = 0.0) -> Any:
    q = [math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2)] if math.isfinite(yaw) else [yaw] * 4
    return filled(SetAttitudeTarget, type_mask=mask, q=q, body_yaw_rate=rate, thrust=thrust)


LAWS: dict[type, Any] = {
    SetPositionTargetLocalNed: position_target_local,
    SetPositionTargetGlobalInt: position_target_global,
    SetAttitudeTarget: attitude_target,
}


def driven(v: Rover, message: Any) -> tuple[Any, ...]:
    """What GUIDED drives after a set-point; nothing when it left the record as it was."""
    guided = v.autopilot.modes.guided
    guided.submode, guided.has_target = POSITION, True
    before = bytes(v._bytes)
    LAWS[type(message)](message, v, 255)
    if bytes(v._bytes) == before:
        return ()
    if guided.submode == STOP:
        assert not guided.has_target
        return (STOP,)
    assert guided.has_target and guided.update_us == NOW
    if guided.submode == POSITION:
        return (POSITION, *guided.pos)
    return (guided.submode, guided.heading if guided.submode == HEADING_AND_SPEED else guided.turn_rate, guided.speed)


@pytest.mark.parametrize(("mask", "asked"), [
    (ONLY_POSITION, (POSITION, 1.0, 2.0)),
    (0x1C0, (POSITION, 1.0, 2.0)),  # a position comes before all else
    (VELOCITY, (HEADING_AND_SPEED, 0.0, 1.0)),
    (VELOCITY_AND_YAW, (HEADING_AND_SPEED, 0.5, 1.0)),
    (VELOCITY_AND_RATE, (TURN_RATE_AND_SPEED, 0.25, 1.0)),
    (YAW, (HEADING_AND_SPEED, 0.5, 0.0)),
    (YAW_RATE, (TURN_RATE_AND_SPEED, 0.25, 0.0)),
    (ALL_BUT_POSITION, ()),
    (0xDFF, ()),
])  # fmt: skip
def test_kinds(v: Rover, mask: int, asked: tuple[Any, ...]) -> None:
    assert driven(v, local(mask)) == asked


@pytest.mark.parametrize(("vx", "vy", "heading", "speed"), [
    (-1.0, 1.0, math.radians(135), math.sqrt(2.0)), (0.0, -30.0, -math.pi / 2, WP_SPEED),
])  # fmt: skip
def test_a_velocity_is_a_heading_and_a_speed_up_to_the_limit(
    v: Rover, vx: float, vy: float, heading: float, speed: float
) -> None:
    asked = driven(v, local(VELOCITY, vx=vx, vy=vy))
    assert asked == (HEADING_AND_SPEED, pytest.approx(heading), pytest.approx(speed))


@pytest.mark.parametrize("frame", [1, 9])
@pytest.mark.parametrize("mask", [VELOCITY_AND_YAW, VELOCITY_AND_RATE])
def test_backward_beside_a_yaw_in_whatever_frame(v: Rover, mask: int, frame: int) -> None:
    assert driven(v, local(mask, frame, vx=-1.0))[2] == pytest.approx(-1.0)


@pytest.mark.parametrize(("frame", "place"), [(1, (1, 2)), (7, (101, 202)), (8, (98, 201)), (9, (98, 201))])
def test_frames_of_positions(v: Rover, frame: int, place: tuple[float, float]) -> None:
    assert driven(v, local(ONLY_POSITION, frame))[1:] == pytest.approx(place)


def test_body_frames_turn_velocities_and_yaws(v: Rover) -> None:
    assert driven(v, local(VELOCITY, 8))[1:] == pytest.approx((math.pi / 2, 1.0))
    assert driven(v, local(VELOCITY_AND_YAW, 9))[1] == pytest.approx(math.pi / 2 + 0.5)


@pytest.mark.parametrize("message", [
    local(ONLY_POSITION, frame=2), place(910_000_000, 3), place(HOME[0], 1), attitude(0x47, 0.5),
    attitude(3, math.nan), attitude(3, 0.5, rate=math.inf),
    attitude(7, 1.0, yaw=math.nan), attitude(7, 1.0, yaw=math.inf),
])  # fmt: skip
def test_what_is_ignored(v: Rover, message: Any) -> None:
    assert driven(v, message) == ()


def test_a_local_set_point_needs_an_origin(v: Rover) -> None:
    v.autopilot.estimate.origin_set = False
    assert driven(v, local(VELOCITY)) == driven(v, place(HOME[0], 3)) == ()
    assert driven(v, place(HOME[0], 3, VELOCITY)) == (HEADING_AND_SPEED, 0.0, 1.0)


@pytest.mark.parametrize(("mode", "submode", "is_open"), [
    (4, 0, False), (AUTO, ON_PATH, False), (AUTO, GUIDED_IN_MISSION, True), (GUIDED, 0, True),
])  # fmt: skip
def test_guided_and_missions_that_wait_listen(v: Rover, mode: int, submode: int, is_open: bool) -> None:
    v.autopilot.modes.number, v.autopilot.modes.auto.submode = mode, submode
    for message in (local(VELOCITY), place(HOME[0], 3, VELOCITY), attitude(7, 0.5)):
        assert (driven(v, message) != ()) == is_open


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_a_number_that_is_none_stops_the_vehicle(v: Rover, bad: float) -> None:
    assert driven(v, local(VELOCITY, vx=bad)) == (STOP,)
    assert driven(v, local(VELOCITY_AND_YAW, yaw=bad)) == (STOP,)
    assert driven(v, local(YAW_RATE, yaw_rate=bad)) == (STOP,)
    ignored = local(ONLY_POSITION, vx=bad, yaw=bad, yaw_rate=bad, z=bad)
    assert driven(v, ignored) == (POSITION, 1.0, 2.0), "those are not asked for"


@pytest.mark.parametrize("frame", [0, 3, 5, 6, 10, 11])
def test_places_on_the_globe(v: Rover, frame: int) -> None:
    submode, north, east = driven(v, place(HOME[0] + 1000, frame))
    assert submode == POSITION and (north, east) == pytest.approx((11.13, 0.0), abs=0.01)


def test_attitude_is_heading_or_turn_rate_and_a_share_of_the_speed(v: Rover) -> None:
    assert driven(v, attitude(7, 0.5, yaw=1.0)) == (HEADING_AND_SPEED, pytest.approx(1.0), pytest.approx(1.0))
    assert driven(v, attitude(3, -3.0, rate=0.5)) == (TURN_RATE_AND_SPEED, 0.5, -WP_SPEED)


@pytest.mark.parametrize("cls", [SetPositionTargetLocalNed, SetPositionTargetGlobalInt])
def test_an_acceleration_is_an_event(v: Rover, cls: Any) -> None:
    ring, guided = v.autopilot.events, bytes(v.autopilot.modes.guided._bytes)
    LAWS[cls](filled(cls, coordinate_frame=1 if cls is SetPositionTargetLocalNed else 3, type_mask=0xC07), v, 255)
    assert (ring.count, ring.code[0], ring.a[0], ring.time_us[0]) == (1, SETPOINT_IGNORED, cls.kind.id, NOW)
    assert bytes(v.autopilot.modes.guided._bytes) == guided


def test_an_acceleration_is_refused_with_a_text() -> None:
    vehicle = FakeRover()
    vehicle.locate()
    vehicle.v.autopilot.modes.number = GUIDED
    bridge, link = Bridge(vehicle), InProcessLink()  # type: ignore[arg-type]
    bridge.add_link(link)
    client = Client(link)
    client.send(mavlink.MAVLink_set_position_target_local_ned_message(0, 1, 1, 1, WITH_ACCELERATION, *(0.0,) * 11))
    bridge.receive()
    said = client.receive("STATUSTEXT")
    assert "".join(m.text for m in said) == "Ignoring SET_POSITION_TARGET_LOCAL_NED; set ACC_IGNORE in mask"
    assert said[0].severity == mavlink.MAV_SEVERITY_INFO


def test_mission_items_as_targets(rover_bench: Bench) -> None:
    rover_bench.vehicle.locate()
    rover_bench.vehicle.v.autopilot.modes.number = GUIDED

    def item(current: int) -> int:
        message = mavlink.MAVLink_mission_item_int_message(
            1, 1, 0, 3, 16, current, 1, 0, 0, 0, 0, HOME[0] + 1000, HOME[1], 0.0
        )
        (ack,) = rover_bench.ask(message, "MISSION_ACK")
        return int(ack.type)

    assert item(2) == 0 and rover_bench.autopilot.calls[-1][0] == "guided_position"
    rover_bench.autopilot.calls.clear()
    assert item(3) == 0 and rover_bench.autopilot.calls == [], "a rover has one height"
