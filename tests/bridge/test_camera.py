# SPDX-License-Identifier: BSD-3-Clause
"""The camera: what takes pictures, what triggers it, and what it tells."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.autopilot.mission.item import MissionItem
from sitl.core.mavlink import MavCmd
from sitl.core.vectors import Euler, Vec3
from tests.bridge.fakes import Bench, Client, FakeRover

ACCEPTED, DENIED, UNSUPPORTED, FAILED = 0, 2, 3, 4
CONFIGURE, CONTROL, DISTANCE = MavCmd.DO_DIGICAM_CONFIGURE, MavCmd.DO_DIGICAM_CONTROL, MavCmd.DO_SET_CAM_TRIGG_DIST
START, STOP = MavCmd.IMAGE_START_CAPTURE, MavCmd.IMAGE_STOP_CAPTURE
REQUEST, SET_INTERVAL, FEEDBACK = 512, 511, 180
SHOT = (0.0, 0.0, 0.0, 0.0, 1.0)
TICK = 0.0025


def bench(kind: float = 1.0, **params: float) -> Bench:
    """A rover whose output 9 triggers the camera."""
    vehicle = FakeRover()
    vehicle.locate()
    vehicle.parameters.update({"CAM1_TYPE": kind, "SERVO9_FUNCTION": 10.0} | params)
    return Bench(vehicle)


def pictures(b: Bench, seconds: float) -> list[Any]:
    """CAMERA_FEEDBACK of the next seconds."""
    b.client.receive()
    b.run(seconds)
    return b.client.receive("CAMERA_FEEDBACK")


def pulses(b: Bench) -> list[int]:
    """Pulses of output 9 since the last call, each change once."""
    found = [call[2] for call in b.autopilot.calls if call[:2] == ("set_servo", 9)]
    b.autopilot.calls.clear()
    return [p for k, p in enumerate(found) if k == 0 or p != found[k - 1]]


@pytest.mark.parametrize("kind", [0.0, 2.0, 3.0, 6.0])
def test_without_a_camera(kind: float) -> None:
    """CAM1_TYPE 1 servo, 4 relay, 5 MAVLink; the others are of cameras that are not simulated."""
    b = bench(kind)
    for number in (CONFIGURE, CONTROL, DISTANCE, STOP):
        assert b.command(number, *SHOT) == ACCEPTED
    assert b.command(START, 0, 0, 1) == FAILED
    assert b.command(REQUEST, FEEDBACK) == ACCEPTED, "nothing comes, as from ArduPilot"
    assert b.command(SET_INTERVAL, FEEDBACK, 100_000) == DENIED
    assert (pictures(b, 2.0), pulses(b), b.vehicle.parameters["CAM1_TRIGG_DIST"]) == ([], [], 0.0)


def test_a_servo_output_triggers_it() -> None:
    b = bench(CAM1_DURATION=0.5, CAM1_SERVO_ON=1700.0, CAM1_SERVO_OFF=1200.0)
    b.run(0.1)
    assert pulses(b) == [1200]
    assert b.command(CONTROL, 0, 0, 0, 0, 0) == ACCEPTED  # no shot
    assert pulses(b) == []
    assert b.command(CONTROL, *SHOT) == ACCEPTED
    b.run(0.48)
    assert pulses(b) == [1700]
    b.run(0.04)
    assert pulses(b) == [1700, 1200]


def test_a_relay_triggers_it() -> None:
    b = bench(4.0, RELAY2_FUNCTION=4.0, RELAY2_PIN=2.0, CAM1_RELAY_ON=0.0, CAM1_DURATION=0.2)
    b.run(0.1)
    assert b.vehicle.parameters["SIM_PIN_MASK"] == 4.0
    assert b.command(START, 1, 0, 1) == ACCEPTED
    assert b.vehicle.parameters["SIM_PIN_MASK"] == 0.0
    b.run(0.3)
    assert b.vehicle.parameters["SIM_PIN_MASK"] == 4.0


def test_what_is_told_of_a_picture() -> None:
    b = bench()
    other = b.connect(system=1, component=191)
    estimate = b.vehicle.v.autopilot.estimate
    estimate.pos, estimate.euler = Vec3(100.0, 0.0, -7.0), Euler(0.25, 0.0, -0.5)
    b.run(3.0)
    assert b.command(CONTROL, *SHOT) == ACCEPTED
    b.bridge.flush()
    (m,) = other.receive("CAMERA_FEEDBACK")
    assert (m.img_idx, m.completed_captures, m.cam_idx, m.flags) == (1, 0, 0, mavlink.CAMERA_FEEDBACK_PHOTO)
    assert m.time_usec == b.bridge.epoch_us + b.bridge.elapsed_us
    assert (m.lat, m.lng) == pytest.approx((-353632620 + 8983, 1491652370), abs=2)
    assert (m.alt_msl, m.alt_rel) == pytest.approx((591.0, 7.0))
    assert (m.roll, m.pitch, m.yaw) == pytest.approx((14.324, 0.0, 331.352), abs=1e-3)


def test_feedback_is_sent_on_request_and_as_a_stream() -> None:
    b = bench()
    assert b.command(REQUEST, FEEDBACK) == ACCEPTED
    assert b.command(SET_INTERVAL, FEEDBACK, 100_000) == ACCEPTED
    assert len(pictures(b, 2.0)) == 20
    assert b.command(SET_INTERVAL, FEEDBACK, 0) == ACCEPTED  # the default: none
    assert pictures(b, 2.0) == []
    assert b.command(CONTROL, *SHOT) == ACCEPTED
    b.client.receive()
    assert b.telemetry("CAMERA_FEEDBACK")[0].img_idx == 1


def test_pictures_at_an_interval() -> None:
    b = bench()
    b.run(0.1)
    assert b.command(START, 0, 1.0, 3) == ACCEPTED
    assert [m.img_idx for m in pictures(b, 10.0)] == [1, 2, 3]
    assert b.command(START, 1, 0.5, 0) == ACCEPTED
    assert len(pictures(b, 10.2)) == 21
    assert b.command(STOP, 1) == ACCEPTED
    assert pictures(b, 3.0) == []
    for refused, params in (
        (UNSUPPORTED, (-1, 0, 1)),
        (FAILED, (2, 0, 1)),
        (DENIED, (1, -1, 2)),
        (DENIED, (1, 1, 1e6)),
    ):
        assert b.command(START, *params) == refused
    assert (b.command(STOP, -1), b.command(STOP, 2)) == (UNSUPPORTED, UNSUPPORTED)


def test_shortest_time_between_pictures() -> None:
    b = bench(CAM1_INTRVAL_MIN=2.0)
    assert b.command(START, 0, 0, 0) == ACCEPTED
    assert b.command(START, 0, 0, 0) == FAILED  # it is taken later
    assert pictures(b, 1.9) == []
    assert [m.img_idx for m in pictures(b, 5.0)] == [2]


def drive(b: Bench, metres: float) -> int:
    """Go north at 1 m/s; how many pictures are taken."""
    estimate, found = b.vehicle.v.autopilot.estimate, 0
    for _ in range(round(metres * 10.0)):
        estimate.pos = Vec3(estimate.pos.x + 0.1, 0.0, 0.0)
        found += len(pictures(b, 0.1))
    return found


def test_pictures_at_a_distance() -> None:
    b = bench()
    assert drive(b, 10.0) == 0
    assert b.command(DISTANCE, 1.9375, 0, 0) == ACCEPTED
    assert b.vehicle.parameters["CAM1_TRIGG_DIST"] == 1.9375
    b.run(0.1)
    assert drive(b, 10.0) == 5  # each 2 m
    assert pictures(b, 10.0) == []  # it stands
    assert b.command(DISTANCE, 0.0, 0, 1) == ACCEPTED  # one at once, then no more
    assert b.telemetry("CAMERA_FEEDBACK")[0].img_idx == 6
    assert drive(b, 10.0) == 0


def test_missions_do_the_same() -> None:
    b = bench()
    b.run(0.1)
    b.bridge.carry_out(MissionItem(CONTROL, x=1))
    b.bridge.carry_out(MissionItem(DISTANCE, p1=5.0, p3=1.0))
    b.bridge.carry_out(MissionItem(START, p2=1.0, p3=3.0))
    assert [m.img_idx for m in pictures(b, 5.0)] == [1, 2, 3, 4, 5]
    b.bridge.carry_out(MissionItem(START, p2=1.0, p3=0.0))
    b.bridge.carry_out(MissionItem(STOP))
    b.bridge.carry_out(MissionItem(CONFIGURE, p1=1.0))
    assert pictures(b, 5.0) == []
    assert drive(b, 5.5) == 1


def test_a_snapshot_holds_what_is_to_be_done() -> None:
    b = bench()
    b.run(0.1)
    assert b.command(START, 0, 1.0, 3) == ACCEPTED
    b.run(0.5)
    held = b.bridge.snapshot()
    first = [m.img_idx for m in pictures(b, 5.0)]
    b.vehicle.v.time_us -= 5_000_000
    b.bridge.restore(held)
    assert first == [m.img_idx for m in pictures(b, 5.0)] == [2, 3]


def heard(b: Bench) -> Client:
    """A component of the vehicle that has said who it is."""
    component = b.connect(system=1, component=191)
    component.send(mavlink.MAVLink_heartbeat_message(18, 8, 0, 0, 0, 3))
    b.run(0.1)
    component.receive()
    return component


def params(m: Any) -> tuple[Any, ...]:
    return (m.command, m.param1, m.param2, m.param3, m.param4, m.param5, m.param6, m.param7)


def test_components_get_its_commands() -> None:
    b = bench(5.0)
    component = heard(b)
    wanted: list[tuple[float, ...]] = []
    assert b.command(CONTROL, 1, 2, 3, 4, 0, 37) == ACCEPTED
    wanted.append((CONTROL, 1, 2, 3, 4, 0, 37, 0))
    assert b.command(CONFIGURE, 1, 2, 3, 4, 12, 37, 9) == ACCEPTED
    wanted.append((CONFIGURE, 1, 2, 3, 4, 12, 37, 9))
    b.ask(mavlink.MAVLink_command_int_message(1, 1, 0, CONTROL, 0, 0, 1, 2, 3, 4, 5, 17, 0))
    wanted.append((CONTROL, 1, 2, 3, 4, 5, 17, 0))
    b.ask(mavlink.MAVLink_digicam_control_message(1, 1, 1, 2, 3, 4, 5, 6, 0, 0))
    wanted.append((CONTROL, 1, 2, 3, 4, 5, 6, 0))
    b.ask(mavlink.MAVLink_digicam_configure_message(1, 1, 1, 2, 3, 4, 5, 6, 7, 0, 0))
    wanted.append((CONFIGURE, 1, 2, 3, 4, 5, 6, 7))
    assert [params(m) for m in component.receive("COMMAND_LONG")] == wanted
    assert b.command(START, 0, 0, 1) == ACCEPTED
    assert [params(m) for m in component.receive("COMMAND_LONG")] == [(CONTROL, 0, 0, 0, 0, 1, 0, 0)]
    assert b.client.receive("COMMAND_LONG") == []  # of another system
    assert pulses(b) == []


def test_messages_take_pictures_too() -> None:
    b = bench()
    component = heard(b)
    b.client.receive()
    assert len(b.ask(mavlink.MAVLink_digicam_control_message(1, 1, 0, 0, 0, 0, 1, 0, 0, 0), "CAMERA_FEEDBACK")) == 1
    b.ask(mavlink.MAVLink_digicam_control_message(2, 1, 0, 0, 0, 0, 1, 0, 0, 0))  # to another vehicle
    b.ask(mavlink.MAVLink_digicam_configure_message(1, 1, 1, 2, 3, 4, 5, 6, 7, 0, 0))
    assert b.telemetry("CAMERA_FEEDBACK")[0].img_idx == 1
    assert component.receive("COMMAND_LONG") == []


@pytest.mark.parametrize("seconds", [0.01, 0.0175, 0.1, 0.5])
def test_the_output_goes_back_when_its_time_is_over(seconds: float) -> None:
    b = bench(CAM1_DURATION=seconds, CAM1_SERVO_ON=1700.0, CAM1_SERVO_OFF=1200.0)
    b.run(0.1)
    pulses(b)
    assert b.command(CONTROL, *SHOT) == ACCEPTED
    b.run(seconds - TICK)
    assert pulses(b) == [1700]
    b.run(TICK)
    assert pulses(b)[-1:] == [1200]


def test_a_picture_may_be_taken_when_the_shortest_time_is_over() -> None:
    b = bench(CAM1_INTRVAL_MIN=2.0)
    b.run(0.1)
    assert b.command(START, 0, 0, 0) == ACCEPTED
    b.run(2.0)
    assert b.command(START, 0, 0, 0) == ACCEPTED
    b.run(2.0 - TICK)
    assert b.command(START, 0, 0, 0) == FAILED


@pytest.mark.parametrize("metres, taken", [(1.9375, 0), (2.0, 1), (2.0625, 1)])
@pytest.mark.parametrize("way", [(1.0, 0.0), (0.0, -1.0)])
def test_a_picture_is_due_at_its_distance(metres: float, taken: int, way: tuple[float, float]) -> None:
    b = bench(CAM1_TRIGG_DIST=2.0)
    b.run(0.1)
    b.vehicle.v.autopilot.estimate.pos = Vec3(metres * way[0], metres * way[1], -50.0)
    assert len(pictures(b, 0.1)) == taken


def test_the_most_and_the_longest_that_can_be_asked_for() -> None:
    b = bench()
    for asked, params in (
        (ACCEPTED, (0, 1e6, 32767)),
        (DENIED, (0, 1e6 + 1.0, 32767)),
        (DENIED, (0, 1e6, 32768)),
        (DENIED, (0, 1.0, -1)),
        (ACCEPTED, (1, 0, 2)),
    ):
        assert b.command(START, *params) == asked, params


@pytest.mark.parametrize("output", [1, 16])
def test_any_output_may_trigger_it(output: int) -> None:
    b = bench(SERVO9_FUNCTION=0.0, **{f"SERVO{output}_FUNCTION": 10.0})
    assert b.command(CONTROL, *SHOT) == ACCEPTED
    assert {call[1] for call in b.autopilot.calls if call[0] == "set_servo"} == {output}


@pytest.mark.parametrize("is_set", [True, False])
def test_heights_above_home_need_a_home(is_set: bool) -> None:
    b = bench()
    b.vehicle.v.autopilot.home.is_set, b.vehicle.v.autopilot.estimate.pos = is_set, Vec3(0.0, 0.0, -7.0)
    assert b.command(CONTROL, *SHOT) == ACCEPTED
    (m,) = b.telemetry("CAMERA_FEEDBACK")
    assert (m.alt_msl, m.alt_rel) == (591.0, 7.0 if is_set else 0.0)


def test_the_distance_counts_from_where_it_was_set() -> None:
    b = bench()
    assert b.command(CONTROL, *SHOT) == ACCEPTED
    assert drive(b, 5.0) == 0
    assert b.command(DISTANCE, 3.0, 0, 0) == ACCEPTED
    b.run(0.1)
    assert (drive(b, 2.5), drive(b, 1.0)) == (0, 1)


def test_without_a_position_no_distance_is_counted() -> None:
    b = bench(CAM1_TRIGG_DIST=2.0)
    b.run(0.1)
    b.vehicle.v.autopilot.estimate.position_ok = 0
    assert drive(b, 5.0) == 0
    b.vehicle.v.autopilot.estimate.position_ok = 1
    assert len(pictures(b, 0.1)) == 1


@pytest.mark.parametrize("on", [1.0, 0.0])
def test_a_relay_is_on_or_off_while_it_triggers(on: float) -> None:
    b = bench(4.0, RELAY2_FUNCTION=4.0, RELAY2_PIN=2.0, CAM1_RELAY_ON=on, CAM1_DURATION=0.2)
    assert b.command(START, 1, 0, 1) == ACCEPTED
    seen = [b.vehicle.parameters["SIM_PIN_MASK"]]
    b.run(0.3)
    seen.append(b.vehicle.parameters["SIM_PIN_MASK"])
    assert seen == ([4.0, 0.0] if on else [0.0, 4.0])


def test_pictures_that_were_asked_for_at_an_interval_come_at_it() -> None:
    b = bench()
    b.run(0.1)
    assert b.command(START, 0, 0.25, 4) == ACCEPTED
    b.client.receive()
    times = []
    for _ in range(600):
        b.run(TICK)
        times += [b.vehicle.time_us for _ in b.client.receive("CAMERA_FEEDBACK")]
    assert [after - before for before, after in pairwise(times)] == [260_000] * 3, "it looks 50 times a second"
