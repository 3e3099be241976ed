# SPDX-License-Identifier: BSD-3-Clause
"""What the shell needs to know of a firmware. The copter's and the rover's are in their folders."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from .aux_functions import AuxFunction
from .events import Event
from .mission.item_runners import Commands
from .params.table import Table


@dataclass(frozen=True)
class Firmware:
    """One of the firmwares that the autopilot is."""

    name: str
    """Of the kind of vehicle that it controls."""
    table: Table
    """Its parameters."""
    mode_names: Mapping[int, str]
    """ArduPilot's custom mode number -> name."""
    power_on: Callable[[Any], None]
    """Starts its parts on the cleared record of a vehicle whose parameters are set."""
    commands: Commands
    """What its missions may hold and how that is run."""
    aux_functions: Mapping[int, AuxFunction] = field(default_factory=dict)
    """What its switches can do, by number."""
    give_back: Callable[[Any], None] = lambda v: None
    """Before a boot, also one in the air: parameters that a mode has changed for a time are what they were before."""
    fence_bytes: int = 672
    """Space for fences in ArduPilot's storage,"""
    rally_bytes: int = 750
    """and for rally points."""
    events: Mapping[int, Event] = field(default_factory=dict)
    """What its laws tell, by code: others are neither said nor logged."""
