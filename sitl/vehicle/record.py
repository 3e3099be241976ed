# SPDX-License-Identifier: BSD-3-Clause
"""The whole simulated vehicle as one record, one for each kind of vehicle; a fleet is an array of it."""

from __future__ import annotations

from ..autopilot.copter.state import Autopilot as CopterAutopilot
from ..autopilot.rover.state import Autopilot as RoverAutopilot
from ..autopilot.state import Autopilot
from ..core.border import Actuators, Sensors
from ..core.records import Record
from ..core.rng import Rng
from ..physics.native.copter.state import Physics as CopterPhysics
from ..physics.native.records import Physics
from ..physics.native.rover.state import Physics as RoverPhysics

TICK_US = 2500
"""One autopilot and physics tick: 400 Hz."""


class Vehicle(Record):
    """A vehicle: what all kinds have."""

    time_us: int  # since boot; only physics advances it
    tick: int  # ticks since boot
    rng: Rng
    physics: Physics  # airframe figures and truth
    sensors: Sensors  # border: written by physics, read by the autopilot
    actuators: Actuators  # border: written by the autopilot, read by physics
    autopilot: Autopilot


class Copter(Vehicle):
    """A copter."""

    physics: CopterPhysics
    autopilot: CopterAutopilot


class Rover(Vehicle):
    """A rover."""

    physics: RoverPhysics
    autopilot: RoverAutopilot
