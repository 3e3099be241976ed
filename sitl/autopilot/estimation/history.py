# SPDX-License-Identifier: BSD-3-Clause
"""Past positions and velocities, so that a late measurement meets the state of its own time.

Every correction moves the past states along (``fusion.inject``), as do resets.
"""

from __future__ import annotations

from ...core.kernels import law
from .state import RING


@law
def keep(ekf, now_us):
    """Keep the present state in the ring."""
    n = ekf.ring_count % RING
    ekf.ring_us[n] = now_us
    for k in range(3):
        ekf.ring_pos[n, k] = ekf.pos[k]
        ekf.ring_vel[n, k] = ekf.vel[k]
    ekf.ring_count += 1


@law
def slot_at(ekf, when_us):
    """(ring slot at or before a time, the following one, share of the way between) of the past states."""
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
    return (a, b, share)


@law
def shift(ekf, axis, dp, dv):
    """Move the past states on one axis by a jump in position [m] and velocity [m/s]."""
    for n in range(RING):
        ekf.ring_pos[n, axis] += dp
        ekf.ring_vel[n, axis] += dv
