# SPDX-License-Identifier: BSD-3-Clause
"""Wind: a steady part that follows its setting, and first-order (Gauss-Markov) turbulence on each axis."""

from __future__ import annotations

import math

from ...core.algebra import ZERO
from ...core.kernels import law
from ...core.rng import Rng, normal_vector
from ...core.vectors import Vec3
from .records import Wind
from .tick import TICK_S

PERIOD_TICKS = 8
"""Wind is stepped every 20 ms."""
PERIOD_S = TICK_S * PERIOD_TICKS


@law
def target(speed: float, direction: float) -> Vec3:
    """Steady wind NED [m/s] of a speed [m/s] and the direction that it comes from [deg]."""
    angle = direction * (math.pi / 180.0)
    return Vec3(-speed * math.cos(angle), -speed * math.sin(angle), 0.0)


@law
def blow(w: Wind, rng: Rng) -> None:
    """Step the wind by ``PERIOD_S``; draws random numbers only with turbulence."""
    k = 1.0
    if w.time_constant > PERIOD_S:
        k = PERIOD_S / w.time_constant
    steady, aim = w.steady, target(w.speed, w.direction)
    w.steady = Vec3(steady.x + k * (aim.x - steady.x), steady.y + k * (aim.y - steady.y), steady.z)
    if w.turbulence > 0.0:
        left = 1.0 - k
        w.gust = left * w.gust + w.turbulence * math.sqrt(1.0 - left * left) * normal_vector(rng)
    else:
        w.gust = ZERO
    w.vel = w.steady + w.gust
