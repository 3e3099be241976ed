# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle's physics without an autopilot of ours: for autopilots at the other end of a link."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from .. import vehicles
from ..autopilot import boot
from ..autopilot.params import files
from ..core.compile import Progress
from ..core.record_reader import RecordReader
from ..physics.engines import NATIVE
from ..physics.native.power_on import Home
from ..vehicle.kinds import KINDS
from ..vehicles import Airframe
from ..worlds import World
from .local import LocalPlant
from .plant import Craft
from .surroundings import StartPose


def stand_alone(
    frame: str | Airframe,
    *,
    home: Home,
    backend: str = NATIVE,
    seed: int = 0,
    world: str | Path | World | None = None,
    start: StartPose | None = None,
    params: Mapping[str, float] | None = None,
    progress: Progress | None = None,
) -> LocalPlant:
    """A plant whose vehicle stands at power-on; its record holds an autopilot that nobody runs.

    Args:
        frame: airframe.
        home, seed, world, start: see ``sitl.simulation.Simulation``.
        backend: name of the engine.
        params: SIM_ parameters of the world, under ArduPilot's names; others are of no effect.
        progress: told of each unit that is compiled.

    Raises:
        AirframeError, EngineError, MissingExtra, OptionError, ParameterError, WorldError: what cannot be simulated.
    """
    airframe = vehicles.load(frame)
    kind = KINDS[airframe.kind]
    fleet = kind.record.fleet(1)
    v, table = kind.record.of(fleet, 0), kind.firmware.table
    table.set_defaults(v.autopilot.params)
    files.apply(table, v.autopilot.params, airframe.parameters, f"airframe {airframe.name}")
    files.apply(table, v.autopilot.params, params or {}, "parameters")
    craft = Craft(kind, airframe, fleet, 0, v, RecordReader(fleet, 0), lambda: None)
    plant = LocalPlant(craft, backend, home, seed, world, start, None, progress)
    restart(plant)
    return plant


def restart(plant: LocalPlant) -> None:
    """Back to power-on; parameters stay."""
    boot.clear(plant.craft.v)
    plant.power_on()
