# SPDX-License-Identifier: BSD-3-Clause
"""Figures of every body."""

from __future__ import annotations

from .figure import Figure

BODY = (
    Figure("mass", "kg", "everything included", 1e-3, 1e4),
    Figure("inertia", "kg m^2", "about body x, y, z", 1e-9, 1e6, length=3),
)
