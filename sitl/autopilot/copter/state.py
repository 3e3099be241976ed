# SPDX-License-Identifier: BSD-3-Clause
"""The copter firmware's record."""

from __future__ import annotations

from typing import Protocol

from .. import state as shared
from ..terrain.state import Terrain
from .control.state import Control
from .modes.state import Modes
from .parameters import Parameters


class Autopilot(shared.Autopilot):
    """The copter firmware."""

    params: Parameters
    modes: Modes
    control: Control
    terrain: Terrain


class Vehicle(shared.Vehicle, Protocol):
    """What the firmware sees of the copter that it flies."""

    @property
    def autopilot(self) -> Autopilot:
        """The firmware."""
