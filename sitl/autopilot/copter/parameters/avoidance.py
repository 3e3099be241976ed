# SPDX-License-Identifier: BSD-3-Clause
"""What only a copter has of the parameters of proximity and avoidance."""

from __future__ import annotations

from ...params import avoidance
from ...params.parameter import INT8, INT16, param


class Proximity(avoidance.Proximity):
    """PRX_: what is seen around the vehicle."""

    IGN_GND: float = param(0, 0, 1, "", "1: what is less than a metre over the ground is not seen (range-finder)", INT8)
    ALT_MIN: float = param(1.0, 0.0, 10.0, "m", "Nothing is seen below this height over the ground (range-finder)")


class Avoid(avoidance.Avoid):
    """AVOID_: stops before obstacles and fences, or slides along them."""

    ANGLE_MAX: float = param(1000, 0, 4500, "cdeg", "Lean away from obstacles in ALT_HOLD, at most; 0: none", INT16)
    DIST_MAX: float = param(5.0, 1.0, 30.0, "m", "In ALT_HOLD it leans away from what is nearer")
    ALT_MIN: float = param(0.0, 0.0, 10.0, "m", "Obstacles are not avoided below this height (range-finder); 0: always")
