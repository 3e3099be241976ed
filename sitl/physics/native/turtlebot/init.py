# SPDX-License-Identifier: BSD-3-Clause
"""Puts a Turtlebot somewhere, at rest, as after switching it on."""

from __future__ import annotations

from ....core.rng import seed as seed_rng
from .state import Turtlebot

_LONG_AGO = -(10**15)
"""[us]: no command holds."""


def place(v: Turtlebot, north: float, east: float, down: float, heading: float, seed: int) -> None:
    """Put it at a position, at rest; properties stay, everything else begins anew.

    Args:
        v: view of one record.
        north, east: middle of its axle [m].
        down: of the floor under it [m].
        heading: [rad], clockwise from north, -pi .. pi.
        seed: of its random numbers.
    """
    b, c = v.body, v.command
    b.north, b.east, b.down, b.heading = north, east, down, heading
    b.speed, b.yaw_rate, b.clearance, b.collided = 0.0, 0.0, 0.0, False
    c.forward, c.turn, c.time_us = 0.0, 0.0, _LONG_AGO
    v.time_us = 0
    seed_rng(v.rng, seed)
