# SPDX-License-Identifier: BSD-3-Clause
"""Answers a vehicle's TERRAIN_REQUESTs, as ground stations do that know the heights of the ground."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..autopilot.terrain.grid import PARTS, Block, measured
from .session import Session

Heights = Callable[[float, float], float | None]
"""Height of the ground [m above sea level] at a latitude and a longitude [deg]; None: not known."""
RATE_HZ = 1.0


class TerrainAnswers:
    """Tells a vehicle the heights of the ground: made once, it answers whenever the vehicle asks.

    Args:
        client: of the vehicle. It is sent TERRAIN_REPORT from now on: who gets this is asked.
        heights: of the ground.
    """

    def __init__(self, client: Session, heights: Heights) -> None:
        self._client, self._heights = client, heights
        self.answers = 0
        """Parts of the grid that have been told."""
        self._requests: list[Any] = []
        client.collected("TERRAIN_REQUEST", self._requests)
        client.set_rate("TERRAIN_REPORT", RATE_HZ)
        client.companions.append(self._answer)

    def _answer(self) -> None:
        for m in self._requests:
            block, spacing = Block(m.lat, m.lon), m.grid_spacing
            for part in range(PARTS):
                data = measured(block, part, spacing, self._heights) if m.mask >> part & 1 and spacing else None
                if data is not None:
                    self._client.send(
                        "TERRAIN_DATA", lat=m.lat, lon=m.lon, grid_spacing=spacing, gridbit=part, data=data
                    )
                    self.answers += 1
        self._requests.clear()
