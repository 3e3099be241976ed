# SPDX-License-Identifier: BSD-3-Clause
"""The rover firmware's record."""

from __future__ import annotations

from typing import Protocol

from .. import state as shared
from .control.state import Control
from .modes.state import Modes
from .parameters import Parameters


class Autopilot(shared.Autopilot):
    """The rover firmware."""

    params: Parameters
    modes: Modes
    control: Control


class Vehicle(shared.Vehicle, Protocol):
    """What the firmware sees of the rover that it drives."""

    @property
    def autopilot(self) -> Autopilot:
        """The firmware."""
