# SPDX-License-Identifier: BSD-3-Clause
"""Record of a Turtlebot: everything that changes, and the figures it drives with. A fleet is an array of it."""

from __future__ import annotations

from ....core.records import record
from ....core.rng import RNG_DTYPE
from ....vehicles.turtlebot import FIGURES_DTYPE

TICK_US = 10_000
"""Physics step [us], as the original's."""
TICK_S = 1e-6 * TICK_US

COMMAND_DTYPE = record(
    ("forward", "f8"),  # speed [m/s]
    ("turn", "f8"),  # rate [rad/s], counter-clockwise seen from above
    ("time_us", "i8"),  # when it was given
)

BODY_DTYPE = record(
    ("north", "f8"),  # middle of the axle [m]
    ("east", "f8"),  # [m]
    ("down", "f8"),  # of the floor that it stands on [m]
    ("heading", "f8"),  # [rad], clockwise from north, -pi .. pi
    ("speed", "f8"),  # forward, of the last tick [m/s]
    ("yaw_rate", "f8"),  # clockwise, of the last tick [rad/s]
    ("clearance", "f8"),  # it can go so far in any direction before it may touch something [m]
    ("collided", "i8"),  # 1: a solid has stopped it since it was last advanced
)

TURTLEBOT_DTYPE = record(
    ("time_us", "i8"),  # since it was placed
    ("figures", FIGURES_DTYPE),
    ("command", COMMAND_DTYPE),
    ("body", BODY_DTYPE),
    ("rng", RNG_DTYPE),
)
