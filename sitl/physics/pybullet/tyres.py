# SPDX-License-Identifier: BSD-3-Clause
"""Tyres that scrub: the friction of wheels that slide all the time, as skid steering wants it.

Bullet's own friction holds a tyre that rolls (the steered rovers use it), but of one that slides it turns the force
only slowly into the direction of the sliding: a turn on the spot swings. Here the force of each tyre is friction by
load, against the sliding of its contact point, and fades out below a creep speed, as rubber's does.
"""

from __future__ import annotations

import math

CREEP = 0.1
"""Sliding below this has a force in proportion to it [m/s]."""


def scrub(along: float, across: float, limit: float) -> tuple[float, float]:
    """Force of a tyre on the vehicle, along and across [N].

    Args:
        along: speed of the contact point over the floor, forward [m/s]: that of the hub less that of the rim.
        across: the same to the left.
        limit: friction coefficient times load [N].
    """
    k = -limit / max(math.sqrt(along * along + across * across), CREEP)
    return k * along, k * across
