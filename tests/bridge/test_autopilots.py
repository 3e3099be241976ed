# SPDX-License-Identifier: BSD-3-Clause
"""The services on the firmwares' own laws (plain Python), without the core."""

from __future__ import annotations

import math
from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.autopilot.arming_checks import ARMED, DISARMED
from sitl.autopilot.events import emit
from sitl.autopilot.mission.item import MissionItem
from sitl.autopilot.mission.mission import Mission
from sitl.autopilot.mission.sequencer import Sequencer
from sitl.autopilot.navigation.state import RUNNING, STOPPED
from sitl.autopilot.rover.modes import guided as guided_mode
from sitl.autopilot.rover.modes.guided import GUIDED_REACHED, GUIDED_TIMEOUT
from sitl.autopilot.rover.modes.rtl import DESTINATION_REACHED
from sitl.bridge.base_autopilot import BaseAutopilot
from sitl.bridge.bridge import Bridge
from sitl.bridge.copter.autopilot import CopterAutopilot
from sitl.bridge.rover.autopilot import RoverAutopilot
from tests.bridge.fakes import HOME, Bench, FakeRover, FakeVehicle

ACCEPTED, DENIED, FAILED = 0, 2, 4
MANUAL, HOLD, AUTO, RTL, GUIDED = 0, 4, 10, 11, 15
"""Modes of the rover."""
SQUARE = (
    MissionItem(16, 0, x=HOME[0], y=HOME[1], z=584.0), MissionItem(22, 3, z=10.0),
    MissionItem(16, 3, x=HOME[0] + 2700, y=HOME[1], z=10.0),
)  # fmt: skip


class FirmwareBench(Bench):
    """As Bench, but the autopilot is the firmware's."""

    def __init__(self, vehicle: FakeVehicle, autopilot: type[BaseAutopilot], guided: int) -> None:
        self.vehicle: Any = vehicle
        self.vehicle.mission = Mission()
        self.vehicle.sequencer = Sequencer(vehicle, vehicle.firmware.commands)
        self.autopilot = autopilot(self.vehicle)  # type: ignore[assignment]
        self.bridge = Bridge(self.vehicle, autopilot=self.autopilot)
        self.client = self.connect()
        self.guided = guided

    def ready(self) -> None:
        """On the ground with a position, in GUIDED, armed."""
        self.vehicle.locate()
        ap = self.vehicle.v.autopilot
        ap.estimate.attitude_ok, ap.estimate.q = True, (1.0, 0.0, 0.0, 0.0)
        ap.modes.number = self.guided
        ap.arming.armed = 1
        self.vehicle.v.time_us = 60_000_000


@pytest.fixture
def copter() -> FirmwareBench:
    return FirmwareBench(FakeVehicle(), CopterAutopilot, 4)


@pytest.fixture
def rover() -> FirmwareBench:
    return FirmwareBench(FakeRover(), RoverAutopilot, GUIDED)


def texts(bench: FirmwareBench, message: object) -> list[str]:
    return [m.text for m in bench.ask(message, "STATUSTEXT")]


def local(bench: FirmwareBench, mask: int, x: float, y: float) -> None:
    bench.ask(mavlink.MAVLink_set_position_target_local_ned_message(
        0, 1, 1, 1, mask, x, y, 0, x, y, 0, *(math.nan,) * 5
    ))  # fmt: skip


def long(number: int, *p: float) -> object:
    return mavlink.MAVLink_command_long_message(1, 1, number, 0, *p, *(0.0,) * (7 - len(p)))


def test_arming_a_copter_too_early_is_refused_with_reasons(copter: FirmwareBench) -> None:
    answers = copter.ask(mavlink.MAVLink_command_long_message(1, 1, 400, 0, 1, 0, 0, 0, 0, 0, 0))
    found = [m.text for m in answers if m.get_type() == "STATUSTEXT"]
    assert found and all(t.startswith("Arm: ") for t in found) and len(set(found)) == len(found)
    assert [m.result for m in answers if m.get_type() == "COMMAND_ACK"] == [4]


def test_mode_refusals_of_a_copter_are_said_once(copter: FirmwareBench) -> None:
    copter.ready()
    answers = copter.ask(mavlink.MAVLink_command_long_message(1, 1, 176, 0, 1, 3, 0, 0, 0, 0, 0))
    found = [m.text for m in answers if m.get_type() == "STATUSTEXT"]
    assert found == ["Mode change to AUTO failed: init failed"]
    assert copter.command(300) == 4
    answers = copter.ask(mavlink.MAVLink_command_long_message(1, 1, 176, 0, 1, 99, 0, 0, 0, 0, 0))
    assert [m.text for m in answers if m.get_type() == "STATUSTEXT"] == ["No such mode 99"]


def test_takeoff_and_disarm(copter: FirmwareBench) -> None:
    assert copter.command(22, 0, 0, 0, 0, 0, 0, 10) == 4
    copter.ready()
    assert copter.command(22, 0, 0, 0, 0, 0, 0, 10) == 0
    assert copter.vehicle.v.autopilot.modes.takeoff.target_d == -10.0
    copter.vehicle.v.autopilot.arming.landed = 0
    assert copter.command(400, 0) == 4
    assert copter.command(400, 0, 21196) == 0
    assert "Disarming motors" in [m.text for m in copter.client.receive("STATUSTEXT")] or not copter.autopilot.armed()


def test_set_points_of_a_copter_reach_guided(copter: FirmwareBench) -> None:
    copter.ready()
    guided = copter.vehicle.v.autopilot.modes.guided
    copter.ask(mavlink.MAVLink_set_position_target_local_ned_message(0, 1, 1, 1, 0xDF8, 5, 6, -7, *(math.nan,) * 8))
    assert list(guided.pos) == [5.0, 6.0, -7.0]
    copter.ask(mavlink.MAVLink_set_position_target_local_ned_message(0, 1, 1, 1, 0xDC7, 0, 0, 0, 1, 2, 3, *(0,) * 5))
    assert list(guided.vel) == [1.0, 2.0, 3.0]
    copter.ask(mavlink.MAVLink_set_attitude_target_message(0, 1, 1, 7, [1, 0, 0, 0], 0, 0, 0, 0.6))
    assert guided.thrust == pytest.approx(0.6)
    assert copter.command(115, 90, 0, 0, 0) == 0
    assert copter.command(178, 1, 3) == 0
    assert copter.command(193, 0) == 0 and guided.paused == 1


def test_home(copter: FirmwareBench) -> None:
    assert copter.command(179, 1) == 4
    copter.ready()
    copter.vehicle.v.autopilot.estimate.pos = (10.0, 0.0, -2.0)
    assert copter.command(179, 1) == 0
    home = copter.vehicle.v.autopilot.home
    assert home.locked == 1 and home.alt == 586.0 and home.lat > HOME[0]


def test_a_mission_is_kept_flown_and_cleared(copter: FirmwareBench) -> None:
    copter.ready()
    client = copter.client
    client.send(mavlink.MAVLink_mission_count_message(1, 1, len(SQUARE)))
    result: Any = None
    for _ in range(20):
        copter.bridge.receive()
        for m in client.receive("MISSION_REQUEST", "MISSION_ACK"):
            if m.get_type() == "MISSION_ACK":
                result = m.type
            else:
                i = SQUARE[m.seq]
                client.send(mavlink.MAVLink_mission_item_int_message(
                    1, 1, m.seq, i.frame, i.command, 0, 1, i.p1, i.p2, i.p3, i.p4, i.x, i.y, i.z
                ))  # fmt: skip
    assert result == 0 and len(copter.vehicle.mission) == 3
    assert copter.command(176, 1, 3) == 0
    copter.bridge.report(copter.vehicle.sequencer.attend())
    copter.bridge.flush()
    assert "Mission: 1 Takeoff" in [m.text for m in client.receive("STATUSTEXT")]
    (ack,) = copter.ask(mavlink.MAVLink_mission_clear_all_message(1, 1), "MISSION_ACK")
    assert ack.type == 1  # it is being flown
    assert copter.command(224, 2) == 0
    assert copter.command(224, 9) == 2
    assert copter.command(176, 1, 4) == 0
    copter.vehicle.sequencer.attend()
    (ack,) = copter.ask(mavlink.MAVLink_mission_clear_all_message(1, 1), "MISSION_ACK")
    assert ack.type == 0 and len(copter.vehicle.mission) == 0


def test_item_0_is_home_once_there_is_one(copter: FirmwareBench) -> None:
    autopilot: Any = copter.autopilot
    assert autopilot.mission_items() == ()
    autopilot.home_changed()
    assert autopilot.mission_items() == (), "nothing is known of home"
    assert autopilot.replace_mission(SQUARE) == 0
    assert autopilot.mission_items() == SQUARE
    copter.vehicle.locate()
    copter.vehicle.v.autopilot.home.lat += 1000
    home, *others = autopilot.mission_items()
    assert (home.command, home.x, home.y, home.z) == (16, HOME[0] + 1000, HOME[1], HOME[2])
    assert tuple(others) == SQUARE[1:]
    autopilot.home_changed()
    assert len(autopilot.mission_items()) == 3
    assert autopilot.clear_mission() and autopilot.mission_items() == ()
    autopilot.home_changed()
    (alone,) = autopilot.mission_items()
    assert (alone.command, alone.x, alone.z) == (16, HOME[0] + 1000, HOME[2]), "a mission without other items has it"


def test_arming_a_rover_too_early_is_refused_with_reasons(rover: FirmwareBench) -> None:
    found = texts(rover, long(400, 1))
    assert found and all(t.startswith("Arm: ") for t in found) and len(set(found)) == len(found)
    assert not rover.autopilot.armed()


def test_a_forced_arming_needs_nothing_and_a_moving_rover_is_disarmed(rover: FirmwareBench) -> None:
    assert rover.command(400, 1, 2989) == ACCEPTED
    rover.vehicle.v.autopilot.estimate.vel = (2.0, 0.0, 0.0)
    assert rover.command(400, 0) == ACCEPTED and not rover.autopilot.armed()
    rover.bridge.on_events()


def test_mode_refusals_of_a_rover_are_said_once(rover: FirmwareBench) -> None:
    rover.ready()
    refusal = ["No Mission. Can't set AUTO.", "Flight mode change failed"]
    assert texts(rover, long(176, 1, AUTO)) == refusal
    assert texts(rover, long(300)) == refusal
    assert texts(rover, long(176, 1, 99)) == ["No such mode 99"]
    assert rover.command(176, 1, HOLD) == ACCEPTED


def test_set_points_of_a_rover_reach_guided(rover: FirmwareBench) -> None:
    rover.ready()
    guided = rover.vehicle.v.autopilot.modes.guided
    local(rover, 0xDF8, 5.0, 6.0)
    assert guided.submode == guided_mode.POSITION and list(guided.pos) == [5.0, 6.0]
    local(rover, 0xDC7, 0.0, 1.5)
    assert guided.submode == guided_mode.HEADING_AND_SPEED
    assert (float(guided.heading), float(guided.speed)) == (pytest.approx(math.pi / 2), 1.5)
    rover.ask(mavlink.MAVLink_set_attitude_target_message(0, 1, 1, 3, [1, 0, 0, 0], 0, 0, 0.25, 0.5))
    assert guided.submode == guided_mode.TURN_RATE_AND_SPEED and guided.turn_rate == 0.25
    assert guided.speed == pytest.approx(0.5 * float(rover.vehicle.v.autopilot.params.WP_SPEED))
    local(rover, 0xDC7, math.nan, 0.0)
    assert guided.submode == guided_mode.STOP


def test_speed_is_set_on_the_way_to_a_place_only(rover: FirmwareBench) -> None:
    rover.ready()
    assert rover.command(178, 1, 1.0) == FAILED
    local(rover, 0xDF8, 5.0, 6.0)
    assert rover.command(178, 1, 1.0) == ACCEPTED
    assert rover.command(178, 1, -5.0) == FAILED


def test_arrival_in_guided_is_told_as_item_0(rover: FirmwareBench) -> None:
    emit(rover.vehicle.v.autopilot.events, 0, GUIDED_REACHED, 0.0, 0.0)
    rover.bridge.on_events()
    assert [m.seq for m in rover.client.receive("MISSION_ITEM_REACHED")] == [0]


def test_texts_of_events(rover: FirmwareBench) -> None:
    ring = rover.vehicle.v.autopilot.events
    for code in (ARMED, GUIDED_TIMEOUT, DESTINATION_REACHED, DISARMED):
        emit(ring, 0, code, 3.0, 0.0)
    rover.bridge.on_events()
    assert [(m.severity, m.text) for m in rover.client.receive("STATUSTEXT")] == [
        (6, "Throttle armed"), (4, "target not received last 3secs, stopping"), (6, "Reached destination"),
        (6, "Throttle disarmed"),
    ]  # fmt: skip


def test_home_is_told_in_words(rover: FirmwareBench) -> None:
    assert rover.command(179, 1) == FAILED
    rover.ready()
    assert texts(rover, long(179, 1)) == ["Set HOME to -35.36326 149.1652 at 584.00m"]
    assert rover.vehicle.v.autopilot.home.locked == 1


def test_servos_without_a_function_are_free(rover: FirmwareBench) -> None:
    p = rover.vehicle.v.autopilot.params
    assert [rover.command(183, n, 1700) for n in (0, 1, 3, 17)] == [FAILED] * 4
    assert [rover.command(183, n, 1700) for n in (2, 9)] == [ACCEPTED] * 2
    assert [int(rover.vehicle.v.actuators.pwm[k]) for k in (1, 8)] == [1700] * 2
    p.SERVO2_FUNCTION = 74
    assert rover.command(183, 2, 1500) == FAILED


@pytest.mark.parametrize(
    ("pulse", "sent", "control"),
    [
        (0, 0, 0.0),
        (1, 1, -1.0),
        (500, 500, -1.0),
        (1750, 1750, 0.5),
        (2500, 2500, 1.0),
        (-9, 0, 0.0),
        (9000, 3000, 1.0),
    ],
)
def test_controls_of_servos_stay_within_their_range(
    copter: FirmwareBench, rover: FirmwareBench, pulse: int, sent: int, control: float
) -> None:
    """A trim or an end of the travel (SERVOn_TRIM, _MIN, _MAX) may be any number."""
    for bench in (copter, rover):
        bench.ready()
        assert bench.autopilot.set_servo(9, pulse)
        actuators = bench.vehicle.v.actuators
        assert (int(actuators.pwm[8]), float(actuators.controls[8])) == (sent, control)


@pytest.mark.parametrize(("motor", "kind", "how_much", "result", "value"), [
    (0, 0, 10, ACCEPTED, None), (3, 0, 10, ACCEPTED, None), (5, 0, 10, FAILED, None), (1, 0, -50, ACCEPTED, -0.5),
    (1, 0, -500, ACCEPTED, -1.0), (1, 0, 101, FAILED, None), (1, 1, 2201, FAILED, None), (1, 1, 500, ACCEPTED, None),
    (1, 2, 0, ACCEPTED, 0.25), (1, 3, 0, FAILED, None),
])  # fmt: skip
def test_motor_tests(
    rover: FirmwareBench, motor: int, kind: int, how_much: float, result: int, value: float | None
) -> None:
    """One of an output that is on other rovers is taken, as by ArduRover, and over at once."""
    rover.ready()
    rover.vehicle.v.autopilot.modes.pilot.throttle = 0.25
    assert rover.command(209, motor, kind, how_much, 1) == result
    ap = rover.vehicle.v.autopilot
    assert ap.arming.armed == (result == FAILED or value is not None), "disarmed where it ended"
    assert value is None or float(ap.control.motors.test_value) == value


def test_return_to_launch(rover: FirmwareBench) -> None:
    rover.ready()
    assert rover.command(20) == ACCEPTED and rover.autopilot.mode() == RTL
    assert HOME[2] == rover.vehicle.v.autopilot.home.alt


@pytest.mark.parametrize("items", [SQUARE, ()])
def test_mission_start_in_auto_starts_a_mission_that_is_there_and_has_stopped(
    copter: FirmwareBench, items: Any
) -> None:
    """One that is under way goes on."""
    copter.ready()
    ap = copter.vehicle.v.autopilot
    if items:
        copter.vehicle.sequencer.set_mission(copter.vehicle.v, Mission(items))
    ap.modes.number, nav = 3, ap.modes.nav
    nav.mission_state = STOPPED
    assert copter.command(300) == (ACCEPTED if items else FAILED)
    if items:
        assert nav.mission_state == RUNNING and nav.command_seq == 1
        before = nav.mission_events
        assert copter.command(300) == ACCEPTED and nav.mission_events == before and nav.command_seq == 1
