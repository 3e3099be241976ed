# SPDX-License-Identifier: BSD-3-Clause
"""Small laws on numbers."""

from __future__ import annotations

import math

from .kernels import inlined

PI = math.pi
TWO_PI = 2.0 * math.pi


@inlined
def constrain(value: float, low: float, high: float) -> float:
    """``value`` limited to [low, high]; NaN gives the middle, as ArduPilot's constrain does."""
    if value != value:
        return 0.5 * (low + high)
    if value < low:
        return low
    if value > high:
        return high
    return value


@inlined
def finite(value: float) -> bool:
    """Whether a float is neither NaN nor infinite (infinity minus itself is NaN)."""
    return value - value == 0.0


@inlined
def is_same(a: float, b: float) -> bool:
    """Whether two floats are equal in sign, too: 0.0 and -0.0 are not; NaN equals nothing."""
    return a == b and (a != 0.0 or math.copysign(1.0, a) == math.copysign(1.0, b))


@inlined
def sign(value: float) -> float:
    """-1.0, 0.0 or 1.0: the sign of a number."""
    if value > 0.0:
        return 1.0
    if value < 0.0:
        return -1.0
    return 0.0


@inlined
def wrap_pi(angle: float) -> float:
    """``angle`` [rad] wrapped to [-pi, pi), the ends to rounding."""
    return angle - TWO_PI * math.floor((angle + PI) / TWO_PI)


@inlined
def wrap_2pi(angle: float) -> float:
    """``angle`` [rad] wrapped to [0, 2 pi), the ends to rounding."""
    return angle - TWO_PI * math.floor(angle / TWO_PI)
