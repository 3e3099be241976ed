# SPDX-License-Identifier: BSD-3-Clause
"""Limits in height of the rover's fence."""

from __future__ import annotations

from ...core.vectors import Vec3

HEIGHTS = Vec3(100.0, -10.0, 0.0)
"""Greatest and least height, which bits 1 and 8 of FENCE_TYPE choose, and no parameter sets [m]; FENCE_AUTOENABLE."""
