# SPDX-License-Identifier: BSD-3-Clause
"""Past positions and velocities, so that a late measurement meets the state of its own time.

Every correction moves the past states along (``correct_past``), as do resets (``shift``).
"""

from __future__ import annotations

from typing import NamedTuple

from ...core.algebra import row_vector, set_row_vector
from ...core.kernels import law
from ...core.vectors import Vec3
from .state import RING, Ekf


class Past(NamedTuple):
    """Where the vehicle was."""

    pos: Vec3  # NED [m]
    vel: Vec3  # NED [m/s]


@law
def keep(ekf: Ekf) -> None:
    """Keep the present state in the ring."""
    n = ekf.ring_count % RING
    ekf.ring_us[n] = ekf.now_us
    set_row_vector(ekf.ring_pos, n, ekf.pos)
    set_row_vector(ekf.ring_vel, n, ekf.vel)
    ekf.ring_count += 1


@law
def past_at(ekf: Ekf, when_us: int) -> Past:
    """The past state at a time, between those kept before and after it."""
    last = ekf.ring_count - 1
    first = max(0, ekf.ring_count - RING)
    n = last
    while n > first and ekf.ring_us[n % RING] > when_us:
        n -= 1
    a, b = n % RING, min(n + 1, last) % RING
    span = ekf.ring_us[b] - ekf.ring_us[a]
    share = 0.0
    if span > 0:
        share = min(max((when_us - ekf.ring_us[a]) / span, 0.0), 1.0)
    pos, vel = row_vector(ekf.ring_pos, a), row_vector(ekf.ring_vel, a)
    return Past(
        pos + share * (row_vector(ekf.ring_pos, b) - pos),
        vel + share * (row_vector(ekf.ring_vel, b) - vel),
    )


@law
def shift(ekf: Ekf, dp: Vec3, dv: Vec3) -> None:
    """Move the past states by a jump in position [m] and velocity [m/s]."""
    for n in range(RING):
        set_row_vector(ekf.ring_pos, n, row_vector(ekf.ring_pos, n) + dp)
        set_row_vector(ekf.ring_vel, n, row_vector(ekf.ring_vel, n) + dv)


@law
def correct_past(ekf: Ekf, dp: Vec3, dv: Vec3) -> None:
    """Move the past states with a correction made now: it means dp - dv * age for a position of that age."""
    for n in range(RING):
        age = 1e-6 * (ekf.now_us - ekf.ring_us[n])
        set_row_vector(ekf.ring_vel, n, row_vector(ekf.ring_vel, n) + dv)
        set_row_vector(ekf.ring_pos, n, row_vector(ekf.ring_pos, n) + (dp - age * dv))
