# SPDX-License-Identifier: BSD-3-Clause
"""Wind: a steady part that follows its setting, and first-order (Gauss-Markov) turbulence on each axis."""

from __future__ import annotations

import math

from ...core.kernels import law
from ...core.rng import normal

PERIOD_TICKS = 8
"""Wind is stepped every 20 ms."""
PERIOD_S = 0.0025 * PERIOD_TICKS


@law
def target(w):
    """Steady wind vector (north, east) [m/s] that the settings ask for; direction is where it comes from."""
    angle = float(w.direction) * (math.pi / 180.0)
    return (-float(w.speed) * math.cos(angle), -float(w.speed) * math.sin(angle))


@law
def update(w, rng):
    """Step the wind record; draws random numbers only with turbulence."""
    north, east = target(w)
    k = 1.0
    if w.time_constant > PERIOD_S:
        k = PERIOD_S / float(w.time_constant)
    w.steady[0] += k * (north - float(w.steady[0]))
    w.steady[1] += k * (east - float(w.steady[1]))
    if w.turbulence > 0.0:
        left = 1.0 - k
        added = float(w.turbulence) * math.sqrt(1.0 - left * left)
        for j in range(3):
            w.gust[j] = left * float(w.gust[j]) + added * normal(rng)
    else:
        for j in range(3):
            w.gust[j] = 0.0
    for j in range(3):
        w.vel[j] = float(w.steady[j]) + float(w.gust[j])
