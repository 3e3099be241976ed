# SPDX-License-Identifier: BSD-3-Clause
"""Functions of switches that do something to the vehicle at once."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.aux_switch import HIGH, LOW, MIDDLE
from sitl.autopilot.copter.modes import guided
from sitl.autopilot.notes import Text
from tests.bridge.fakes import Bench, FakeRover, FakeVehicle

STABILIZE, GUIDED, LOITER = 0, 4, 5
DISARM, ARM_OR_STOP, SAVE_TRIM, TRAINER, PAUSE = 81, 165, 5, 14, 178


def move(vehicle: FakeVehicle, number: int, position: int) -> list[Any]:
    """A switch is moved; what is told."""
    return vehicle.firmware.aux_functions[number].act(vehicle, position)  # type: ignore[arg-type]


@pytest.mark.parametrize("kind", [FakeVehicle, FakeRover])
def test_disarming(kind: type[FakeVehicle]) -> None:
    vehicle = kind()
    arming = vehicle.v.autopilot.arming
    arming.armed = True
    for position, armed in ((LOW, True), (MIDDLE, True), (HIGH, False)):
        move(vehicle, DISARM, position)
        assert bool(arming.armed) is armed


@pytest.mark.parametrize("kind", [FakeVehicle, FakeRover])
def test_arming_and_stopping_the_motors(kind: type[FakeVehicle]) -> None:
    vehicle = kind()
    vehicle.v.autopilot.params.ARMING.CHECK = 0.0
    arming = vehicle.v.autopilot.arming
    for position, stopped in ((LOW, True), (MIDDLE, False), (LOW, True), (HIGH, False)):
        move(vehicle, ARM_OR_STOP, position)
        assert bool(arming.emergency_stop) is stopped


def test_the_trim_of_the_sticks_is_saved() -> None:
    vehicle = FakeVehicle()
    ap = vehicle.v.autopilot
    ap.modes.number, ap.modes.pilot.roll, ap.modes.pilot.pitch = STABILIZE, 0.1, -0.9
    assert move(vehicle, SAVE_TRIM, MIDDLE) == []
    assert move(vehicle, SAVE_TRIM, HIGH) == [Text(6, "Trim saved")]
    assert pytest.approx(math.radians(4.5), rel=1e-6) == ap.params.AHRS.TRIM.X
    assert pytest.approx(math.radians(-10.0), rel=1e-6) == ap.params.AHRS.TRIM.Y
    ap.modes.number = LOITER
    assert move(vehicle, SAVE_TRIM, HIGH) == []
    ap.modes.number, ap.modes.pilot.throttle = STABILIZE, 0.2
    assert move(vehicle, SAVE_TRIM, HIGH) == []


def test_the_trainer_of_acro() -> None:
    vehicle = FakeVehicle()
    for position, trainer in ((LOW, 0.0), (MIDDLE, 1.0), (HIGH, 2.0)):
        move(vehicle, TRAINER, position)
        assert trainer == vehicle.v.autopilot.params.ACRO.TRAINER


def test_pausing() -> None:
    vehicle = FakeVehicle()
    modes = vehicle.v.autopilot.modes
    modes.number, modes.guided.submode = GUIDED, guided.POSITION
    assert move(vehicle, PAUSE, HIGH) == []
    assert modes.guided.paused
    assert move(vehicle, PAUSE, LOW) == []
    assert not modes.guided.paused
    modes.number = STABILIZE
    assert move(vehicle, PAUSE, HIGH) == [Text(4, "Flight Mode Pause failed")]
    assert move(vehicle, PAUSE, LOW) == []


@pytest.mark.parametrize(("number", "relay"), [(28, 1), (34, 2), (35, 3), (36, 4), (66, 5), (67, 6)])
def test_relays(number: int, relay: int) -> None:
    vehicle = FakeVehicle()
    vehicle.parameters.update({f"RELAY{relay}_FUNCTION": 1.0, f"RELAY{relay}_PIN": 3.0, f"RELAY{relay}_DEFAULT": 0.0})
    b = Bench(vehicle)
    for position, pins in ((HIGH, 8.0), (MIDDLE, 8.0), (LOW, 0.0)):
        b.bridge.report(move(vehicle, number, position))
        assert vehicle.parameters["SIM_PIN_MASK"] == pins


@pytest.mark.parametrize("kind", [FakeVehicle, FakeRover])
def test_functions_of_what_is_not_fitted_do_nothing(kind: type[FakeVehicle]) -> None:
    vehicle = kind()
    before = vehicle.fleet.tobytes()
    for number in (30, 62, 78, 100, 164):
        notes = move(vehicle, number, HIGH)
        assert notes[-1] == Text(6, f"Aux function {number} has no effect in this simulator")
    assert vehicle.fleet.tobytes() == before


def test_feed_forward() -> None:
    vehicle = FakeVehicle()
    for position, enabled in ((LOW, 0.0), (HIGH, 1.0)):
        assert move(vehicle, 26, position) == []
        assert enabled == vehicle.v.autopilot.params.ATC.RATE_FF_ENAB
