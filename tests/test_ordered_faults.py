# SPDX-License-Identifier: BSD-3-Clause
"""Faults of a simulation: at their times, over snapshots, reboots, recordings and fleets, and by INJECT_FAILURE."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from sitl import Fleet, Simulation
from sitl.bridge.services.failure_injection import FaultService
from sitl.client import Client
from sitl.errors import OptionError
from sitl.recording.recorder import Recorder
from sitl.recording.recording import read
from sitl.recording.replay import Replay
from sitl.scenario import Scenario
from sitl.simulation import Core
from sitl.vehicle.faults import Failure

OFF, OK, STUCK, SLOW = 1, 0, 2, 5
BATTERY, GPS, MOTOR, RC, VIO = 100, 4, 101, 104, 6
ACCEPTED, DENIED, UNSUPPORTED = 0, 2, 3


def is_off(simulation: Simulation) -> bool:
    return simulation.parameters["SIM_GPS1_ENABLE"] == 0.0 and bool(simulation.v.physics.sensors.gps[0].off)


def test_a_fault_comes_and_goes_at_its_tick() -> None:
    simulation = Simulation("erle_rover", faults=["gps@2..3"])
    simulation.advance_to(1_997_500)
    assert not is_off(simulation)
    simulation.advance_to(2_000_000)
    assert is_off(simulation)
    moment = simulation.snapshot()
    simulation.advance_to(3_002_500)
    assert not is_off(simulation)
    simulation.restore(moment)
    assert is_off(simulation)
    simulation.advance(1.0025)
    assert not is_off(simulation)


def test_what_has_failed_is_put_back_as_it_was() -> None:
    simulation = Simulation("erle_copter", params={"SIM_BATT_VOLTAGE": 12.0})
    for text in ("battery=11", "battery=10", "motor:1", "motor:4=0.5", "wind@5", "SIM_WIND_DIR=10"):
        simulation.fail(text)
    simulation.repair("motor", 1)
    assert (simulation.parameters["SIM_ENGINE_FAIL"], simulation.parameters["SIM_ENGINE_MUL"]) == (8.0, 0.5)
    assert simulation.parameters["SIM_BATT_VOLTAGE"] == 10.0
    simulation.repair("battery")
    assert simulation.parameters["SIM_BATT_VOLTAGE"] == 12.0
    simulation.repair()
    simulation.advance(6.0)
    for name, value in (("SIM_ENGINE_FAIL", 0.0), ("SIM_WIND_DIR", 180.0), ("SIM_WIND_SPD", 0.0)):
        assert simulation.parameters[name] == value
    with pytest.raises(OptionError, match="there is no fault 'gsp'"):
        simulation.repair("gsp")
    with pytest.raises(OptionError, match="there is no fault 'shove'"):
        Simulation("erle_rover", faults=["shove"])


def test_a_reboot_changes_no_times() -> None:
    simulation = Simulation("erle_rover")
    simulation.advance(1.0)
    simulation.fail(Failure("gps", begin=4.0, end=5.0))
    simulation.request_reboot()
    simulation.advance(3.9)
    assert not is_off(simulation)
    simulation.advance(0.2)
    assert is_off(simulation)
    simulation.advance(1.0)
    assert not is_off(simulation)


def test_recordings_and_scenarios_have_them(tmp_path: Path) -> None:
    simulation = Simulation("erle_rover", faults=["gps@1"])
    assert Scenario.from_json(simulation.resolved.to_json()).faults == ("gps@1.0",)
    recorder = Recorder(simulation, tmp_path / "a.rec")
    simulation.advance(1.5)
    simulation.fail("battery=9@0.5")
    simulation.advance(1.0)
    simulation.repair("gps")
    simulation.advance(1.0)
    recorder.close()
    replay = Replay(read(tmp_path / "a.rec"))
    assert replay.run() == []
    assert replay.simulation.parameters["SIM_BATT_VOLTAGE"] == 9.0 and not is_off(replay.simulation)


def test_faults_overlap_over_snapshots_and_reboots() -> None:
    simulation = Simulation("erle_rover", faults="motor:1@1..4")
    for text in ("motor:3=0.5@2..3", Failure("battery", amount=np.float64(9.0), begin=np.float64(1.5))):  # type: ignore[arg-type]
        simulation.fail(text)
    values = lambda: [simulation.parameters[f"SIM_{name}"] for name in ("ENGINE_FAIL", "ENGINE_MUL", "BATT_VOLTAGE")]  # noqa: E731
    simulation.advance_to(2_500_000)
    assert values() == [5.0, 0.5, 9.0]
    moment = simulation.snapshot()
    for way in ("on", "again", "reboot"):
        if way != "on":
            simulation.restore(moment)
        if way == "reboot":
            simulation.request_reboot()
        simulation.advance_to(3_500_000)
        assert values() == [1.0, 0.0, 9.0]
        simulation.repair("battery")
        simulation.advance_to(4_500_000)
        assert values() == [0.0, 0.0, pytest.approx(12.6)], way


def test_a_client_that_sets_the_parameter_of_a_fault_has_the_last_word() -> None:
    client = Client(Simulation("erle_rover", faults=["battery=9", "gps@0..3"]))
    client.params["SIM_BATT_VOLTAGE"] = 11
    client.params["SIM_GPS1_ENABLE"] = 0
    client.delay(4.0)
    assert client.params["SIM_GPS1_ENABLE"] == 0 and is_off(client.simulation)
    client.simulation.fail("battery=10")
    assert client.params["SIM_BATT_VOLTAGE"] == 10
    client.simulation.repair("battery")
    assert client.params["SIM_BATT_VOLTAGE"] == 11


def test_a_recording_has_the_faults_that_were_ordered_before_it(tmp_path: Path) -> None:
    simulation = Simulation("erle_rover", faults=["gps@1", "rc@1"])
    simulation.fail("motor:1@0.5")
    simulation.fail("rc/stuck@0.5")
    simulation.repair("rc:4")
    recorder = Recorder(simulation, tmp_path / "a.rec")
    simulation.advance(2.0)
    recorder.close()
    replay = Replay(read(tmp_path / "a.rec"))
    assert replay.run() == []
    assert replay.simulation.parameters["SIM_ENGINE_FAIL"] == 1.0 and is_off(replay.simulation)
    assert replay.simulation.parameters["SIM_RC_STUCK"] == 0xFFF7
    assert replay.simulation.parameters["SIM_RC_FAIL"] == 1.0


def test_a_fleet_takes_all_of_an_order_or_nothing() -> None:
    fleet = Fleet("erle_rover", 2)
    for order, why in (
        (lambda: fleet.fail([0, 2], "gps"), "no vehicle 2"),
        (lambda: fleet.fail([0, 1], "gsp"), "there is no fault 'gsp'"),
        (lambda: fleet.fail(0, 3), "fault 3 is neither"),  # type: ignore[arg-type]
    ):
        with pytest.raises(OptionError, match=why):
            order()
        assert not any(fleet.view(k).physics.sensors.gps[0].off for k in range(2))
    fleet.fail([0, 1], "gps")
    for order, why in (
        (lambda: fleet.repair([0, -1]), "no vehicle -1"),
        (lambda: fleet.repair([0, 1], "gps", 4), "there is no number 4"),
    ):
        with pytest.raises(OptionError, match=why):
            order()
        assert all(fleet.view(k).physics.sensors.gps[0].off for k in range(2))
    fleet.close()


@pytest.mark.parametrize("fault", ["motor:1@5", "servo", "wind", "shove", "twist", "SIM_WIND_DIR=10"])
def test_what_does_nothing_to_physics_elsewhere_is_refused(core: Core, fault: str) -> None:
    where = "json:127.0.0.1:9"
    with pytest.raises(OptionError, match=rf"does nothing to physics {where}; there are gps, gyro, .* rc"):
        Simulation("erle_copter", physics=where, faults=[fault])
    simulation = Simulation("erle_copter", physics=where, faults=["gps", "rc@5"])
    with pytest.raises(OptionError, match=f"does nothing to physics {where}"):
        simulation.fail(fault)
    order = lambda *params: simulation.bridge.get(FaultService).command(*params)  # noqa: E731
    simulation.parameters["SYS_FAILURE_EN"] = 1.0
    assert (order(MOTOR, OFF, 0), order(GPS, STUCK, 0), order(GPS, OFF, 0)) == (UNSUPPORTED, UNSUPPORTED, ACCEPTED)
    simulation.close()


def test_what_is_no_list_of_faults() -> None:
    assert Scenario(faults=[Failure("gps", begin=2.0), "rc"]).faults == ("gps@2.0", "rc@0.0")
    for faults in (3, [3], [None]):
        with pytest.raises(OptionError, match="fault"):
            Scenario(faults=faults)  # type: ignore[arg-type]


def test_a_vehicle_of_a_fleet_fails_as_one_alone() -> None:
    alone, fleet = Simulation("erle_rover"), Fleet("erle_rover", 2)
    alone.advance(1.0)
    fleet.advance(1.0)
    alone.fail("gps@0.5..0.7")
    fleet.fail(1, "gps@0.5..0.7")
    for _ in range(4):
        alone.advance(0.2)
        fleet.advance(0.2)
        assert fleet.view(1).physics.sensors.gps[0].off == alone.v.physics.sensors.gps[0].off
        assert not fleet.view(0).physics.sensors.gps[0].off
    assert fleet.records[1].tobytes() == alone.fleet[0].tobytes()
    fleet.fail([0, 1], "gps")
    fleet.repair(0)
    assert [bool(fleet.view(k).physics.sensors.gps[0].off) for k in (0, 1)] == [False, True]
    fleet.close()


def test_inject_failure() -> None:
    """ArduPilot 4.7 answers 420 with UNSUPPORTED; so does this autopilot until SYS_FAILURE_EN is set."""
    client = Client(Simulation("erle_copter"))
    order = lambda *params: client.request("INJECT_FAILURE", *params)  # noqa: E731
    assert order(GPS, OFF, 0) == UNSUPPORTED and not is_off(client.simulation)
    client.params["SYS_FAILURE_EN"] = 1
    assert order(GPS, OFF, 0) == ACCEPTED and is_off(client.simulation)
    assert order(GPS, OK, 0) == ACCEPTED and not is_off(client.simulation)
    assert order(MOTOR, OFF, 2) == ACCEPTED and client.params["SIM_ENGINE_FAIL"] == 2
    assert order(MOTOR, OFF, 3) == ACCEPTED and client.params["SIM_ENGINE_FAIL"] == 6
    assert order(MOTOR, OK, 2) == ACCEPTED and client.params["SIM_ENGINE_FAIL"] == 4
    assert order(MOTOR, OFF, 6) == DENIED and order(MOTOR, OK, 5) == DENIED and client.params["SIM_ENGINE_FAIL"] == 4
    assert order(MOTOR, OFF, 9) == DENIED and order(MOTOR, OFF, 1.5) == DENIED
    assert order(RC, STUCK, 5) == ACCEPTED and order(RC, OFF, 5) == DENIED and order(RC, OK, 5) == ACCEPTED
    for unit, kind in ((VIO, OFF), (77, OFF), (GPS, SLOW), (GPS, 8), (GPS, 1.5), (BATTERY, OFF), (-1, OFF)):
        assert order(unit, kind, 0) == UNSUPPORTED
