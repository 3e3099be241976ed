# SPDX-License-Identifier: BSD-3-Clause
"""The whole simulated vehicle as one record; a fleet is an array of it. Each kind of vehicle has a type of its own."""

from __future__ import annotations

from ..autopilot.state import Autopilot
from ..core.border import Actuators, Sensors
from ..core.records import Record
from ..core.rng import Rng
from ..physics.native.records import Physics


class Vehicle(Record):
    """A vehicle: what all kinds have."""

    time_us: int  # since boot; only physics advances it
    tick: int  # ticks since boot
    rng: Rng
    physics: Physics  # airframe properties and truth
    sensors: Sensors  # border: written by physics, read by the autopilot
    actuators: Actuators  # border: written by the autopilot, read by physics
    autopilot: Autopilot
