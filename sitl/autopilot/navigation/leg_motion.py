# SPDX-License-Identifier: BSD-3-Clause
"""Where along a leg: evaluates the polynomials that ``leg.plan`` made."""

from __future__ import annotations

from ...core.kernels import law
from ..control.shaping import Motion
from .state import Leg


@law
def evaluate(leg: Leg, t: float) -> Motion:
    """Motion along the leg at path time ``t`` [s] since its start.

    At and after the duration it is the last segment: the end of the leg, at its end speed. A leg without
    segments stays at zero.
    """
    n = leg.segments
    if n < 1:
        return Motion(0.0, 0.0, 0.0)
    k = leg.k
    if k >= n or t < leg.t[k]:
        k = 0
    while k + 1 < n and t >= leg.t[k + 1]:
        k += 1
    h = max(t - leg.t[k], 0.0)
    s = leg.s[k]
    j = leg.j[k]
    a = leg.a[k]
    v = leg.v[k]
    p = leg.p[k] + h * (v + h * (0.5 * a + h * (j / 6.0 + h * s / 24.0)))
    return Motion(p, v + h * (a + h * (0.5 * j + h * s / 6.0)), a + h * (j + h * 0.5 * s))


@law
def step(leg: Leg, dt: float) -> None:
    """Move path time on by ``dt`` [s], at most to the end of the leg."""
    leg.elapsed = min(leg.elapsed + dt, leg.duration)
    k = leg.k
    while k + 1 < leg.segments and leg.elapsed >= leg.t[k + 1]:
        k += 1
    leg.k = k


@law
def remaining(leg: Leg) -> float:
    """Path time to the end of the leg [s]."""
    return max(leg.duration - leg.elapsed, 0.0)


@law
def finished(leg: Leg) -> bool:
    """Whether path time has come to the end of the leg."""
    return leg.elapsed >= leg.duration


@law
def clear(leg: Leg) -> None:
    """Forget the leg."""
    leg.segments = 0
    leg.started = False
    leg.k = 0
    leg.elapsed = 0.0
    leg.duration = 0.0
    leg.fast = False
