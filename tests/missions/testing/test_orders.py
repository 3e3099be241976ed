# SPDX-License-Identifier: BSD-3-Clause
"""What a test tells its vehicle: places, velocities, sticks, parameters, faults, missions."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from sitl.errors import OptionError
from sitl.missions.library import entries
from sitl.missions.testing.factory import VehicleFactory


def test_a_velocity_stays_until_another_order(make: VehicleFactory) -> None:
    copter = make("copter")
    copter.takeoff(10)
    copter.set_velocity(0, 3)
    copter.delay(10)  # longer than GUID_TIMEOUT
    assert copter.telemetry.velocity[1] == pytest.approx(3, abs=0.3)
    copter.set_position(*copter.position[:2])
    copter.delay(10)
    assert copter.groundspeed < 0.5


def test_velocities_of_the_body(make: VehicleFactory) -> None:
    copter = make("copter")
    copter.takeoff(10)
    copter.set_position(0, 0, yaw=90)
    copter.wait_heading(90, accuracy=1, hold=1)
    copter.set_velocity(2, 0, body=True)
    copter.wait_groundspeed(1.8)
    assert copter.telemetry.velocity[1] > 1.7


def test_sticks_are_held_and_given_back(make: VehicleFactory) -> None:
    copter = make("copter")
    copter.takeoff(10)
    copter.set_rc(throttle=1500, pitch=1400)
    copter.change_mode("LOITER")
    copter.delay(6)  # longer than RC_OVERRIDE_TIME
    assert copter.groundspeed > 1
    copter.set_rc({2: 1500})
    copter.wait_groundspeed(0, 0.3)
    assert copter.message("RC_CHANNELS").chan3_raw == 1500
    copter.release_rc()
    copter.delay(0.5)
    assert copter.message("RC_CHANNELS").chan3_raw != 1500
    with pytest.raises(ValueError, match="no stick 'collective'"):
        copter.set_rc(collective=1500)
    with pytest.raises(ValueError, match="no channel 19"):
        copter.set_rc({19: 1500})


def test_parameters_undo_themselves(make: VehicleFactory) -> None:
    copter = make("copter")
    before = copter.parameter("ANGLE_MAX")
    with copter.parameters({"WPNAV_SPEED": 300}, ANGLE_MAX=2000):
        assert copter.parameter("ANGLE_MAX") == 2000
        assert copter.parameter("WPNAV_SPEED") == 300
    assert copter.parameter("ANGLE_MAX") == before
    with pytest.raises(ZeroDivisionError), copter.parameters(ANGLE_MAX=2000):
        raise ZeroDivisionError
    assert copter.parameter("ANGLE_MAX") == before


def test_parameters_that_cannot_be_set(make: VehicleFactory) -> None:
    copter = make("copter")
    with pytest.raises(ValueError, match="no parameter 'ANGLE_MAXX'; near to it: ANGLE_MAX"):
        copter.set_parameter("ANGLE_MAXX", 1)
    with pytest.raises(ValueError, match="no parameter"), copter.parameters(ANGLE_MAX=2000, NO_SUCH=1):
        raise ZeroDivisionError
    with pytest.raises(AssertionError, match="was not set to 99999"):
        copter.set_parameter("ANGLE_MAX", 99999)


def test_faults_come_and_go(make: VehicleFactory) -> None:
    copter = make("copter")
    copter.takeoff(10)
    with copter.fail("wind", speed=9, direction=270):
        assert copter.parameter("SIM_WIND_SPD") == 9
        with copter.fork():
            copter.fail("motor", motor=2)
            copter.wait_altitude(-math.inf, 2, timeout=20)
    assert copter.parameter("SIM_WIND_SPD") == 0
    assert copter.height == pytest.approx(10, abs=1)
    gps = copter.fail("gps")
    copter.wait_mode("LAND")
    gps.repair()
    with pytest.raises(ValueError, match="a copter has no fault 'engine'; there are gps, rc"):
        copter.fail("engine")
    with pytest.raises(ValueError, match="a rover has no fault 'motor'"):
        make("rover").fail("motor")


def test_a_silent_station_is_missed(make: VehicleFactory) -> None:
    copter = make("copter", params={"FS_GCS_ENABLE": 1})
    copter.takeoff(10)
    copter.delay(10)
    assert copter.mode == "GUIDED"
    copter.fail("station")
    copter.wait_mode("RTL", timeout=10)


def test_a_mission_is_flown(make: VehicleFactory) -> None:
    copter = make("copter")
    copter.upload("copter/square")
    copter.start_mission()
    copter.wait_waypoint(2)
    assert copter.telemetry.item == 3
    copter.wait_current_waypoint(5)
    copter.wait_disarmed()
    copter.fly_mission("copter/triangle")
    assert copter.reached


def test_a_rover_drives_a_mission(make: VehicleFactory) -> None:
    rover = make("rover")
    rover.fly_mission("rover/square")
    assert not rover.armed and rover.mode == "AUTO"


def test_a_mission_that_is_not_ended_says_so(make: VehicleFactory) -> None:
    copter = make("copter", params={"FS_THR_ENABLE": 1, "FS_OPTIONS": 0, "SIM_RC_FAIL": 0})
    copter.upload("copter/square")
    copter.start_mission()
    copter.wait_waypoint(2)
    with pytest.raises(
        AssertionError, match="mission item 5 to be reached\n  last seen: reached 1, 2; on the way to 3"
    ):
        copter.wait_waypoint(5, timeout=2)


def test_mission_files_are_found_beside_the_test(make: VehicleFactory, tmp_path: Path) -> None:
    (tmp_path / "mine.plan").write_bytes(entries()["copter/square"].path.read_bytes())
    copter = make("copter")
    assert len(copter.upload("mine.plan")) == 7
    with pytest.raises(OptionError, match="no mission file 'yours"):
        copter.upload("yours.plan")


def test_a_mission_of_elsewhere_is_no_mission_here(make: VehicleFactory) -> None:
    copter = make("copter", home=(47.0, 8.0, 500, 0))
    with pytest.raises(OptionError, match="km from home"):
        copter.upload("copter/square")


def test_a_rover_drives(make: VehicleFactory) -> None:
    rover = make("rover")
    rover.start()
    rover.set_position(30, 0)
    rover.set_speed(1.5)
    rover.delay(5)
    assert rover.groundspeed == pytest.approx(1.5, abs=0.3)
    rover.drive_to(8, 3)
    rover.stop()
    assert math.dist(rover.position[:2], (8, 3)) < 2
