# SPDX-License-Identifier: BSD-3-Clause
"""A companion that answers a vehicle's TERRAIN_REQUESTs, as ground stations do that know the heights of the ground."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..autopilot.terrain.grid import PARTS, Block, measured
from .companion import Companion
from .session import Session

Heights = Callable[[float, float], float | None]
"""Height of the ground [m above sea level] at a latitude and a longitude [deg]; None: not known."""
RATE_HZ = 1.0


class TerrainAnswers(Companion):
    """Tells a vehicle the heights that it asks for, from ``start`` to ``stop``.

    Args:
        client: of the vehicle, which is sent TERRAIN_REPORT from the start on: who gets this is asked.
        heights: of the ground.
    """

    def __init__(self, client: Session, heights: Heights) -> None:
        super().__init__(client)
        self._heights = heights
        self.answers = 0
        """Parts of the grid that have been told."""

    def start(self) -> TerrainAnswers:
        """Answer from now on."""
        self.client.set_rate("TERRAIN_REPORT", RATE_HZ)
        super().start()
        return self

    def step(self, now_us: int) -> None:
        """It sends when it is asked."""

    def take(self, name: str, fields: Any) -> None:
        """Answer a TERRAIN_REQUEST with as many TERRAIN_DATA as it asks for parts."""
        if name != "TERRAIN_REQUEST" or fields.grid_spacing == 0:
            return
        lat, lon, spacing = fields.lat, fields.lon, fields.grid_spacing
        for part in range(PARTS):
            if not fields.mask >> part & 1:
                continue
            data = measured(Block(lat, lon), part, spacing, self._heights)
            if data is not None:
                self.client.send("TERRAIN_DATA", lat=lat, lon=lon, grid_spacing=spacing, gridbit=part, data=data)
                self.answers += 1

    def state(self) -> dict[str, Any]:
        """What it knows: a copy."""
        return {"answers": self.answers}

    def restored(self, state: dict[str, Any], client: Session) -> Companion:
        """This one, or for another client one like it, in that state."""
        found = self if client is self.client else TerrainAnswers(client, self._heights)
        found.answers = state["answers"]
        return found
