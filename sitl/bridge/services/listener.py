# SPDX-License-Identifier: BSD-3-Clause
"""Who is told what the services do, beside the clients: an on-board logger."""

from __future__ import annotations

from typing import Protocol


class Listener(Protocol):
    """Hears of texts, parameters and progress when they happen; it changes nothing."""

    def said(self, severity: int, text: str) -> None:
        """A text goes out to all clients, with its MAV_SEVERITY."""
        ...

    def parameter_set(self, name: str) -> None:
        """A client has set a parameter; the record has the new value."""
        ...

    def reached(self, seq: int) -> None:
        """A mission item was reached (MISSION_ITEM_REACHED)."""
        ...
