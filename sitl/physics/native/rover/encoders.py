# SPDX-License-Identifier: BSD-3-Clause
"""Wheel encoders: how far the left and the right driven wheel have rolled, in whole counts."""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.vectors import Vec2


@law
def _counted(distance, step):
    if step <= 0.0:
        return distance
    return math.floor(distance / step + 0.5) * step


@law
def update(p, sensors, tick):
    """Write wheel_distance [m] when a sample falls due."""
    period = int(p.derived.encoder_period)
    if period == 0 or tick % period != 1:
        return
    rolled, step = p.wheels.distance, float(p.airframe.encoder_step)
    sensors.wheel_distance = Vec2(_counted(float(rolled[0]), step), _counted(float(rolled[1]), step))
    sensors.wheel_count += 1
