# SPDX-License-Identifier: BSD-3-Clause
"""The compiled call: any number of Turtlebots in one world, each moved on by its own number of ticks, then its scan."""

from __future__ import annotations

import math
from typing import Any

from ....core.array_kernels import kernel
from ....core.kernels import law
from .scan import scan
from .state import Turtlebot
from .step import step


@law
def advance_fleet(fleet, commands, ticks, solids, grid, cells, rays, directions, ranges, readings):
    """Command the robots, move them on, read their lidars.

    Args:
        fleet: records, shape (n,).
        commands: forward speed [m/s] and turn rate [rad/s], counter-clockwise, shape (n, 2); a row that begins with nan
            is no new command: the last one holds until its time-out.
        ticks: how far each moves on [physics steps], shape (n,); 0: only its lidar is read; -1: neither.
        solids, grid, cells: of the world's ``Geometry``.
        rays: unit vectors on the body, FRD, shape (3, rays).
        directions, ranges: room to work in, shapes (3, rays), (rays,).
        readings: float32, shape (n, readings) [m].
    """
    for i in range(ticks.shape[0]):
        if ticks[i] < 0:
            continue
        v = fleet[i]
        if ticks[i] > 0:
            v.body.collided = 0
            if not math.isnan(commands[i, 0]):
                c = v.command
                c.forward, c.turn, c.time_us = commands[i, 0], commands[i, 1], v.time_us
        for _ in range(ticks[i]):
            step(v, solids)
        scan(v, solids, grid, cells, rays, directions, ranges, readings[i])


def _signature() -> Any:
    from numba import types

    from ....core.numba_records import numba_type

    fleet = types.Array(numba_type(Turtlebot), 1, "C")
    line, table, whole = types.float64[::1], types.float64[:, ::1], types.int64[::1]
    return types.void(fleet, table, whole, table, line, whole, table, table, line, types.float32[:, ::1])


advance = kernel(_signature)(advance_fleet)
