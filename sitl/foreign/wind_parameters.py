# SPDX-License-Identifier: BSD-3-Clause
"""The wind that an ArduPilot's parameters say, on our physics."""

from __future__ import annotations

from collections import deque

from ..bridge.dialect import message
from ..bridge.frame import MARK_V1, MARK_V2, Splitter
from ..plants.local import LocalPlant
from ..plants.physics_server import SimulatedPlant
from .choice import WIND

_VALUE = message("PARAM_VALUE")


class Wind:
    """Follows SIM_WIND_ parameters: an ArduPilot tells their value when a client sets or reads them.

    Args:
        plant: the physics.
    """

    def __init__(self, plant: LocalPlant) -> None:
        self._set = SimulatedPlant(plant).set_parameter
        self._received: deque[tuple[str, float]] = deque()

    def frame(self, raw: bytes) -> None:
        """One frame of the autopilot or a client; in any thread."""
        is_value = raw[7:10] == _VALUE.wire_id if raw[0] == MARK_V2 else raw[0] == MARK_V1 and raw[5] == _VALUE.id
        if not is_value:
            return
        for frame in Splitter().feed(raw):
            fields = frame.kind.decode(frame.payload)
            name = fields.param_id.decode("ascii", "replace")
            if name.startswith(WIND):
                self._received.append((name, float(fields.param_value)))

    def blow(self) -> None:
        """Let the physics have what was told since; in its own thread, between two ticks."""
        while self._received:
            self._set(*self._received.popleft())
