# SPDX-License-Identifier: BSD-3-Clause
"""Knobs of the transmitter (TUNE, TUNE2)."""

from __future__ import annotations

from typing import Any

import pytest

from sitl.autopilot.copter.parameters import TABLE
from sitl.bridge.services.tuning import TUNED, TuningService
from sitl.core.constants import NEVER
from tests.bridge.fakes import Bench, FakeRover, FakeVehicle

KNOB = {"RC6_OPTION": 219.0, "RC6_MIN": 1100.0, "RC6_MAX": 1300.0, "TUNE_MIN": 100.0, "TUNE_MAX": 500.0}


def bench(**params: float) -> Bench:
    vehicle = FakeVehicle()
    vehicle.parameters.update(params)
    vehicle.v.autopilot.rc.receiver_ok = True
    return Bench(vehicle)


def turn(b: Bench, channel: int, pulse: int) -> None:
    b.vehicle.v.autopilot.rc.channels[channel - 1] = pulse
    b.run(0.4)


def calls(b: Bench, name: str) -> list[tuple[Any, ...]]:
    return [call[1:] for call in b.autopilot.calls if call[0] == name]


@pytest.mark.parametrize(("pulse", "turned", "value"), ((1100, 0, 100), (1200, 0, 300), (1900, 0, 500), (1100, 1, 500)))
def test_a_knob_sets_a_parameter_between_its_ends(pulse: int, turned: int, value: float) -> None:
    b = bench(**KNOB, TUNE=60.0, RC6_REVERSED=float(turned))
    turn(b, 6, pulse)
    assert b.vehicle.parameters["LOIT_SPEED"] == value
    assert calls(b, "parameter_changed") == [("LOIT_SPEED",)]


ARDUPILOTS = {
    1: "ATC_ANG_RLL_P ATC_ANG_PIT_P", 3: "ATC_ANG_YAW_P", 4: "ATC_RAT_RLL_P ATC_RAT_PIT_P",
    5: "ATC_RAT_RLL_I ATC_RAT_PIT_I", 6: "ATC_RAT_YAW_P", 7: "PSC_VELZ_P", 12: "PSC_POSXY_P", 14: "PSC_POSZ_P",
    21: "ATC_RAT_RLL_D ATC_RAT_PIT_D", 22: "PSC_VELXY_P", 25: "ACRO_RP_RATE", 26: "ATC_RAT_YAW_D", 28: "PSC_VELXY_I",
    34: "PSC_ACCZ_P", 35: "PSC_ACCZ_I", 36: "PSC_ACCZ_D", 39: "CIRCLE_RATE", 40: "ACRO_Y_RATE", 45: "ATC_INPUT_TC",
    46: "ATC_RAT_PIT_P", 47: "ATC_RAT_PIT_I", 48: "ATC_RAT_PIT_D", 49: "ATC_RAT_RLL_P", 50: "ATC_RAT_RLL_I",
    51: "ATC_RAT_RLL_D", 55: "MOT_YAW_HEADROOM", 56: "ATC_RAT_YAW_FLTE", 58: "SID_MAGNITUDE", 59: "PSC_ANGLE_MAX",
    60: "LOIT_SPEED",
}  # fmt: skip
"""Values of TUNE on ArduPilot's page about it, and what they tune."""


@pytest.mark.parametrize("tune", range(-1, 62))
def test_numbers_of_what_is_tuned_are_ardupilots(tune: int) -> None:
    names = [name for names in ARDUPILOTS.values() for name in names.split()]
    b = bench(**KNOB, TUNE=float(tune))
    before = {name: b.vehicle.parameters[name] for name in names}
    turn(b, 6, 1234)
    changed = {name for name in names if b.vehicle.parameters[name] != before[name]}
    assert changed == {*ARDUPILOTS.get(tune, "").split()}


def test_two_knobs_do_not_mind_each_other() -> None:
    b = bench(**KNOB, TUNE=60.0, RC7_OPTION=220.0, TUNE2=4.0, TUNE2_MIN=0.1, TUNE2_MAX=0.3)
    turn(b, 6, 1300)
    turn(b, 7, int(b.vehicle.parameters["RC7_MIN"]))
    values = b.vehicle.parameters
    assert [values["LOIT_SPEED"], *(values[name] for name in TUNED[4])] == pytest.approx([500.0, 0.1, 0.1])


def test_legs_get_another_speed_once_and_the_parameter_stays() -> None:
    b = bench(**KNOB, TUNE=10.0)
    before = b.vehicle.parameters["WPNAV_SPEED"]
    turn(b, 6, 1200)
    b.run(1.0)
    assert calls(b, "change_speed") == [(0, 3.0)] and b.vehicle.parameters["WPNAV_SPEED"] == before


@pytest.mark.parametrize("params", ({"TUNE": 0.0}, {"TUNE_MAX": 100.0}, {"RC6_OPTION": 0.0}))
def test_a_knob_that_is_for_nothing(params: dict[str, float]) -> None:
    b = bench(**{**KNOB, "TUNE": 60.0, **params})
    turn(b, 6, 1300)
    assert b.vehicle.parameters["LOIT_SPEED"] == 1250.0


def test_without_a_receiver_nothing_is_tuned() -> None:
    b = bench(**KNOB, TUNE=60.0)
    b.vehicle.v.autopilot.rc.receiver_ok = False
    turn(b, 6, 1300)
    assert b.vehicle.parameters["LOIT_SPEED"] == 1250.0


def test_a_knob_that_is_fitted_in_flight_and_a_rover_that_has_none() -> None:
    b = bench(**{**KNOB, "RC6_OPTION": 0.0}, TUNE=60.0)
    b.vehicle.parameters["RC6_OPTION"] = 219.0
    b.bridge.parameter_changed("RC6_OPTION")
    turn(b, 6, 1300)
    assert b.vehicle.parameters["LOIT_SPEED"] == 500.0
    Bench(FakeRover()).run(1.0)


def test_what_knobs_tune_is_there() -> None:
    assert all(TABLE[name].has_effect for names in TUNED.values() for name in names)


def test_knobs_are_read_on_whole_multiples_of_300_ms() -> None:
    b = bench(**KNOB, TUNE=60.0)
    service = b.bridge.get(TuningService)
    assert service.due_us == 300_000
    b.run(0.7)
    assert service.due_us == 900_000
    b.vehicle.parameters["TUNE"] = 0.0
    b.bridge.parameter_changed("TUNE")
    assert service.due_us == NEVER


@pytest.mark.parametrize(
    ("params", "pulse", "value"),
    [
        ({}, 0, 1250.0), ({}, 1, 100.0), ({"RC6_MAX": 1100.0}, 1300, 100.0), ({"RC6_MAX": 1000.0}, 1300, 100.0),
        ({"TUNE_MIN": 500.0, "TUNE_MAX": 100.0}, 1150, 400.0),
    ],
)  # fmt: skip
def test_pulses_and_ends_of_a_knob(params: dict[str, float], pulse: int, value: float) -> None:
    """Without a pulse nothing is tuned, and without a travel the knob is at its beginning."""
    b = bench(**KNOB | params, TUNE=60.0)
    turn(b, 6, pulse)
    assert b.vehicle.parameters["LOIT_SPEED"] == value


@pytest.mark.parametrize("channel", [1, 16])
def test_a_knob_may_be_on_any_channel(channel: int) -> None:
    ends = {f"RC{channel}_{name}": value for name, value in (("OPTION", 219.0), ("MIN", 1100.0), ("MAX", 1300.0))}
    b = bench(TUNE_MIN=100.0, TUNE_MAX=500.0, TUNE=60.0, **ends)
    b.vehicle.v.autopilot.rc.channels[channel - 1] = 1200
    b.run(0.2975)
    assert b.vehicle.parameters["LOIT_SPEED"] == 1250.0
    b.run(0.0025)
    assert b.vehicle.parameters["LOIT_SPEED"] == 300.0


def test_a_speed_that_is_refused_is_asked_for_again() -> None:
    b = bench(**KNOB, TUNE=10.0)
    b.autopilot.ok = False
    turn(b, 6, 1200)
    b.autopilot.ok = True
    b.run(0.7)
    assert calls(b, "change_speed") == [(0, 3.0)] * 2
    b.vehicle.parameters.update({"TUNE_MIN": -500.0, "TUNE_MAX": -100.0})
    b.run(0.3)
    assert calls(b, "change_speed")[-1] == (0, 0.0)
