# SPDX-License-Identifier: BSD-3-Clause
"""A client of a PX4 (the stand-in, which behaves as a real one was seen to): modes, places, missions, parameters."""

from __future__ import annotations

import math

import pytest

from sitl.bridge.hil import controls
from sitl.client.errors import UnknownNameError
from sitl.errors import OptionError
from sitl.missions.testing.factory import VehicleFactory
from sitl.missions.testing.golden import GoldenStore
from sitl.missions.testing.setup import Defaults

pytestmark = pytest.mark.slow


@pytest.fixture
def fly(px4, tmp_path, monkeypatch):
    monkeypatch.setattr(controls, "LONGEST_WAIT_S", 20.0)  # a busy machine shall not take ticks from a pilot in flight
    factory = VehicleFactory(Defaults(autopilot=f"px4:{px4}"), GoldenStore(tmp_path), tmp_path / "logs")
    yield factory
    factory.close()


def truth(vehicle):
    return tuple(vehicle.connection.plant.vehicle.v.physics.body.pos)


def test_it_is_flown_by_its_own_modes(fly):
    copter = fly("copter")
    assert copter.mode == "LOITER"
    copter.takeoff(4.0)
    copter.fly_to(5.0, -3.0, 4.0)
    assert math.dist(truth(copter), (5.0, -3.0, -4.0)) < 1.5
    copter.set_velocity(1.0, 0.0)
    copter.delay(3.0)
    assert copter.mode == "OFFBOARD" and copter.velocity[0] == pytest.approx(1.0, abs=0.3)
    copter.params["NAV_RCL_ACT"] = 2
    assert copter.params["NAV_RCL_ACT"] == 2 and copter.params["MPC_THR_HOVER"] == pytest.approx(0.466, abs=0.001)
    with pytest.raises(OptionError, match=r"NAV_RCL_ACT = 1\.5; PX4 has a whole number there"):
        copter.params["NAV_RCL_ACT"] = 1.5
    with pytest.raises(UnknownNameError, match="no mode 'GUIDED'; it has MANUAL"):
        copter.change_mode("GUIDED")
    with pytest.raises(OptionError, match="COM_RC_IN_MODE"):
        copter.set_rc(roll=1600)
    copter.return_to_launch()
    assert math.hypot(*truth(copter)[:2]) < 1.0


def test_a_mission_without_home_is_flown_and_its_items_are_counted_as_uploaded(fly):
    copter = fly("copter")
    mission = copter.upload("copter/square")
    assert [item.command for item in copter.download()] == [item.command for item in mission.items]
    copter.fly_mission("copter/square")
    assert copter.reached == [1, 2, 3, 4, 5] and copter.telemetry.items[-1] == 6


def test_faults_are_our_physics(fly):
    copter = fly("copter", wind=3.0)
    wind = copter.connection.plant.vehicle.v.physics.wind
    assert copter.params["SIM_WIND_SPD"] == 3.0
    copter.takeoff(3.0)
    with copter.fail("wind", speed=6.0, direction=90.0):
        copter.delay(2.0)
        assert wind.vel[1] < -2.0
    with copter.fail("gps"):
        copter.delay(1.0)
        assert copter.connection.plant.vehicle.v.sensors.gps_fix < 2
    assert not copter.idle_faults


def test_a_parameter_that_it_has_not_is_named(fly):
    with pytest.raises(OptionError, match=r"^params: autopilot px4:.* has no MC_ROLRATE_P$"):
        fly("copter", params={"MC_ROLRATE_P": 0.2, "MPC_XY_CRUISE": 3.0})
