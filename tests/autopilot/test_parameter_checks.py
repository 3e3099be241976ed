# SPDX-License-Identifier: BSD-3-Clause
"""Arming checks of parameters, as ArduCopter and ArduRover 4.7 answer to the same values."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from sitl.autopilot.arming_checks import ArmingMethod
from sitl.autopilot.copter import arming as copter_arming
from sitl.autopilot.copter.event_list import EVENTS
from sitl.autopilot.copter.parameters import TABLE as COPTER
from sitl.autopilot.mission.item import MissionItem
from sitl.autopilot.mission.mission import Mission
from sitl.autopilot.notes import ChecksFailed
from sitl.autopilot.params.table import Values
from sitl.autopilot.rover.modes.guided import GUIDED
from sitl.autopilot.rover.parameters import TABLE as ROVER
from sitl.autopilot.sensor_calibration import NEEDS_LOCATION, PARAMETERS_BAD, SWITCHES_BAD
from sitl.bridge.base_autopilot import BaseAutopilot
from sitl.bridge.copter.autopilot import CopterAutopilot
from sitl.bridge.rover.autopilot import RoverAutopilot
from tests.autopilot.copter.steady_copter import make
from tests.autopilot.rover.modes.driven_rover import Rover


def copter() -> tuple[BaseAutopilot, Any]:
    v = make()
    v.physics.airframe.rotor_count = 4
    values = Values(COPTER, v.autopilot.params)
    vehicle = SimpleNamespace(v=v, parameters=values, sequencer=None, aux=None, mission=Mission())
    return CopterAutopilot(vehicle), vehicle


def rover() -> tuple[BaseAutopilot, Any]:
    v = Rover().v
    vehicle = SimpleNamespace(
        v=v, parameters=Values(ROVER, v.autopilot.params), sequencer=None, aux=None, mission=Mission()
    )
    return RoverAutopilot(vehicle), vehicle


def texts(autopilot: BaseAutopilot) -> list[str]:
    return [note.text for note in autopilot.take_notes()]


COPTER_ROWS: list[tuple[dict[str, float], str]] = [
    ({"FS_THR_VALUE": 900}, "Check FS_THR_VALUE"),
    ({"RC3_MIN": 980}, "Check FS_THR_VALUE"),
    ({"ANGLE_MAX": 500}, "Check ANGLE_MAX"),
    ({"ANGLE_MAX": 16000}, "Check ANGLE_MAX"),
    ({"ACRO_BAL_ROLL": -1}, "Check ACRO_BAL_ROLL/PITCH"),
    ({"ACRO_BAL_PITCH": 6}, "Check ACRO_BAL_ROLL/PITCH"),
    ({"ATC_ANG_RLL_P": 0}, "Check ACRO_BAL_ROLL/PITCH"),
    ({"PILOT_SPEED_UP": 0}, "Check PILOT_SPEED_UP"),
    ({"PSC_POSXY_P": -1}, "Bad parameter: PSC_POSXY_P must be > 0"),
    ({"PSC_ACCZ_I": 0}, "Bad parameter: PSC_ACCZ_I must be > 0"),
    ({"ATC_ANG_YAW_P": 0}, "Bad parameter: ATC_ANG_YAW_P must be > 0"),
    ({"ATC_RAT_RLL_I": 0}, "Bad parameter: ATC_RAT_RLL_I must be > 0"),
    ({"ATC_RAT_PIT_D": -1}, "Bad parameter: ATC_RAT_PIT_D must be >= 0"),
    ({"SERVO1_FUNCTION": 0}, "Motors: no SERVOx_FUNCTION set to Motor1"),
    ({"SERVO3_FUNCTION": -1}, "Motors: no SERVOx_FUNCTION set to Motor3"),
    ({"MOT_SPIN_MIN": 0.05}, "Motors: MOT_SPIN_ARM > MOT_SPIN_MIN"),
    ({"MOT_SPIN_MIN": 0.5}, "Motors: MOT_SPIN_MIN too high 0.50 > 0.3"),
    ({"MOT_PWM_MIN": 0}, "Motors: Check MOT_PWM_MIN and MOT_PWM_MAX"),
    ({"SERVO4_MIN": 1600}, "SERVO4_MIN is greater than SERVO4_TRIM"),
    ({"SERVO2_MAX": 1400}, "SERVO2_MAX is less than SERVO2_TRIM"),
    ({"RC5_OPTION": 32, "RC6_OPTION": 31}, "Interlock/E-Stop Conflict"),
    ({"WINCH_TYPE": -1}, "winch unhealthy"),
    ({"COMPASS_DEV_ID2": 0}, "Compass not calibrated"),
    ({"COMPASS_OFS_X": 0, "COMPASS_OFS_Y": 0, "COMPASS_OFS_Z": 0}, "Compass not calibrated"),
    ({"COMPASS_OFFS_MAX": 10}, "Compass offsets too high"),
    ({"COMPASS_PRIO2_ID": -1}, "Compass order change requires reboot"),
    ({"INS_ACC3OFFS_Y": 3.5}, "3D Accel calibration needed"),
    ({"BATT4_MONITOR": -1}, "Battery 4 unhealthy"),
    ({"RNGFND2_TYPE": 1}, "Rangefinder 2: Not Detected"),
    ({"MNT2_TYPE": 1}, "Mount: check TYPE"),
    ({"EK3_SRC2_YAW": 9}, "AHRS: Check EK3_SRC2_YAW"),
    (
        {"EK3_SRC3_YAW": 3, "COMPASS_USE": 0, "COMPASS_USE2": 0, "COMPASS_USE3": 0},
        "AHRS: EK3 sources require Compass",
    ),
    ({"EK3_SRC2_YAW": 3, "COMPASS_ENABLE": 0}, "AHRS: EK3 sources require Compass"),
    ({"EK3_SRC2_YAW": 6}, "AHRS: EK3 sources require VisualOdom"),
    ({"EK3_SRC2_YAW": 8, "GPS1_TYPE": 0}, "AHRS: EK3 sources require GPS"),
    ({"ARMING_MIS_ITEMS": 8}, "Missing mission item: takeoff"),
]
ROVER_ROWS: list[tuple[dict[str, float], str]] = [
    ({"SERVO1_FUNCTION": 0}, "check steering and throttle config"),
    ({"SERVO1_FUNCTION": 73}, "check skid steering config"),
    ({"SERVO3_MIN": 1600}, "SERVO3_MIN is greater than SERVO3_TRIM"),
    ({"COMPASS_DEV_ID": -1}, "Compass not calibrated"),
    ({"WP_SPEED": 0}, "WP_SPEED too low"),
]


def refused(made: tuple[BaseAutopilot, Any], params: dict[str, float]) -> list[str]:
    autopilot, vehicle = made
    for name, value in params.items():
        vehicle.parameters[name] = value
        autopilot.parameter_changed(name)
    texts(autopilot)
    autopilot.run_prearm_checks()
    said = texts(autopilot)
    assert not autopilot.arm(False)
    assert [text.removeprefix("Arm: ") for text in texts(autopilot)] == [text.removeprefix("PreArm: ") for text in said]
    return said


@pytest.mark.parametrize(("params", "text"), COPTER_ROWS)
def test_copter(params: dict[str, float], text: str) -> None:
    assert refused(copter(), params) == [f"PreArm: {text}"]


@pytest.mark.parametrize(("params", "text"), ROVER_ROWS)
def test_rover(params: dict[str, float], text: str) -> None:
    assert refused(rover(), params) == [f"PreArm: {text}"]


def test_wrong_motors_are_told_alone() -> None:
    autopilot, vehicle = copter()
    vehicle.v.time_us = 14_000_000
    autopilot.run_prearm_checks()
    assert texts(autopilot) == ["PreArm: Gyros inconsistent"]
    assert refused((autopilot, vehicle), {"MOT_PWM_MIN": 0}) == ["PreArm: Motors: Check MOT_PWM_MIN and MOT_PWM_MAX"]


@pytest.mark.parametrize("make_autopilot", (copter, rover))
def test_a_good_vehicle_has_none(make_autopilot: Any) -> None:
    autopilot, vehicle = make_autopilot()
    autopilot.run_prearm_checks()
    assert texts(autopilot) == [] and int(vehicle.v.autopilot.calibrated.state) == 0
    assert autopilot.arm(False)


def test_the_core_knows_and_a_switch_is_refused_too() -> None:
    autopilot, vehicle = copter()
    v = vehicle.v
    vehicle.parameters["ANGLE_MAX"] = 500.0
    autopilot.parameter_changed("ANGLE_MAX")
    assert v.autopilot.calibrated.state == PARAMETERS_BAD
    assert copter_arming.try_arm(v, ArmingMethod.SWITCH, False) != 0
    events = v.autopilot.events
    at = int(events.count) - 1
    (note,) = EVENTS[int(events.code[at])].notes(v, float(events.a[at]), float(events.b[at]))
    assert isinstance(note, ChecksFailed) and autopilot.refusal_texts(note.failed) == ["Arm: Check ANGLE_MAX"]
    vehicle.parameters["ANGLE_MAX"] = 3000.0
    autopilot.parameter_changed("ANGLE_MAX")
    assert v.autopilot.calibrated.state == 0
    assert copter_arming.try_arm(v, ArmingMethod.SWITCH, False) == 0


@pytest.mark.parametrize(
    ("checks", "params", "armed"),
    (
        (0, {"ANGLE_MAX": 500}, True),
        (64, {"ANGLE_MAX": 500}, True),
        (32, {"ANGLE_MAX": 500}, False),
        (0, {"MOT_SPIN_MIN": 0.05}, False),
        (0, {"SERVO2_MIN": 1600}, True),
        (64, {"SERVO2_MIN": 1600}, False),
        (32, {"MNT2_TYPE": 1}, True),
        (1 << 16, {"MNT2_TYPE": 1}, False),
    ),
)
def test_arming_check_chooses(checks: int, params: dict[str, float], armed: bool) -> None:
    autopilot, vehicle = copter()
    for name, value in {"ARMING_CHECK": checks, **params}.items():
        vehicle.parameters[name] = value
        autopilot.parameter_changed(name)
    assert autopilot.arm(False) == armed


@pytest.mark.parametrize(
    ("params", "text"),
    (
        ({"RC6_OPTION": 9, "RC7_OPTION": 9}, "Duplicate Aux Switch Options"),
        ({"RC5_OPTION": 153}, "Mode channel and RC5_OPTION conflict"),
    ),
)
def test_switches_count_when_arming(params: dict[str, float], text: str) -> None:
    autopilot, vehicle = copter()
    for name, value in params.items():
        vehicle.parameters[name] = value
        autopilot.parameter_changed(name)
    texts(autopilot)
    autopilot.run_prearm_checks()
    assert texts(autopilot) == []
    assert vehicle.v.autopilot.calibrated.state == SWITCHES_BAD
    assert not autopilot.arm(False)
    assert texts(autopilot) == [f"Arm: {text}"]
    vehicle.v.autopilot.rc.receiver_ok = False
    assert autopilot.arm(False)


def test_an_action_that_is_gone_is_told_and_does_not_forbid() -> None:
    autopilot, vehicle = copter()
    vehicle.parameters["FS_GCS_ENABLE"] = 2.0
    autopilot.run_prearm_checks()
    assert texts(autopilot) == ["PreArm: FS_GCS_ENABLE=2 removed, see FS_OPTIONS"]
    assert autopilot.arm(False)
    assert texts(autopilot) == ["Arm: FS_GCS_ENABLE=2 removed, see FS_OPTIONS"]


def test_the_mission_has_what_it_must_have() -> None:
    autopilot, vehicle = copter()
    vehicle.parameters["ARMING_MIS_ITEMS"] = 8.0 + 64.0
    vehicle.mission = Mission((MissionItem(16, 0), MissionItem(22, 3, z=10.0), MissionItem(20)))
    autopilot.run_prearm_checks()
    assert texts(autopilot) == []


@pytest.mark.parametrize("make_autopilot", (copter, rover))
def test_a_location_may_be_needed_in_any_mode(make_autopilot: Any) -> None:
    autopilot, vehicle = make_autopilot()
    vehicle.v.autopilot.modes.number = 0
    vehicle.v.autopilot.estimate.position_ok = False
    autopilot.run_prearm_checks()
    assert texts(autopilot) == []
    vehicle.parameters["ARMING_NEED_LOC"] = 1.0
    autopilot.parameter_changed("ARMING_NEED_LOC")
    assert vehicle.v.autopilot.calibrated.state & NEEDS_LOCATION
    autopilot.run_prearm_checks()
    assert len(texts(autopilot)) == 1
    assert not autopilot.arm(False)


@pytest.mark.parametrize(
    ("gps_use", "text"), ((1.0, "AHRS: not using configured AHRS type"), (0.0, "Need Position Estimate"))
)
def test_a_rover_without_a_position_says_why(gps_use: float, text: str) -> None:
    autopilot, vehicle = rover()
    vehicle.v.autopilot.estimate.position_ok = False
    vehicle.v.autopilot.modes.number = GUIDED
    vehicle.parameters["AHRS_GPS_USE"] = gps_use
    autopilot.run_prearm_checks()
    assert texts(autopilot) == [f"PreArm: {text}"]
    assert not autopilot.arm(False)
    assert texts(autopilot) == [f"Arm: {text}"]
