# SPDX-License-Identifier: BSD-3-Clause
"""What a kind of vehicle adds to the engine."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

from ..engine import Seat
from .properties import Properties


class Craft(ABC):
    """The part of a kind of vehicle: its aircraft, and what it exchanges with JSBSim besides the body's motion."""

    ahead = 0.0
    """From the origin of the body forward to its centre of mass, which JSBSim moves [m]."""

    def __init__(self, seat: Seat) -> None:
        self.seat = seat

    def frames(self, a: Any) -> int:
        """Frames of JSBSim a tick, of the vehicle's figures."""
        return 1

    @abstractmethod
    def document(self, a: Any, dt: float) -> str:
        """The aircraft of figures for frames of dt [s]."""

    def height(self, a: Any) -> float:
        """Of the centre of mass over the ground, standing [m]."""
        return 0.0

    @abstractmethod
    def bind(self, properties: Properties, a: Any, dt: float) -> None:
        """Look up the properties of a new executive."""

    @abstractmethod
    def inputs(self) -> None:
        """From the record to JSBSim, before a tick."""

    @abstractmethod
    def outputs(self, down: float) -> None:
        """From JSBSim to the record, after a tick; ``down`` is the velocity [m/s]."""

    def starting(self) -> None:
        """JSBSim is about to start: what has a state of its own takes it from the record, and keeps it meanwhile."""
        return

    def started(self) -> None:
        """It has."""
        return
