# SPDX-License-Identifier: BSD-3-Clause
"""Figures of every body."""

from __future__ import annotations

import math

from ...core.records import Floats, Record
from ...core.vectors import Vec3
from .figure import figure


class Body(Record):
    """Every body."""

    mass: float = figure("kg", "everything included", 0.001, 1e4)
    inertia: Vec3 = figure("kg m^2", "about body x, y, z", 1e-9, 1e6)


OUTLINE_DISCS = 3
"""Greatest number of discs that a vehicle's outline is made of."""


class Outline(Record):
    """What touches the solids of a world: upright discs, one behind the other."""

    contact_discs: int = figure("", "how many of them", 1, OUTLINE_DISCS, 1)
    contact_along: Floats = figure(
        "m", "their middles, forward of the origin", -100.0, 100.0, (0.0,) * OUTLINE_DISCS, count=OUTLINE_DISCS
    )
    contact_radius: float = figure("m", "of each", 0.0, 100.0, 0.0)
    contact_top: float = figure("m", "how far they reach above the origin", 0.0, 100.0, 0.0)
    contact_bottom: float = figure("m", "how far they reach below the origin", 0.0, 100.0, 0.0)
    base_along: float = figure("m", "what start poses of a world mean, forward of the origin", -math.inf, default=0.0)
