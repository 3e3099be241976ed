# SPDX-License-Identifier: BSD-3-Clause
"""A fault of what a vehicle does not have is refused, wherever it is asked for."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from sitl.errors import OptionError
from sitl.fleet import Fleet
from sitl.scenario import Scenario
from sitl.simulation import Simulation
from sitl.swarm import Swarm
from sitl.vehicle.equipment import Equipment
from sitl.vehicle.faults import Failure
from sitl.vehicle.kinds import KINDS
from sitl.vehicles import load

ON = {"GPS1_TYPE": 1.0, "SIM_GPS1_ENABLE": 1.0, "SIM_BARO_COUNT": 2.0}


def check(frame: str, fault: str, world: bool = False, **values: float) -> None:
    airframe = load(frame)
    kind = KINDS[airframe.kind]
    present = {**ON, **values}
    equipment = Equipment(kind, airframe, has_world=world)
    equipment.check(Failure.of_text(fault).checked(kind.firmware.table), lambda name: present.get(name, 0.0))


@pytest.mark.parametrize(
    ("frame", "fault", "why"),
    [
        (
            "erle_copter",
            "motor:6=0",
            "fault motor: there is no number 6; airframe erle_copter has 1, 2, 3, 4, and 0 for",
        ),
        ("erle_copter", "servo:5/stuck", "there is no number 5"),
        ("ardupilot_hexa", "motor:7", "has 1, 2, 3, 4, 5, 6, and 0"),
        ("erle_rover", "servo:2", "there is no number 2; airframe erle_rover has 1, 3"),
        ("erle_copter", "SIM_ENGINE_FAIL=32", "32 is no output of airframe erle_copter, whose bits are 1, 2, 4, 8"),
        ("skid_rover", "servo/slow", "SIM_SERVO_SPEED does nothing to airframe skid_rover"),
        ("erle_rover", "wind=4", "SIM_WIND_SPD does nothing to airframe erle_rover"),
        ("erle_rover", "SIM_WIND_DIR=90", "SIM_WIND_DIR does nothing to airframe erle_rover"),
        ("erle_copter", "gps:2", "airframe erle_copter has no gps 2: GPS2_TYPE is 0, not 1"),
        ("erle_copter", "SIM_GPS2_NOISE=3", "has no gps 2"),
        ("erle_copter", "optical_flow", "has no optical_flow 1: SIM_FLOW_ENABLE is 0"),
        ("erle_copter", "SIM_FLOW_RND=1", "has no optical_flow 1"),
        ("erle_copter", "distance_sensor/wrong=3", "has no distance_sensor 1: RNGFND1_TYPE is 0"),
        ("erle_copter", "avoidance", "has no lidar in a world"),
    ],
)
def test_what_it_does_not_have(frame: str, fault: str, why: str) -> None:
    with pytest.raises(OptionError, match=why):
        check(frame, fault)


@pytest.mark.parametrize(
    ("values", "fault", "why"),
    [
        ({"SIM_GPS1_ENABLE": 0.0}, "gps", "has no gps 1: SIM_GPS1_ENABLE is 0"),
        ({"GPS1_TYPE": 0.0}, "gps/wrong", "GPS1_TYPE is 0"),
        ({"SIM_BARO_COUNT": 1.0}, "baro:2/stuck", "has no baro 2: SIM_BARO_COUNT is 1, not 2"),
    ],
)
def test_sensors_that_are_switched_off(values: dict[str, float], fault: str, why: str) -> None:
    check("erle_copter", fault)
    with pytest.raises(OptionError, match=why):
        check("erle_copter", fault, **values)


def test_what_it_has() -> None:
    """Is taken: `check` raises for everything else, as the tests above show."""
    for frame, *faults in (
        (
            "erle_copter",
            "motor:4",
            "motor",
            "motor/slow",
            "mag:3",
            "gyro:2",
            "baro:2",
            "battery",
            "rc:16/stuck",
            "shove",
        ),
        ("ardupilot_hexa", "motor:6", "SIM_ENGINE_FAIL=32", "SIM_ENGINE_FAIL=255"),
        ("erle_rover", "servo:1", "motor:3", "servo/slow", "motor/slow", "SIM_ENGINE_FAIL=4"),
        ("skid_rover", "motor:1", "motor:3"),
    ):
        for fault in faults:
            check(frame, fault)
    check("erle_copter", "gps:2", GPS2_TYPE=1.0, SIM_GPS2_ENABLE=1.0)
    check("erle_copter", "gps", GPS1_TYPE=0.0, GPS2_TYPE=1.0, SIM_GPS2_ENABLE=1.0)
    check("erle_copter", "optical_flow", SIM_FLOW_ENABLE=1.0)
    check("erle_copter", "SIM_FLOW_ENABLE=1")
    check("erle_copter", "distance_sensor", RNGFND1_TYPE=100.0)
    check("erle_rover", "avoidance", world=True)


@pytest.mark.parametrize(
    "ask",
    [
        lambda: Simulation("erle_copter", faults=["motor:6=0@30"]),
        lambda: Simulation(Scenario.from_json(Scenario("erle_copter", faults=["motor:6=0"]).to_json())),
        lambda: Simulation("erle_copter").fail("motor:6=0"),
        lambda: Fleet("erle_copter", 2).fail([0, 1], "motor:6=0"),
        lambda: Fleet("erle_copter", 2, faults=["motor:6=0"]),
        lambda: Swarm("erle_copter", 2, faults=["motor:6=0"]),
    ],
)
def test_wherever_it_is_asked_for(ask: Callable[[], object]) -> None:
    with pytest.raises(OptionError, match="there is no number 6; airframe erle_copter has 1, 2, 3, 4"):
        ask()


def test_a_sensor_that_a_fault_switched_off_can_have_another_fault() -> None:
    simulation = Simulation("erle_copter", faults=["gps"])
    simulation.fail("gps/wrong=30@2")
    with pytest.raises(OptionError, match="has no gps 2"):
        simulation.fail("gps:2/wrong")
    simulation.close()
