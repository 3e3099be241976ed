# SPDX-License-Identifier: BSD-3-Clause
"""Record of a Turtlebot: everything that changes, and the properties it drives with. A fleet is an array of it."""

from __future__ import annotations

from ....core.records import Record
from ....core.rng import Rng
from ....vehicles.turtlebot import Properties

TICK_US = 10_000
"""Physics step [us], as the original's."""
TICK_S = 1e-6 * TICK_US


class Command(Record):
    """What the robot shall do."""

    forward: float  # speed [m/s]
    turn: float  # rate [rad/s], counter-clockwise seen from above
    time_us: int  # when it was given


class Body(Record):
    """Where the robot is and how it moves."""

    north: float  # middle of the axle [m]
    east: float  # [m]
    down: float  # of the floor that it stands on [m]
    heading: float  # [rad], clockwise from north, -pi .. pi
    speed: float  # forward, of the last tick [m/s]
    yaw_rate: float  # clockwise, of the last tick [rad/s]
    clearance: float  # it can go so far in any direction before it may touch something [m]
    collided: bool  # a solid has stopped it since it was last advanced


class Turtlebot(Record):
    """A whole Turtlebot."""

    time_us: int  # since it was placed
    airframe: Properties
    command: Command
    body: Body
    rng: Rng
