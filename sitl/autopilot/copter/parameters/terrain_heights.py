# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of the heights of the ground."""

from __future__ import annotations

from ...params.parameter import INT8, ParameterGroup, param


class TerrainData(ParameterGroup):
    """TERRAIN_: heights of the ground that ground stations know; the shell reads others (``terrain.grid.MEANINGS``)."""

    ENABLE: float = param(1, 0, 1, "", "1: they are asked for, and used", INT8)
