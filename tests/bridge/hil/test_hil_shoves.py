# SPDX-License-Identifier: BSD-3-Clause
"""A shove of a vehicle whose physics is elsewhere."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from sitl import Simulation
from sitl.plants.hil import HilPlant
from sitl.simulation import Core


def test_a_shove_is_told_to_the_physics(core: Core) -> None:
    simulation = Simulation("erle_copter", core=core)
    told: list[tuple[str, float]] = []
    plant: Any = object.__new__(HilPlant)
    plant.vehicle = simulation.plant.vehicle
    plant.end = SimpleNamespace(set_parameter=lambda name, value: told.append((name, value)))
    for name, value in (("SIM_SHOVE_X", 3.0), ("SIM_SHOVE_TIME", 300.0)):
        simulation.parameters[name] = value
        plant.parameter_changed(name)
    assert told == [("SIM_SHOVE_X", 3.0), ("SIM_SHOVE_TIME", 300.0)]
