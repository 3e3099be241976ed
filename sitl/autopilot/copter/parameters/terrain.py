# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of the heights of the ground."""

from __future__ import annotations

from ...params.parameter import INT8, INT16, ParameterGroup, param


class TerrainData(ParameterGroup):
    """TERRAIN_: heights of the ground that ground stations know."""

    ENABLE: float = param(1, 0, 1, "", "1: they are asked for, and used", INT8)
    SPACING: float = param(100, 1, 10000, "m", "Distance between two points of the grid", INT16)
    OPTIONS: float = param(0, 0, 1, "", "1: nobody is asked for more", INT16)
    MARGIN: float = param(0.05, 0.0, 50000.0, "m", "Greatest distance of an answer's place from what was asked for")
    OFS_MAX: float = param(
        30.0,
        0.0,
        50.0,
        "m",
        "Most that the told height of the ground is corrected by, to be home's where it is armed",
    )
