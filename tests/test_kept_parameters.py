# SPDX-License-Identifier: BSD-3-Clause
"""Parameters without effect in whole vehicles: snapshots, reboots, resets and fleets."""

from __future__ import annotations

from sitl.client import Client
from sitl.fleet import Fleet
from sitl.simulation import Simulation

NAME = "FRSKY_OPTIONS"


def test_they_are_in_snapshots_and_survive_a_reboot() -> None:
    simulation = Simulation(params={NAME: 2})
    values, start = simulation.parameters, simulation.snapshot()
    client = Client(simulation)
    client.params[NAME] = 5
    later = simulation.snapshot()
    assert values[NAME] == client.params[NAME] == 5.0
    simulation.restore(start)
    assert values[NAME] == 2.0
    simulation.restore(later)
    simulation.request_reboot()
    simulation.advance(0.1)
    assert values[NAME] == simulation.parameters[NAME] == 5.0
    assert Simulation().parameters[NAME] == 0.0


def test_each_vehicle_of_a_fleet_has_its_own() -> None:
    with_client = Simulation()
    client = Client(with_client)
    fleet = Fleet(count=3)
    size = fleet.records.nbytes
    client.params[NAME] = 4
    fleet.put(1, with_client.snapshot())
    assert [fleet.simulation(k).parameters[NAME] for k in range(3)] == [0.0, 4.0, 0.0]
    fleet.put(1, fleet.snapshot(0))
    assert fleet.simulation(1).parameters[NAME] == 0.0
    assert fleet.records.nbytes == size
    fleet.close()
