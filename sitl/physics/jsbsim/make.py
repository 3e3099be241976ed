# SPDX-License-Identifier: BSD-3-Clause
"""JSBSim for a vehicle."""

from __future__ import annotations

from ..engine import Engine, Seat
from .copter import CopterCraft
from .engine import JsbsimEngine


def make(seat: Seat) -> Engine:
    """The engine of a vehicle.

    Raises:
        EngineError: the vehicle or its world is nothing for JSBSim.
        MissingExtra: JSBSim is not installed.
    """
    if seat.airframe.kind == "copter":
        return JsbsimEngine(seat, CopterCraft(seat))
    from .rover import RoverCraft

    return JsbsimEngine(seat, RoverCraft(seat))
