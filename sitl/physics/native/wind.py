# SPDX-License-Identifier: BSD-3-Clause
"""Wind: a steady part that follows its setting, and first-order (Gauss-Markov) turbulence on each axis."""

from __future__ import annotations

import math

from ...core.algebra import ZERO
from ...core.constants import TICK_S
from ...core.elementary import sincos
from ...core.kernels import law
from ...core.rng import Rng, normal_vector
from ...core.vectors import Vec3
from .records import Wind

PERIOD_TICKS = 8
"""Wind is stepped every 20 ms."""
PERIOD_S = TICK_S * PERIOD_TICKS


@law
def target(speed: float, direction: float) -> Vec3:
    """Steady wind NED [m/s] of a speed [m/s] and the direction that it comes from [deg]."""
    angle = direction * (math.pi / 180.0)
    sine, cosine = sincos(angle)
    return Vec3(-speed * cosine, -speed * sine, 0.0)


SQUARE_ROOT, EVEN, LINEAR = 0, 1, 2
"""SIM_WIND_T"""


@law
def shaped(w: Wind, height: float) -> Vec3:
    """Steady wind NED [m/s] at a height above home [m], by profile and elevation."""
    speed = w.speed
    if w.profile == SQUARE_ROOT and height < w.full_height:
        speed *= math.sqrt(max(height, 0.0) / w.full_height)
    elif w.profile == LINEAR:
        speed = max(speed + (height - w.full_height) * w.gain, 0.0)
    angle = w.elevation * (math.pi / 180.0)
    sine, cosine = sincos(angle)
    along = target(speed * cosine, w.direction)
    return Vec3(along.x, along.y, -speed * sine)


@law
def aim(w: Wind, height: float) -> Vec3:
    """Steady wind NED [m/s] that is set, at a height above home [m]."""
    return shaped(w, height) if w.is_shaped else target(w.speed, w.direction)


@law
def stir(w: Wind, rng: Rng, k: float) -> None:
    """Step the gusts, of which they lose a share ``k``."""
    if w.turbulence > 0.0:
        left = 1.0 - k
        w.gust = left * w.gust + w.turbulence * math.sqrt(1.0 - left * left) * normal_vector(rng)
    else:
        w.gust = ZERO


@law
def share_of_period(w: Wind) -> float:
    """Share of the way to what it is going to be that the wind goes in ``PERIOD_S``."""
    return PERIOD_S / w.time_constant if w.time_constant > PERIOD_S else 1.0


@law
def blow(w: Wind, rng: Rng, height: float) -> None:
    """Step the wind at a height above home [m] by ``PERIOD_S``; draws random numbers only with turbulence."""
    k = share_of_period(w)
    steady, goal = w.steady, aim(w, height)
    w.steady = Vec3(
        steady.x + k * (goal.x - steady.x), steady.y + k * (goal.y - steady.y), steady.z + k * (goal.z - steady.z)
    )
    if not w.is_shared:
        stir(w, rng, k)
    w.vel = w.steady + w.gust
