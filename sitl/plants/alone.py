# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle's physics without an autopilot of ours: for autopilots at the other end of a link."""

from __future__ import annotations

from typing import Unpack

from ..autopilot import boot
from ..autopilot.params import files
from ..core.compile import Progress
from ..core.record_reader import RecordReader
from ..scenario import Options, Scenario
from ..vehicles import Airframe
from .local import LocalPlant
from .plant import Craft


def stand_alone(
    frame: str | Airframe | Scenario, *, progress: Progress | None = None, **options: Unpack[Options]
) -> LocalPlant:
    """A plant whose vehicle stands at power-on; its record holds an autopilot that nobody runs.

    Args:
        frame: airframe, or a whole scenario; of its parameters the SIM_ ones count.
        progress: told of each unit that is compiled.
        options: the other fields of ``sitl.scenario.Scenario``.

    Raises:
        AirframeError, EngineError, MissingExtra, OptionError, ParameterError, WorldError: what cannot be simulated.
    """
    scenario = Scenario.of(frame, **options)
    airframe, kind = scenario.airframe, scenario.kind
    fleet = kind.record.fleet(1)
    v, table = kind.record.of(fleet, 0), kind.firmware.table
    table.set_defaults(v.autopilot.params)
    files.apply(table, v.autopilot.params, airframe.parameters, f"airframe {airframe.name}")
    files.apply(table, v.autopilot.params, scenario.params or {}, "parameters")
    craft = Craft(kind, airframe, fleet, 0, v, RecordReader(fleet, 0), lambda: None)
    plant = LocalPlant(craft, scenario, None, progress)
    restart(plant)
    return plant


def restart(plant: LocalPlant) -> None:
    """Back to power-on; parameters stay."""
    boot.clear(plant.craft.v)
    plant.power_on()
