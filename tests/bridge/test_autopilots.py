# SPDX-License-Identifier: BSD-3-Clause
"""The services on the firmwares' own laws (plain Python), without the core."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.autopilot.arming_checks import AHRS_TYPE, ARMED, DISARMED, NEED_POSITION, TEXTS
from sitl.autopilot.copter.modes.auto_yaw import ROI
from sitl.autopilot.events import emit
from sitl.autopilot.mission.item import MissionItem
from sitl.autopilot.mission.mission import Mission
from sitl.autopilot.mission.sequencer import Sequencer
from sitl.autopilot.modes import MODE_REFUSED
from sitl.autopilot.navigation.state import RTL as RTL_LEG
from sitl.autopilot.navigation.state import RUNNING, STOPPED
from sitl.autopilot.parameter_checks import Found
from sitl.autopilot.radio_checks import PARAMETERS
from sitl.autopilot.rover.modes import guided as guided_mode
from sitl.autopilot.rover.modes.auto import GUIDED_IN_MISSION, ON_PATH
from sitl.autopilot.rover.modes.guided import GUIDED_REACHED, GUIDED_TIMEOUT
from sitl.autopilot.rover.modes.rtl import DESTINATION_REACHED
from sitl.autopilot.sensor_calibration import NEEDS_LOCATION, PARAMETERS_BAD, SWITCHES_BAD
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


# ---------------------------------------------------------------- what services ask a copter's laws


SPEEDS = ("speed_ne", "speed_up", "speed_down")
"""Of a mission (DO_CHANGE_SPEED) [m/s]; 0: those of the parameters."""


@pytest.mark.parametrize(
    ("mode", "command", "name", "rtl_speed", "cleared"),
    [
        (3, 16, "WPNAV_SPEED", 0.0, {"speed_ne"}), (3, 16, "WPNAV_SPEED_UP", 0.0, {"speed_up"}),
        (3, 16, "WPNAV_SPEED_DN", 0.0, {"speed_down"}), (3, 16, "WPNAV_ACCEL", 0.0, set()),
        (3, 16, "WPNAV_SPEED", 500.0, {"speed_ne"}), (21, 0, "WPNAV_SPEED", 500.0, {"speed_ne"}),
        (24, 0, "WPNAV_SPEED", 0.0, {"speed_ne"}),
        (6, 0, "WPNAV_SPEED", 0.0, {"speed_ne"}), (6, 0, "WPNAV_SPEED", 500.0, set()),  # RTL_SPEED comes before it
        (6, 0, "WPNAV_SPEED_UP", 500.0, {"speed_up"}), (3, 20, "WPNAV_SPEED", 500.0, set()),
        (3, 20, "WPNAV_SPEED", 0.0, {"speed_ne"}), (3, 20, "WPNAV_SPEED_DN", 500.0, {"speed_down"}),
        (4, 0, "WPNAV_SPEED", 0.0, set()), (5, 0, "WPNAV_SPEED_DN", 0.0, set()),
    ],
)  # fmt: skip
def test_speeds_that_are_set_while_a_leg_is_flown_hold_from_there_on(
    copter: FirmwareBench, mode: int, command: int, name: str, rtl_speed: float, cleared: set[str]
) -> None:
    """In AUTO, RTL, SMART_RTL and ZIGZAG; on the way home RTL_SPEED holds where there is one."""
    copter.ready()
    ap = copter.vehicle.v.autopilot
    ap.modes.number, nav = mode, ap.modes.nav
    nav.command_kind = RTL_LEG if command == 20 else RTL_LEG + 1
    copter.vehicle.parameters["RTL_SPEED"] = rtl_speed
    for field in SPEEDS:
        setattr(nav, field, 3.0)
    copter.autopilot.parameter_changed(name)
    assert {field for field in SPEEDS if getattr(nav, field) == 0.0} == cleared


@pytest.mark.parametrize(
    ("there", "is_open", "known"), [(True, True, 2), (True, False, 1), (False, True, 0), (False, False, 0)]
)
def test_a_copter_knows_what_its_gripper_does(copter: FirmwareBench, there: bool, is_open: bool, known: int) -> None:
    copter.autopilot.gripper_is(there, is_open)
    assert int(copter.vehicle.v.autopilot.modes.payload_place.gripper) == known


def test_a_copters_motors_are_no_free_outputs(copter: FirmwareBench) -> None:
    copter.vehicle.locate()
    copter.vehicle.parameters.update({"FRAME_CLASS": 1.0} | {f"SERVO{k + 1}_FUNCTION": 33.0 + k for k in range(4)})
    copter.autopilot.parameter_changed("FRAME_CLASS")
    taken = [number for number in range(-1, 40) if copter.autopilot.set_servo(number, 1500)]
    motors = [int(k) + 1 for k in copter.vehicle.v.autopilot.control.motors.output[:4]]
    assert sorted(motors) == [1, 2, 3, 4]
    assert taken == list(range(5, len(copter.vehicle.v.actuators.pwm) + 1))


@pytest.mark.parametrize(
    ("roll", "pitch", "rates", "landed", "rate"),
    [
        (0.0, 0.0, (0.1, 0.2, 0.3), False, 0.3), (math.pi / 2, 0.0, (0.1, 0.2, 0.3), False, 0.2),
        (-math.pi / 2, 0.0, (0.1, 0.2, 0.3), False, -0.2), (0.0, math.pi / 3, (0.1, 0.2, 0.3), False, 0.6),
        (0.0, math.pi / 2, (0.0, 0.0, 0.001), False, 1.0), (0.0, 0.0, (0.1, 0.2, 0.3), True, 0.0),
    ],
)  # fmt: skip
def test_the_rate_of_yaw_that_is_wanted_is_that_about_the_vertical(
    copter: FirmwareBench, roll: float, pitch: float, rates: Any, landed: bool, rate: float
) -> None:
    ap = copter.vehicle.v.autopilot
    ap.arming.landed, attitude = landed, ap.control.attitude
    attitude.target_rate, attitude.target_euler = rates, (roll, pitch, 1.0)
    assert copter.autopilot.yaw_rate_target() == pytest.approx(rate)


def test_height_sink_rate_and_lean_of_a_copter(copter: FirmwareBench) -> None:
    copter.ready()
    ap, autopilot = copter.vehicle.v.autopilot, copter.autopilot
    ap.home.pos, ap.estimate.pos, ap.estimate.vel = (0.0, 0.0, -3.0), (5.0, 6.0, -23.0), (1.0, 2.0, -4.0)
    ap.control.attitude.thrust_error_angle = 0.5
    assert (autopilot.height(), autopilot.sink_rate(), autopilot.lean_error()) == (20.0, -4.0, 0.5)
    for mode, lean in ((1, 0.0), (14, 0.0), (0, 0.5), (5, 0.5)):  # ACRO and FLIP turn over on purpose
        ap.modes.number = mode
        assert autopilot.lean_error() == lean
    for landed in (0, 1):
        ap.arming.landed = landed
        assert autopilot.is_landed() is bool(landed)


@pytest.mark.parametrize("stops", [True, False])
def test_after_a_parachute_it_is_not_armed_again(copter: FirmwareBench, stops: bool) -> None:
    copter.ready()
    arming = copter.vehicle.v.autopilot.arming
    arming.landed = 0
    copter.autopilot.release_parachute(stops)
    assert bool(arming.parachute_released) and bool(arming.armed) is not stops


def test_the_throttle_is_on_the_channel_that_rcmap_says(copter: FirmwareBench) -> None:
    channels = copter.vehicle.v.autopilot.rc.channels
    channels[:8] = [1001 + k for k in range(8)]
    assert copter.autopilot.throttle_pulse() == 1003
    copter.vehicle.parameters["RCMAP_THROTTLE"] = 5.0
    assert copter.autopilot.throttle_pulse() == 1005


@pytest.mark.parametrize("mode", range(28))
def test_a_copters_speed_is_set_where_it_flies_to_positions(copter: FirmwareBench, mode: int) -> None:
    """AUTO, GUIDED, GUIDED_NOGPS, RTL and SMART_RTL."""
    copter.ready()
    copter.vehicle.v.autopilot.modes.number = mode
    copter.vehicle.v.autopilot.modes.nav.mission_state = RUNNING
    for kind in (-1, 0, 1, 2, 3, 4):
        assert copter.autopilot.change_speed(kind, 2.0) is (mode in (3, 4, 20, 6, 21) and 0 <= kind <= 3), kind


@pytest.mark.parametrize(("frame_class", "motors"), [(1.0, 4), (2.0, 6), (3.0, 8)])
def test_a_frame_of_another_number_of_motors_is_said(copter: FirmwareBench, frame_class: float, motors: int) -> None:
    copter.vehicle.v.physics.airframe.rotor_count = 4
    copter.autopilot.take_notes()
    copter.vehicle.parameters["FRAME_CLASS"] = frame_class
    copter.autopilot.parameter_changed("FRAME_CLASS")
    said = [note.text for note in copter.autopilot.take_notes() if note.text.startswith("FRAME_CLASS")]
    assert said == (
        [] if motors == 4 else [f"FRAME_CLASS {frame_class:.0f} has {motors} motors, this vehicle 4 rotors"]
    )
    copter.vehicle.v.autopilot.arming.armed = 1
    copter.vehicle.parameters["FRAME_CLASS"] = 1.0
    copter.autopilot.parameter_changed("FRAME_CLASS")
    assert int(copter.vehicle.v.autopilot.control.motors.count) == motors, "not in flight"


def test_home_here_needs_a_position_and_stays(copter: FirmwareBench) -> None:
    copter.ready()
    ap = copter.vehicle.v.autopilot
    ap.estimate.position_ok, ap.estimate.pos = 0, (10.0, 0.0, 0.0)
    assert copter.autopilot.set_home_here() is False and not ap.home.locked and ap.home.lat == HOME[0]
    ap.estimate.position_ok = 1
    assert copter.autopilot.set_home_here() is True and bool(ap.home.locked) and ap.home.lat > HOME[0]


@pytest.mark.parametrize("second", [False, True])
def test_an_origin_is_that_of_each_filter_that_runs(copter: FirmwareBench, second: bool) -> None:
    ap = copter.vehicle.v.autopilot
    ap.second_lane.runs = second
    assert copter.autopilot.set_origin(*HOME)
    assert (ap.estimate.origin_lat, ap.estimate.origin_lon, ap.estimate.origin_alt) == HOME
    assert bool(ap.estimate.origin_set) and bool(ap.second_lane.estimate.origin_set) is second
    assert copter.autopilot.set_origin(HOME[0] + 1, *HOME[1:]) is False and ap.estimate.origin_lat == HOME[0], "once"


def test_sticks_of_a_rover_are_steering_and_throttle(rover: FirmwareBench) -> None:
    pilot = rover.vehicle.v.autopilot.modes.pilot
    pilot.steering, pilot.throttle = 0.25, -0.5
    autopilot: Any = rover.autopilot
    assert [autopilot.stick(motor) for motor in (1, 2, 3, 4)] == [-0.5, 0.25, -0.5, -0.5]


def test_a_rover_has_no_yaw_of_its_own_to_keep(rover: FirmwareBench) -> None:
    rover.ready()
    rover.vehicle.v.autopilot.modes.number = AUTO
    before = bytes(rover.vehicle.v._bytes)
    rover.autopilot.gripper_is(True, True)
    rover.autopilot.set_roi((1.0, 2.0, 3.0))
    assert rover.autopilot.yaw_rate_target() == 0.0 and bytes(rover.vehicle.v._bytes) == before


def test_a_rover_without_gps_in_its_filter_needs_a_position(rover: FirmwareBench) -> None:
    """There is none to fall back to then (AHRS_GPS_USE 0)."""
    texts = [f"Arm: {TEXTS[AHRS_TYPE]}", "Arm: other"]
    autopilot: Any = rover.autopilot
    assert autopilot._worded(texts) == texts
    rover.vehicle.parameters["AHRS_GPS_USE"] = 0.0
    assert autopilot._worded(texts) == [f"Arm: {TEXTS[NEED_POSITION]}", "Arm: other"]


def test_some_parameters_count_at_the_moment_of_arming_alone(copter: FirmwareBench) -> None:
    autopilot: Any = copter.autopilot
    autopilot._found = [SimpleNamespace(text=text, when_arming=text == "then") for text in ("always", "then")]
    assert autopilot._parameter_texts(False, "PreArm: ") == ["PreArm: always"]
    assert autopilot._parameter_texts(True, "Arm: ") == ["Arm: always", "Arm: then"]


# ---------------------------------------------------------------- parameters that keep it from arming

WRONG, THEN, WARNS = Found("wrong", False, True), Found("then", True, True), Found("warns", False, False)


def wrong(
    bench: FirmwareBench, monkeypatch: pytest.MonkeyPatch, *found: Found, ok: bool = True, failed: int = 0
) -> Any:
    """Its laws of arming say ``ok``, and that these checks have ``failed``."""
    monkeypatch.setattr("sitl.bridge.base_autopilot.parameter_checks.look", lambda subject, checks: list(found))
    autopilot: Any = bench.autopilot
    autopilot._arming = SimpleNamespace(
        arm=lambda v, method, force: (ok, ["said"]), check=lambda v: failed,
        texts=lambda v, bits, prefix: [f"{prefix}{bits}"],
    )  # fmt: skip
    autopilot.check_parameters()
    return autopilot


@pytest.mark.parametrize(
    ("found", "bits"),
    [((), 0), ((WRONG,), PARAMETERS_BAD), ((THEN,), SWITCHES_BAD), ((WARNS,), 0),
     ((WARNS, THEN, WRONG), PARAMETERS_BAD | SWITCHES_BAD)],
)  # fmt: skip
@pytest.mark.parametrize("needs_location", [0.0, 1.0])
def test_the_core_knows_what_is_wrong_with_parameters(
    copter: FirmwareBench, monkeypatch: pytest.MonkeyPatch, found: Any, bits: int, needs_location: float
) -> None:
    copter.vehicle.parameters["ARMING_NEED_LOC"] = needs_location
    calibrated = copter.vehicle.v.autopilot.calibrated
    every = PARAMETERS_BAD | SWITCHES_BAD | NEEDS_LOCATION
    other = 1 << 20
    for before in (0, every):
        calibrated.state = before | other
        wrong(copter, monkeypatch, *found)
        assert calibrated.state == other | bits | (NEEDS_LOCATION if needs_location else 0)


@pytest.mark.parametrize(
    ("ok", "force", "failed", "said"),
    [
        (False, False, 0, ["said", "Arm: wrong", "Arm: then", "Arm: warns"]),
        (False, False, 1, ["said", "Arm: wrong", "Arm: warns"]),
        (True, False, 0, ["Arm: warns"]), (True, True, 0, ["said"]), (False, True, 0, ["said"]),
    ],
)  # fmt: skip
def test_what_is_said_at_arming(
    rover: FirmwareBench, monkeypatch: pytest.MonkeyPatch, ok: bool, force: bool, failed: int, said: list[str]
) -> None:
    autopilot = wrong(rover, monkeypatch, WRONG, THEN, WARNS, ok=ok, failed=failed)
    assert autopilot.arm(force) == ok
    assert [(note.severity, note.text) for note in autopilot.take_notes()] == [(2, text) for text in said]
    assert autopilot.take_notes() == []


@pytest.mark.parametrize(
    ("found", "failed", "said"),
    [
        ((), 0, []), ((WRONG,), 0, []), ((WARNS, THEN), 0, ["warns"]), ((WRONG, THEN), PARAMETERS, ["wrong"]),
        ((WRONG,), PARAMETERS - 1 & ~PARAMETERS, []),
    ],
)  # fmt: skip
def test_what_is_said_before_arming(
    rover: FirmwareBench, monkeypatch: pytest.MonkeyPatch, found: Any, failed: int, said: list[str]
) -> None:
    """Parameters are named where their check has failed, or where one of them warns only."""
    autopilot = wrong(rover, monkeypatch, *found, failed=failed)
    autopilot.run_prearm_checks()
    assert [note.text for note in autopilot.take_notes()] == [f"PreArm: {text}" for text in (failed, *said)]
    assert autopilot.prearm_texts(rover.vehicle.v) == [str(failed), *said]


@pytest.mark.parametrize(
    ("failed", "now", "said"), [(PARAMETERS, 0, ["wrong", "then"]), (PARAMETERS, 1, ["wrong"]), (0, 0, [])]
)
def test_refusals_name_what_counts_at_that_moment(
    rover: FirmwareBench, monkeypatch: pytest.MonkeyPatch, failed: int, now: int, said: list[str]
) -> None:
    autopilot = wrong(rover, monkeypatch, WRONG, THEN, failed=now)
    assert autopilot.refusal_texts(failed) == [f"Arm: {text}" for text in (failed, *said)]


# ---------------------------------------------------------------- the rest of what services ask


def test_modes_that_ground_stations_may_not_choose(copter: FirmwareBench) -> None:
    copter.ready()
    autopilot, events = copter.autopilot, copter.vehicle.v.autopilot.events
    copter.vehicle.parameters["FLTMODE_GCSBLOCK"] = float(1 << 3 | 1 << 4)  # AUTO and GUIDED
    before = events.count
    assert autopilot.set_mode(4) and events.count == before, "it is in GUIDED already"
    assert not autopilot.set_mode(3) and not autopilot.go_back(1) and autopilot.mode() == 4
    assert [(int(events.code[k]), float(events.a[k])) for k in range(before, events.count)] == 2 * [(MODE_REFUSED, 3.0)]


@pytest.mark.parametrize(("mode", "done"), [(4, True), (3, False), (5, False)])
def test_who_cannot_pause_says_so(copter: FirmwareBench, mode: int, done: bool) -> None:
    """In GUIDED, and in AUTO on the way to somewhere; a rest goes on in AUTO."""
    copter.vehicle.v.autopilot.modes.number = mode
    assert copter.autopilot.pause(True) == done
    assert copter.autopilot.pause(False) == (mode != 5)
    texts = ["Failed to pause"] * (not done) + ["Failed to resume"] * (mode == 5)
    assert [(note.severity, note.text) for note in copter.autopilot.take_notes()] == [(6, text) for text in texts]


def test_noses_batteries_sources_and_tags(copter: FirmwareBench) -> None:
    copter.ready()
    autopilot, ap = copter.autopilot, copter.vehicle.v.autopilot
    autopilot.set_roi((1.0, 2.0, -3.0))
    assert (ap.modes.auto_yaw.mode, tuple(ap.modes.auto_yaw.roi)) == (ROI, (1.0, 2.0, -3.0))
    autopilot.set_roi(None)
    assert ap.modes.auto_yaw.mode != ROI
    autopilot.choose_sources(2)
    assert ap.ekf.source_set == ap.second_lane.ekf.source_set == 2
    assert not autopilot.set_battery_left(50.0)
    ap.params.BATT.MONITOR, ap.params.BATT.CAPACITY = 4.0, 3300.0
    assert autopilot.set_battery_left(50.0) and ap.battery.consumed_mah == 1650.0
    items = (*SQUARE, MissionItem(600, 0, p1=7.0), SQUARE[2], MissionItem(600, 0, p1=8.0))
    assert autopilot.replace_mission(items) == 0 and not autopilot.jump_to_tag(9) and autopilot.current_item() == 0
    assert autopilot.jump_to_tag(8) and autopilot.current_item() == 5
    assert autopilot.replace_mission((SQUARE[0], MissionItem(9999))) != 0 and len(autopilot.mission_items()) == 6


def test_switches_are_run_and_what_they_say_is_said(copter: FirmwareBench) -> None:
    ran: list[tuple[int, int]] = []
    note = SimpleNamespace(severity=6, text="done")
    copter.vehicle.aux = SimpleNamespace(
        run=lambda number, position: ran.append((number, position)) or (number == 9, [note])
    )
    assert copter.autopilot.run_aux_function(9, 2) is True and copter.autopilot.run_aux_function(8, 0) is False
    assert ran == [(9, 2), (8, 0)] and copter.autopilot.take_notes() == [note, note]


@pytest.mark.parametrize(
    ("mode", "submode", "waits"), [(AUTO, GUIDED_IN_MISSION, True), (AUTO, ON_PATH, False), (GUIDED, 0, False)]
)
def test_missions_of_a_rover_that_wait_for_set_points(
    rover: FirmwareBench, mode: int, submode: int, waits: bool
) -> None:
    modes = rover.vehicle.v.autopilot.modes
    modes.number, modes.auto.submode = mode, submode
    assert rover.autopilot.is_guided_in_auto() == waits
    assert not rover.autopilot.change_reposition_speed(-1.0)
