# SPDX-License-Identifier: BSD-3-Clause
"""Gripper, winch and sprayer: answers, texts and pulses are those of a real ArduPilot with the same parameters."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.aux_switch import HIGH, LOW, MIDDLE
from sitl.autopilot.mission.item import MissionItem
from sitl.bridge.services.camera import CameraService
from sitl.bridge.services.gripper import GripperService
from sitl.bridge.services.outputs import OutputService
from sitl.bridge.services.parachute import ParachuteService
from sitl.bridge.services.sprayer import SprayerService
from sitl.core.mavlink import MavCmd
from sitl.core.vectors import Vec3
from tests.bridge.fakes import Bench, FakeRover, FakeVehicle

ACCEPTED, UNSUPPORTED, FAILED = 0, 3, 4
GRIPPER, SPRAYER, WINCH, REQUEST = MavCmd.DO_GRIPPER, MavCmd.DO_SPRAYER, MavCmd.DO_WINCH, 512


class Fitted(Bench):
    """With a second client that hears texts."""

    def __init__(self, vehicle: FakeVehicle) -> None:
        super().__init__(vehicle)
        self.ear = self.connect(system=254)


def bench(vehicle: FakeVehicle | None = None, **params: float) -> Fitted:
    """A vehicle on the ground, with these parameters at boot."""
    vehicle = vehicle or FakeVehicle()
    vehicle.locate()
    vehicle.parameters.update(params)
    return Fitted(vehicle)


def pulse(b: Bench, output: int = 9) -> int | None:
    """The last pulse of an output."""
    found: list[Any] = [call[2] for call in b.autopilot.calls if call[:2] == ("set_servo", output)]
    return int(found[-1]) if found else None


BOOT = ("Barometer 1 calibration complete", "ArduPilot Ready")


def texts(b: Fitted, seconds: float = 0.0) -> list[str]:
    """What was said since the last call and is said in the next seconds, but for booting."""
    b.run(seconds)
    b.bridge.flush()
    return [m.text for m in b.ear.receive("STATUSTEXT") if m.text not in BOOT]


GRIP = {"GRIP_ENABLE": 1.0, "GRIP_TYPE": 1.0, "SERVO9_FUNCTION": 28.0}


@pytest.mark.parametrize("vehicle", [FakeVehicle, FakeRover])
def test_a_gripper_closes_and_opens(vehicle: type[FakeVehicle]) -> None:
    b = bench(vehicle(), **GRIP)
    assert (pulse(b), texts(b, 3.0)) == (1500, [])
    assert b.command(GRIPPER, 1, 0) == ACCEPTED
    assert (texts(b, 1.0), pulse(b)) == (["Gripper load releasing", "Gripper load released"], 1100)
    assert b.command(GRIPPER, 1, 0) == ACCEPTED
    assert texts(b) == ["Gripper load released"]
    assert b.command(GRIPPER, 1, 1) == ACCEPTED
    assert (texts(b, 0.45), pulse(b)) == (["Gripper load grabbing"], 1900)
    assert texts(b, 0.1) == ["Gripper load grabbed"]
    assert b.command(GRIPPER, 2, 0.7) == ACCEPTED  # whole numbers, any gripper
    assert (texts(b, 1.0), pulse(b)) == (["Gripper load releasing", "Gripper load released"], 1100)
    assert b.command(GRIPPER, 1, 2) == FAILED == b.command(GRIPPER, 1, -0.5)
    b.vehicle.parameters["GRIP_ENABLE"] = 0.0
    assert b.command(GRIPPER, 1, 1) == FAILED
    b.bridge.switched(19, HIGH)
    assert (texts(b, 1.0), pulse(b)) == ([], 1100)


def test_a_gripper_by_switch_and_by_mission_closes_by_itself() -> None:
    b = bench(**GRIP, GRIP_AUTOCLOSE=3.0, GRIP_RELEASE=1300.0, GRIP_GRAB=1700.0)
    texts(b, 3.0)
    b.bridge.switched(19, HIGH)
    b.bridge.switched(19, MIDDLE)
    assert (texts(b, 1.0), pulse(b)) == (["Gripper load grabbing", "Gripper load grabbed"], 1700)
    b.bridge.carry_out(MissionItem(GRIPPER, p1=1.0, p2=0.0))
    told = ["Gripper load releasing", "Gripper Released", "Gripper load released"]
    assert (texts(b, 2.9), pulse(b)) == (told, 1300)
    assert (texts(b, 1.0), pulse(b)) == (["Gripper load grabbing", "Gripper load grabbed"], 1700)


def test_an_electromagnet_rests_after_each_order_and_grabs_again() -> None:
    b = bench(**{**GRIP, "GRIP_TYPE": 2.0}, GRIP_REGRAB=3.0)
    texts(b, 3.0)
    assert b.command(GRIPPER, 1, 0) == ACCEPTED
    assert (texts(b, 0.4), pulse(b)) == (["Gripper load releasing"], 1100)
    assert (texts(b, 4.0), pulse(b)) == ([], 1500)
    assert b.command(GRIPPER, 1, 1) == ACCEPTED
    assert (texts(b, 0.4), pulse(b)) == (["Gripper load grabbing"], 1900)
    assert (texts(b, 2.0), pulse(b)) == ([], 1500)
    assert (texts(b, 0.8), pulse(b)) == (["Gripper load grabbing"], 1900)


def test_missions_tell_of_a_gripper_that_is_not_there() -> None:
    b = bench()
    for action in (1.0, 0.0):
        b.bridge.carry_out(MissionItem(GRIPPER, p1=1.0, p2=action))
    assert texts(b) == ["Gripper Grabbed", "Gripper Released"]


def test_the_autopilot_knows_what_the_gripper_does() -> None:
    """Missions that place a load wait for it: whether it is there, and whether it is open."""
    b = bench(**GRIP)

    def told() -> tuple[bool, bool]:
        found = [call[1:] for call in b.autopilot.calls if call[0] == "gripper_is"]
        return found[-1]

    assert told() == (True, False)
    b.command(GRIPPER, 1, 0)
    texts(b, 0.4)
    assert told() == (True, False), "it moves"
    texts(b, 0.2)
    assert told() == (True, True)
    b.command(GRIPPER, 1, 1)
    assert told() == (True, False)
    b.vehicle.parameters["GRIP_ENABLE"] = 0.0
    b.bridge.parameter_changed("GRIP_ENABLE")
    assert told() == (False, False)


def test_without_payload() -> None:
    b, r = bench(), bench(FakeRover())
    assert (b.command(GRIPPER, 1, 1), r.command(GRIPPER, 1, 1)) == (FAILED, FAILED)
    assert (b.command(WINCH, 1, 1, 1), r.command(WINCH, 1, 1, 1)) == (FAILED, UNSUPPORTED)
    assert (b.command(SPRAYER, 1), r.command(SPRAYER, 1)) == (ACCEPTED, ACCEPTED)
    for number in (15, 19, 44, 45):
        b.bridge.switched(number, HIGH)
    b.run(2.0)
    assert b.autopilot.calls == []
    assert b.command(REQUEST, 9005) == ACCEPTED  # as in ArduPilot, which sends nothing then


REEL = {"WINCH_TYPE": 1.0, "SERVO9_FUNCTION": 88.0}


def length(b: Bench) -> Any:
    """WINCH_STATUS."""
    (m,) = b.telemetry("WINCH_STATUS")
    return m


def test_a_winch_lowers_and_raises_by_a_length() -> None:
    b = bench(**REEL)
    assert pulse(b) is None
    assert b.command(WINCH, 1, 1, 5, 0.5) == ACCEPTED
    assert texts(b, 1.0) == ["Winch: lowering  5.0m to  5.0m"]
    assert (length(b).line_length, length(b).speed, pulse(b)) == (pytest.approx(1.0, abs=0.03), 1.0, 1900)
    b.run(3.55)
    assert length(b).line_length == pytest.approx(4.42, abs=0.03)  # the real one after 4.55 s
    assert length(b).speed == pytest.approx(0.59, abs=0.02)
    b.run(7.0)
    assert (length(b).line_length, pulse(b)) == (pytest.approx(5.0, abs=0.01), 1500)
    assert (length(b).status, length(b).temperature) == (1, 32767)
    assert math.isnan(length(b).tension)
    assert b.command(WINCH, 1, 1, -3, 0) == ACCEPTED
    assert texts(b, 1.0) == ["Winch: raising  3.0m to  2.0m"]
    assert pulse(b) == 1100


def test_a_winch_winds_at_a_rate() -> None:
    b = bench(**REEL, WINCH_RATE_MAX=2.0)
    assert b.command(WINCH, 1, 2, 0, -1.4) == ACCEPTED
    b.run(1.0)
    assert (length(b).line_length, pulse(b)) == (pytest.approx(-1.4, abs=0.05), 1220)
    assert b.command(WINCH, 1, 2, 0, 5) == ACCEPTED
    b.run(0.1)
    assert (length(b).speed, pulse(b)) == (2.0, 1900)
    b.bridge.switched(45, LOW)
    b.run(0.1)
    assert (length(b).speed, pulse(b)) == (-2.0, 1100)
    b.bridge.switched(45, MIDDLE)
    b.run(0.1)
    assert (length(b).speed, pulse(b)) == (0.0, 1500)
    b.bridge.switched(44, MIDDLE)
    assert pulse(b) == 0
    b.bridge.switched(44, HIGH)
    b.run(0.1)
    assert pulse(b) == 1500
    assert b.command(WINCH, 1, 0) == ACCEPTED
    assert pulse(b) == 0
    assert b.command(WINCH, 1, 3) == FAILED


@pytest.mark.parametrize("most", [0.0, -1.0])
def test_a_winch_that_may_not_wind_holds_the_line(most: float) -> None:
    for act in ((2, 0, 1.5), (1, 5, 0.5)):
        b = bench(**REEL, WINCH_RATE_MAX=most)
        assert b.command(WINCH, 1, *act) == ACCEPTED
        b.run(1.0)
        assert (length(b).line_length, length(b).speed, pulse(b)) == (0.0, 0.0, 1500)


@pytest.mark.parametrize("by, taken", [(32767.0, True), (-32767.0, True), (32768.0, False)])
def test_a_winch_has_so_much_line(by: float, taken: bool) -> None:
    assert bench(**REEL).command(WINCH, 1, 1, by, 0) == (ACCEPTED if taken else FAILED)


SPRAY = {"SPRAY_ENABLE": 1.0, "SERVO9_FUNCTION": 22.0, "SERVO10_FUNCTION": 23.0}


def moving(b: Bench, speed: float) -> None:
    """Over the ground [m/s]."""
    b.vehicle.v.autopilot.estimate.vel = Vec3(speed, 0.0, -3.0)


def test_a_sprayer_follows_the_speed_over_the_ground() -> None:
    b = bench(**SPRAY)
    b.vehicle.v.autopilot.arming.armed = True
    b.run(1.0)
    assert pulse(b) is None
    assert b.command(SPRAYER, 1) == ACCEPTED
    b.run(2.0)
    assert (pulse(b), pulse(b, 10)) == (1100, 1100)  # below SPRAY_SPEED_MIN
    for speed, wanted in ((9.1, 1828), (4.03, 1422), (12.0, 1900)):
        moving(b, speed)
        b.run(1.0)
        assert (pulse(b), pulse(b, 10)) == (wanted, 1300)
    moving(b, 0.5)
    b.run(0.8)
    assert (pulse(b), pulse(b, 10)) == (1140, 1300)
    b.run(1.0)
    assert (pulse(b), pulse(b, 10)) == (1100, 1100)
    moving(b, 5.0)
    b.run(1.0)
    b.bridge.carry_out(MissionItem(SPRAYER, p1=0.0))
    assert (pulse(b), pulse(b, 10)) == (1100, 1100)


def test_a_switch_tests_the_sprayer_of_a_disarmed_vehicle() -> None:
    b = bench(**SPRAY, SPRAY_PUMP_MIN=30.0, SPRAY_SPINNER=1600.0)
    b.bridge.switched(15, LOW)
    b.run(1.0)
    assert pulse(b) is None
    b.bridge.switched(15, HIGH)
    b.run(1.0)
    assert (pulse(b), pulse(b, 10)) == (1340, 1600)
    b.bridge.switched(15, LOW)
    assert (pulse(b), pulse(b, 10)) == (1100, 1100)


@pytest.mark.parametrize(
    ("params", "command", "values"),
    [(GRIP, GRIPPER, (1, 1)), (REEL, WINCH, (1, 1, 4, 1)), (SPRAY, SPRAYER, (1,))],
)
def test_what_it_does_is_in_a_snapshot(params: dict[str, float], command: int, values: tuple[float, ...]) -> None:
    b = bench(**params)
    moving(b, 3.0)
    b.run(3.0)
    b.command(command, *values)
    texts(b, 0.2)
    before, time_us = b.bridge.snapshot(), int(b.vehicle.v.time_us)
    b.autopilot.calls.clear()
    b.run(3.0)
    calls, said = list(b.autopilot.calls), texts(b)
    b.bridge.restore(before)
    b.vehicle.v.time_us = time_us
    b.autopilot.calls.clear()
    b.run(3.0)
    assert (b.autopilot.calls, texts(b)) == (calls, said)
    assert calls or said


# ---------------------------------------------------------------- switches


class Acts:
    """A service that keeps what it was asked for."""

    def __init__(self) -> None:
        self.asked: list[tuple[Any, ...]] = []

    def __getattr__(self, name: str) -> Any:
        return lambda *arguments: self.asked.append((name, *arguments))


@pytest.mark.parametrize(
    ("function", "position", "service", "asked"),
    [
        (28, HIGH, OutputService, [("set_relay", 0, 1.0)]), (28, LOW, OutputService, [("set_relay", 0, 0.0)]),
        (28, MIDDLE, OutputService, []), (34, HIGH, OutputService, [("set_relay", 1, 1.0)]),
        (35, HIGH, OutputService, [("set_relay", 2, 1.0)]), (36, HIGH, OutputService, [("set_relay", 3, 1.0)]),
        (66, HIGH, OutputService, [("set_relay", 4, 1.0)]), (67, LOW, OutputService, [("set_relay", 5, 0.0)]),
        (21, HIGH, ParachuteService, [("switched", 21, HIGH)]), (22, LOW, ParachuteService, [("switched", 22, LOW)]),
        (23, MIDDLE, ParachuteService, [("switched", 23, MIDDLE)]),
        (19, HIGH, GripperService, [("grab",)]), (19, LOW, GripperService, [("release",)]),
        (19, MIDDLE, GripperService, []), (15, HIGH, SprayerService, [("run", True, True)]),
        (15, MIDDLE, SprayerService, [("run", False, True)]), (15, LOW, SprayerService, [("run", False, True)]),
        (9, HIGH, CameraService, [("take_picture",)]), (9, MIDDLE, CameraService, []), (9, LOW, CameraService, []),
    ],
)  # fmt: skip
def test_what_is_fitted_follows_its_switch(function: int, position: int, service: Any, asked: Any) -> None:
    """Functions of ArduPilot's RCn_OPTION: 28, 34, 35, 36, 66, 67 relays 1 to 6, 21 to 23 parachute, 19 gripper,
    15 sprayer, 9 camera."""
    b, acts = bench(), Acts()
    b.bridge.services[service] = acts  # type: ignore[assignment]
    b.bridge.switched(function, position)
    assert acts.asked == asked


@pytest.mark.parametrize(
    ("p1", "p2", "asked"),
    [
        (41, 0, [(41, LOW)]), (41, 1, [(41, MIDDLE)]), (41, 2, [(41, HIGH)]), (41, 3, []), (41, -1, []),
        (300.0, 2.0, [(300, HIGH)]),
    ],
)  # fmt: skip
def test_a_mission_moves_a_switch(p1: float, p2: float, asked: Any) -> None:
    b = bench()
    b.bridge.carry_out(MissionItem(MavCmd.DO_AUX_FUNCTION, p1=p1, p2=p2))
    assert [call[1:] for call in b.autopilot.calls if call[0] == "run_aux_function"] == asked


# ---------------------------------------------------------------- times and ends


@pytest.mark.parametrize("params", [{"GRIP_ENABLE": 0.0}, {"GRIP_TYPE": 0.0}, {"GRIP_TYPE": 3.0}])
def test_a_gripper_that_is_not_there_at_boot_is_not_there_later(params: dict[str, float]) -> None:
    b = bench(**{**GRIP, **params})
    b.vehicle.parameters.update({"GRIP_ENABLE": 1.0, "GRIP_TYPE": 1.0})
    assert b.command(GRIPPER, 1, 1) == FAILED and pulse(b) is None
    assert bench(**GRIP).command(GRIPPER, 1, -0.5) == FAILED


def test_a_gripper_moves_for_half_a_second_and_closes_in_time() -> None:
    b = bench(**GRIP, GRIP_AUTOCLOSE=2.0)
    texts(b, 3.0)
    assert b.command(GRIPPER, 1, 0) == ACCEPTED
    assert (texts(b, 0.4975), texts(b, 0.0025)) == (["Gripper load releasing"], ["Gripper load released"])
    assert (texts(b, 1.4975), texts(b, 0.0025)) == ([], ["Gripper load grabbing"])
    assert (texts(b, 0.4975), texts(b, 0.0025)) == ([], ["Gripper load grabbed"])
    assert texts(b, 5.0) == [], "it stays closed"


@pytest.mark.parametrize(("regrab", "again"), [(0.0, []), (-1.0, []), (2.0, ["Gripper load grabbing"])])
def test_an_electromagnet_grabs_again_at_its_interval(regrab: float, again: list[str]) -> None:
    b = bench(**{**GRIP, "GRIP_TYPE": 2.0}, GRIP_REGRAB=regrab)
    texts(b, 3.0)
    assert b.command(GRIPPER, 1, 1) == ACCEPTED
    assert (texts(b, 1.9975), texts(b, 0.0025)) == (["Gripper load grabbing"], again)


def test_missions_wind_and_what_is_let_go_stands() -> None:
    b = bench(**REEL)
    assert (length(b).line_length, length(b).speed, length(b).time_usec) == (0.0, 0.0, 0)
    b.bridge.carry_out(MissionItem(WINCH, p1=1.0, p2=2.0, p3=7.0, p4=0.5))
    b.run(1.0)
    assert (length(b).speed, length(b).time_usec) == (0.5, 1_000_000)
    assert length(b).line_length == pytest.approx(0.5), "fifty steps a second"
    b.bridge.carry_out(MissionItem(WINCH, p1=1.0, p2=0.0))
    assert (length(b).speed, pulse(b)) == (0.0, 0)
    b.run(1.0)
    assert (length(b).line_length, length(b).speed, pulse(b)) == (pytest.approx(0.5), 0.0, 0)
    assert b.command(WINCH, 1, 1, 0, 0) == ACCEPTED and texts(b)[-1] == "Winch: raising  0.0m to  0.5m"


@pytest.mark.parametrize(("speed", "sprays"), [(1.0, True), (0.99, False)])
def test_a_sprayer_begins_at_its_least_speed(speed: float, sprays: bool) -> None:
    b = bench(**SPRAY, SPRAY_SPEED_MIN=100.0)
    b.vehicle.v.autopilot.arming.armed = True
    moving(b, speed)
    assert b.command(SPRAYER, 2) == ACCEPTED
    b.run(2.0)
    assert pulse(b, 10) is None, "neither on nor off"
    assert b.command(SPRAYER, 1) == ACCEPTED
    b.run(0.6)
    assert pulse(b, 10) == 1100, "a tenth of a second after the first look"
    b.run(0.1)
    assert pulse(b, 10) == (1300 if sprays else 1100)


@pytest.mark.parametrize(("armed", "pumped"), [(False, 1180), (True, 1100)])
def test_a_test_of_the_sprayer_is_as_at_one_metre_a_second_and_of_a_disarmed_vehicle(armed: bool, pumped: int) -> None:
    b = bench(**SPRAY, SPRAY_PUMP_MIN=2.0, SPRAY_PUMP_RATE=10.0)
    b.vehicle.v.autopilot.arming.armed = armed
    b.bridge.switched(15, HIGH)
    b.run(2.0)
    assert pulse(b) == pumped


def test_a_sprayer_that_gets_too_slow_goes_on_for_a_second() -> None:
    b = bench(**SPRAY)
    b.vehicle.v.autopilot.arming.armed = True
    moving(b, 5.0)
    b.command(SPRAYER, 1)
    b.run(1.7)
    moving(b, 0.0)
    b.run(1.2)
    assert pulse(b, 10) == 1300
    b.run(0.2)
    assert pulse(b, 10) == 1100
