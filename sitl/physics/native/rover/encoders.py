# SPDX-License-Identifier: BSD-3-Clause
"""Wheel encoders: how far the left and the right driven wheel have rolled, in whole counts."""

from __future__ import annotations

import math

from ....core.border import Sensors
from ....core.kernels import law
from ....core.vectors import Vec2


@law
def counted(distance: float, step: float) -> float:
    """A distance [m] in whole steps [m]; 0: continuous."""
    if step <= 0.0:
        return distance
    return math.floor(distance / step + 0.5) * step


@law
def sample(sensors: Sensors, rolled: Vec2, step: float, period: int, tick: int) -> None:
    """Write wheel_distance of wheels that have ``rolled`` so far, in steps [m], every ``period`` ticks (0: never)."""
    if period == 0 or tick % period != 1:
        return
    sensors.wheel_distance = Vec2(counted(rolled.x, step), counted(rolled.y, step))
    sensors.wheel_count += 1
