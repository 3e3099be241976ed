# SPDX-License-Identifier: BSD-3-Clause
"""The services on the rover firmware's own laws (plain Python), without the core."""

from __future__ import annotations

import math

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.autopilot import events
from sitl.autopilot.mission.mission import Mission
from sitl.autopilot.mission.sequencer import Sequencer
from sitl.autopilot.rover.modes import guided as guided_mode
from sitl.bridge.bridge import Bridge
from sitl.bridge.rover.autopilot import RoverAutopilot
from tests.bridge.fakes import HOME, Bench, FakeRover

ACCEPTED, DENIED, FAILED = 0, 2, 4
MANUAL, HOLD, AUTO, RTL, GUIDED = 0, 4, 10, 11, 15


class Vehicle(FakeRover):
    def __init__(self) -> None:
        super().__init__()
        self.mission = Mission()
        self.sequencer = Sequencer(self, self.firmware.commands)


class RoverBench(Bench):
    """As Bench, but the autopilot is the firmware's."""

    def __init__(self) -> None:
        self.vehicle = Vehicle()
        self.autopilot = RoverAutopilot(self.vehicle)  # type: ignore[assignment]
        self.bridge = Bridge(self.vehicle, autopilot=self.autopilot)
        self.client = self.connect()

    def ready(self) -> None:
        """With a position, in GUIDED, armed."""
        self.vehicle.locate()
        ap = self.vehicle.v.autopilot
        ap.estimate.attitude_ok, ap.estimate.q = True, (1.0, 0.0, 0.0, 0.0)
        ap.modes.number = GUIDED
        ap.arming.armed = 1
        self.vehicle.v.time_us = 60_000_000

    def texts(self, message: object) -> list[str]:
        return [m.text for m in self.ask(message, "STATUSTEXT")]

    def local(self, mask: int, x: float, y: float) -> None:
        self.ask(mavlink.MAVLink_set_position_target_local_ned_message(
            0, 1, 1, 1, mask, x, y, 0, x, y, 0, *(math.nan,) * 5
        ))  # fmt: skip


@pytest.fixture
def rover() -> RoverBench:
    return RoverBench()


def long(number: int, *p: float) -> object:
    return mavlink.MAVLink_command_long_message(1, 1, number, 0, *p, *(0.0,) * (7 - len(p)))


def test_arming_too_early_is_refused_with_reasons(rover: RoverBench) -> None:
    texts = rover.texts(long(400, 1))
    assert texts and all(t.startswith("Arm: ") for t in texts) and len(set(texts)) == len(texts)
    assert not rover.autopilot.armed()


def test_a_forced_arming_needs_nothing_and_a_moving_rover_is_disarmed(rover: RoverBench) -> None:
    assert rover.command(400, 1, 2989) == ACCEPTED
    rover.vehicle.v.autopilot.estimate.vel = (2.0, 0.0, 0.0)
    assert rover.command(400, 0) == ACCEPTED and not rover.autopilot.armed()
    rover.bridge.on_events()


def test_mode_refusals_are_said_once(rover: RoverBench) -> None:
    rover.ready()
    said = ["No Mission. Can't set AUTO.", "Flight mode change failed"]
    assert rover.texts(long(176, 1, AUTO)) == said
    assert rover.texts(long(300)) == said
    assert rover.texts(long(176, 1, 99)) == ["No such mode 99"]
    assert rover.command(176, 1, HOLD) == ACCEPTED


def test_set_points_reach_guided(rover: RoverBench) -> None:
    rover.ready()
    guided = rover.vehicle.v.autopilot.modes.guided
    rover.local(0xDF8, 5.0, 6.0)
    assert guided.submode == guided_mode.POSITION and list(guided.pos) == [5.0, 6.0]
    rover.local(0xDC7, 0.0, 1.5)
    assert guided.submode == guided_mode.HEADING_AND_SPEED
    assert (float(guided.heading), float(guided.speed)) == (pytest.approx(math.pi / 2), 1.5)
    assert rover.command(213, 45, -0.5, 1) == ACCEPTED
    assert (float(guided.heading), float(guided.speed)) == (pytest.approx(math.radians(135)), -0.5)
    rover.ask(mavlink.MAVLink_set_attitude_target_message(0, 1, 1, 3, [1, 0, 0, 0], 0, 0, 0.25, 0.5))
    assert guided.submode == guided_mode.TURN_RATE_AND_SPEED and guided.turn_rate == 0.25
    assert guided.speed == pytest.approx(0.5 * float(rover.vehicle.v.autopilot.params.WP_SPEED))
    rover.local(0xDC7, math.nan, 0.0)
    assert guided.submode == guided_mode.STOP


def test_speed_is_set_on_the_way_to_a_place_only(rover: RoverBench) -> None:
    rover.ready()
    assert rover.command(178, 1, 1.0) == FAILED
    rover.local(0xDF8, 5.0, 6.0)
    assert rover.command(178, 1, 1.0) == ACCEPTED
    assert rover.command(178, 1, -5.0) == FAILED


def test_arrival_in_guided_is_told_as_item_0(rover: RoverBench) -> None:
    events.emit(rover.vehicle.v.autopilot.events, 0, events.GUIDED_REACHED, 0.0, 0.0)
    rover.bridge.on_events()
    assert [m.seq for m in rover.client.receive("MISSION_ITEM_REACHED")] == [0]


def test_texts_of_events(rover: RoverBench) -> None:
    ring = rover.vehicle.v.autopilot.events
    for code in (events.ARMED, events.GUIDED_TIMEOUT, events.DESTINATION_REACHED, events.DISARMED):
        events.emit(ring, 0, code, 3.0, 0.0)
    rover.bridge.on_events()
    assert [(m.severity, m.text) for m in rover.client.receive("STATUSTEXT")] == [
        (6, "Throttle armed"), (4, "target not received last 3secs, stopping"), (6, "Reached destination"),
        (6, "Throttle disarmed"),
    ]  # fmt: skip


def test_home_is_told_in_words(rover: RoverBench) -> None:
    assert rover.command(179, 1) == FAILED
    rover.ready()
    assert rover.texts(long(179, 1)) == ["Set HOME to -35.36326 149.1652 at 584.00m"]
    assert rover.vehicle.v.autopilot.home.locked == 1


def test_servos_without_a_function_are_free(rover: RoverBench) -> None:
    p = rover.vehicle.v.autopilot.params
    assert [rover.command(183, n, 1700) for n in (0, 1, 3, 17)] == [FAILED] * 4
    assert [rover.command(183, n, 1700) for n in (2, 9)] == [ACCEPTED] * 2
    assert [int(rover.vehicle.v.actuators.pwm[k]) for k in (1, 8)] == [1700] * 2
    p.SERVO2_FUNCTION = 74
    assert rover.command(183, 2, 1500) == FAILED


def test_motor_test_is_refused_for_outputs_that_are_not_there(rover: RoverBench) -> None:
    rover.ready()
    assert [rover.command(209, n, 0, 10, 1) for n in (0, 3, 5)] == [FAILED] * 3
    assert rover.command(209, 1, 0, -50, 1) == ACCEPTED
    assert rover.command(209, 1, 0, 101, 1) == FAILED
    assert float(rover.vehicle.v.autopilot.control.motors.test_value) == -0.5


def test_return_to_launch(rover: RoverBench) -> None:
    rover.ready()
    assert rover.command(20) == ACCEPTED and rover.autopilot.mode() == RTL
    assert HOME[2] == rover.vehicle.v.autopilot.home.alt
