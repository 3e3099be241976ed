# SPDX-License-Identifier: BSD-3-Clause
"""A flight whose physics runs in another process is the flight in one process, byte for byte in telemetry."""

from __future__ import annotations

import pytest

from benchmarks.recorded import copter, rover
from sitl.bridge.dialect import message
from sitl.simulation import Simulation
from tests.bridge.hil.conftest import WatchedPilot

SIMSTATE, SCAN, DISTANCE = (message(n).id for n in ("SIMSTATE", "DEBUG_FLOAT_ARRAY", "DISTANCE_SENSOR"))
WHEELS = message("WHEEL_DISTANCE").id


def assert_same(here: WatchedPilot, there: WatchedPilot) -> None:
    assert here.simulation.time_us == there.simulation.time_us
    assert len(here.received.frames) > 10_000
    for ours, theirs in zip(here.received.frames, there.received.frames):
        assert ours == theirs
    assert len(here.received.frames) == len(there.received.frames)


@pytest.mark.slow
def test_a_copters_whole_mission(physics) -> None:
    params = {"SIM_WIND_SPD": 3.3, "SIM_WIND_DIR": 200.0, "SIM_WIND_TURB": 0.7}
    process = physics("copter", "--seed", "7")
    flown = []
    for options in ({"seed": 7}, {"physics": process.address}):
        simulation = Simulation("erle_copter", params=params, **options)  # type: ignore[arg-type]
        flown.append(WatchedPilot(simulation))
        copter.auto(simulation, flown[-1])
        simulation.close()
    assert_same(*flown)
    assert SIMSTATE in flown[1].received.names()
    assert flown[0].reached


@pytest.mark.slow
def test_a_rovers_whole_drive(physics, monkeypatch) -> None:
    monkeypatch.setattr(rover, "Pilot", WatchedPilot)
    process = physics("rover", "--seed", "3", "--home=-35.363262,149.165237,584,200")
    driven = []
    for options in ({"seed": 3, "home": (-35.363262, 149.165237, 584.0, 200.0)}, {"physics": process.address}):
        simulation = Simulation("erle_rover", **options)  # type: ignore[arg-type]
        driven.append(rover.drive(simulation))
        simulation.close()
    assert_same(*driven)
    assert WHEELS in driven[1].received.names()


@pytest.mark.slow
def test_a_copter_among_walls_with_lidar_and_a_gps_that_fails(physics) -> None:
    process = physics("copter", "--seed", "2", "--world", "office_erlecopter")
    flown = []
    for options in ({"seed": 2, "world": "office_erlecopter"}, {"physics": process.address}):
        simulation = Simulation("erle_copter", **options)  # type: ignore[arg-type]
        pilot = WatchedPilot(simulation)
        for name in ("DEBUG_FLOAT_ARRAY", "DISTANCE_SENSOR", "OBSTACLE_DISTANCE"):
            pilot.set_rate(name, 20.0)
        pilot.boot()
        pilot.arm()
        pilot.send_command("NAV_TAKEOFF", altitude=1.5)
        pilot.fly(6.0)
        pilot.send_command(31011)  # not a command of this vehicle: both say so
        pilot.stream_setpoint(6.0, 0b0000110111000111, (3.0, 2.0, 0.0))  # into a wall
        pilot.send("PARAM_SET", param_id=b"SIM_GPS1_ENABLE", param_value=0, param_type=2)
        for name in (b"SIM_ACC1_BIAS_X", b"SIM_ACC2_BIAS_X"):  # of both: a link carries one IMU
            pilot.send("PARAM_SET", param_id=name, param_value=1, param_type=9)
        pilot.fly(4.0)
        pilot.send_command("NAV_LAND")
        pilot.fly(20.0)
        flown.append(pilot)
        simulation.close()
    assert_same(*flown)
    assert {SCAN, DISTANCE, SIMSTATE} <= flown[1].received.names()
    assert any("hit" in text.lower() for _, _, text in flown[1].texts)
