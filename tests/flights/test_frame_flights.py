# SPDX-License-Identifier: BSD-3-Clause
"""Copters with six and eight motors: flown, with a failing motor, tested motor by motor; ESC telemetry; FOLLOW."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sitl import vehicles
from sitl.autopilot.copter.control.frames import frame_of
from sitl.simulation import Core
from tests.flights.aviator import POSITION, Aviator, target

MANY = ("ardupilot_x", "ardupilot_hexa", "ardupilot_hexa_x", "ardupilot_octa", "ardupilot_octa_quad", "ardupilot_y6")
TYPES = {"ardupilot_x": 2, "ardupilot_y6": 13, "ardupilot_octa": 14, "ardupilot_octa_quad": 14}
FOLLOW = 23


@pytest.mark.parametrize("name", vehicles.names("copter", on_bench=False))
def test_the_rotors_of_an_airframe_are_where_its_frame_has_motors(name: str) -> None:
    airframe = vehicles.load(name)
    frame = frame_of(int(airframe.parameters["FRAME_CLASS"]), int(airframe.parameters["FRAME_TYPE"]))
    assert frame is not None and len(frame) == len(airframe.rotors)
    for motor, rotor in zip(frame, airframe.rotors, strict=True):
        assert math.copysign(1.0, motor.yaw) == rotor.direction
        way, size = math.atan2(motor.right, motor.forward), math.hypot(rotor.x, rotor.y)
        offset = math.atan2(rotor.y, rotor.x) - way
        assert abs(math.remainder(offset, math.tau)) < 0.5 and size > 0.1


@pytest.mark.parametrize("frame", MANY)
def test_it_hovers_turns_and_goes_to_a_place(core: Core, frame: str) -> None:
    p = Aviator(core, frame).hover()
    count = int(p.ap.control.motors.count)
    pulses = p.simulation.v.actuators.pwm
    assert all(1300 < pulse < 1700 for pulse in pulses[:count]) and not any(pulses[count:])
    target(p, POSITION, x=10.0, y=5.0, z=-12.0)
    p.fly(12.0)
    assert p.ask(115, 90, 30, 1, 0) == 0
    p.fly(6.0)
    assert np.hypot(p.pos[0] - 10.0, p.pos[1] - 5.0) < 0.6 and p.height == pytest.approx(12.0, abs=0.5)
    assert p.euler[2] == pytest.approx(90.0, abs=2.0)


def test_an_octocopter_holds_its_height_without_a_motor(core: Core) -> None:
    p = Aviator(core, "ardupilot_octa").hover(25.0)
    p.set_parameter("SIM_ENGINE_MUL", 0.0)
    p.set_parameter("SIM_ENGINE_FAIL", 1.0)
    start = p.now
    p.fly(20.0)
    rows = p.since(start)
    assert abs(rows[:, 3] + 25.0).max() < 2.0 and abs(rows[:, 7:9]).max() < 15.0
    assert abs(rows[-1, 9] - rows[0, 9]) < 10.0


def test_a_hexacopter_that_sinks_is_boosted(core: Core) -> None:
    """Too little is left to hover: motors are asked for all that they have, and the mixer leaves the weakest out."""
    p = Aviator(core, "ardupilot_hexa", MOT_BAT_VOLT_MAX=0).hover(30.0)
    p.set_parameter("SIM_ENGINE_MUL", 0.6)
    p.set_parameter("SIM_ENGINE_FAIL", 1 + 2 + 4 + 8 + 16 + 32)
    p.fly(6.0)
    assert p.said("Potential Thrust Loss") and p.ap.control.motors.boosting


def test_motors_are_tested_in_their_order(core: Core) -> None:
    p = Aviator(core, "ardupilot_hexa_x").ready()
    turned = []
    for position in range(1, 7):
        assert p.ask(209, position, 0, 20, 1, 1, 1) == 0
        p.fly(0.5)
        pulses = p.simulation.v.actuators.pwm[:6]
        turned.append(int(np.argmax(pulses)) + 1)
        p.fly(1.5)
    assert turned == [5, 1, 4, 6, 2, 3]
    assert p.ask(209, 7, 0, 20, 1, 1, 1) == 0, "as of ArduPilot, though no motor is there"
    p.fly(0.5)
    assert np.ptp(p.simulation.v.actuators.pwm[:6]) == 0


def test_a_frame_that_there_is_not_is_not_armed(core: Core) -> None:
    p = Aviator(core, "ardupilot_quad").ready()
    p.set_parameter("FRAME_TYPE", 7)
    assert p.ask(400, 1) != 0 and p.said("Arm: Motors: Check frame class and type")
    p.set_parameter("FRAME_TYPE", 0)
    assert p.ask(400, 1) == 0


def test_a_frame_that_is_not_the_vehicles_is_told(core: Core) -> None:
    warning = "FRAME_CLASS 3 has 8 motors, this vehicle 4 rotors"
    p = Aviator(core, "ardupilot_quad").ready()
    assert not p.said("FRAME_CLASS")
    p.set_parameter("FRAME_CLASS", 3)
    assert p.said(warning)
    p = Aviator(core, "ardupilot_quad", FRAME_CLASS=3).ready()
    p.arm()
    assert p.said(warning)


def test_speed_controllers_tell_what_turns(core: Core) -> None:
    p = Aviator(core, "erle_copter", RPM1_TYPE=5).hover()
    speeds = np.array(p.simulation.v.physics.rotors.speed[:4]) * 60.0 / math.tau
    found = p.message("ESC_TELEMETRY_1_TO_4")
    assert np.array(found.rpm) == pytest.approx(speeds, rel=0.05) and found.count[0] > 100
    assert p.message("RPM").rpm1 == pytest.approx(speeds.mean(), rel=0.05)
    octa = Aviator(core, "ardupilot_octa", SIM_VIB_MOT_MAX=100, SIM_ESC_ARM_RPM=500).ready()
    assert not any(octa.message("ESC_TELEMETRY_5_TO_8").rpm)
    octa.arm()
    octa.fly(0.2)
    assert list(octa.message("ESC_TELEMETRY_5_TO_8").rpm) == [500] * 4
    octa.take_off(10.0)
    assert np.array(octa.message("ESC_TELEMETRY_5_TO_8").rpm) == pytest.approx(0.55 * 6000.0, rel=0.1)


def test_slow_motors_keep_it_on_the_ground(core: Core) -> None:
    p = Aviator(core, "ardupilot_quad", SIM_ESC_ARM_RPM=500, TKOFF_RPM_MIN=1000).ready()
    p.arm()
    assert p.ask(22, 0, 0, 0, 0, 0, 0, 10) == 0
    p.fly(7.0)
    assert p.on_ground and p.said("Takeoff blocked: ESC RPM out of range")
    p.set_parameter("TKOFF_RPM_MIN", 400)
    p.fly(6.0)
    assert p.height > 2.0


def lead(p: Aviator, seconds: float, **fields: float) -> None:
    """Another vehicle tells twice a second where it is: place [m] north, east; velocity [cm/s]; heading [cdeg]."""
    north, east = fields.pop("north", 0.0), fields.pop("east", 0.0)
    for _ in range(round(2 * seconds)):
        lat, lon = p.lat_lon(north, east)
        values = {"lat": lat, "lon": lon, "relative_alt": 10_000, "hdg": 0, **fields}
        p.send("GLOBAL_POSITION_INT", **{name: int(value) for name, value in values.items()})
        p.fly(0.5)
        north, east = north + 0.005 * fields.get("vx", 0.0), east + 0.005 * fields.get("vy", 0.0)


def test_it_follows_another_vehicle(core: Core) -> None:
    p = Aviator(core, "ardupilot_quad").hover()
    assert not p.set_mode(FOLLOW) and p.said("Set FOLL_ENABLE = 1")
    for name, value in {"FOLL_ENABLE": 1, "FOLL_OFS_X": -20, "FOLL_OFS_TYPE": 1, "FOLL_YAW_BEHAVE": 2}.items():
        p.set_parameter(name, value)
    assert p.set_mode(FOLLOW)
    lead(p, 15.0, north=40.0, east=10.0, hdg=9000)
    assert p.pos[:2] == pytest.approx((40.0, -10.0), abs=1.0) and p.euler[2] == pytest.approx(90.0, abs=2.0)
    lead(p, 15.0, north=40.0, east=10.0, hdg=9000, vy=300)
    assert p.pos[:2] == pytest.approx((40.0, 35.0), abs=2.0)
    p.fly(8.0)
    assert np.linalg.norm(p.vel) < 0.3  # it is silent


def test_what_is_too_far_is_not_followed(core: Core) -> None:
    p = Aviator(core, "ardupilot_quad", FOLL_ENABLE=1, FOLL_OFS_X=-20).hover()
    assert p.set_mode(FOLLOW)
    lead(p, 5.0, north=150.0)
    assert np.linalg.norm(p.pos[:2]) < 1.0
