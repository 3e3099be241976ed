# SPDX-License-Identifier: BSD-3-Clause
"""Figures of every body."""

from __future__ import annotations

import math

from .figure import Figure

BODY = (
    Figure("mass", "kg", "everything included", 1e-3, 1e4),
    Figure("inertia", "kg m^2", "about body x, y, z", 1e-9, 1e6, length=3),
)

OUTLINE_DISCS = 3
"""Greatest number of discs that a vehicle's outline is made of."""

OUTLINE = (  # that touches the solids of a world: upright discs, one behind the other
    Figure("contact_discs", "", "how many of them", 1, OUTLINE_DISCS, 1, whole=True),
    Figure(
        "contact_along", "m", "their middles, forward of the origin", -100.0, 100.0, (0.0,) * OUTLINE_DISCS,
        length=OUTLINE_DISCS,
    ),
    Figure("contact_radius", "m", "of each", 0.0, 100.0, 0.0),
    Figure("contact_top", "m", "how far they reach above the origin", 0.0, 100.0, 0.0),
    Figure("contact_bottom", "m", "how far they reach below the origin", 0.0, 100.0, 0.0),
    Figure("base_along", "m", "what start poses of a world mean, forward of the origin", -math.inf, default=0.0),
)  # fmt: skip
