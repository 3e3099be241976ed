# SPDX-License-Identifier: BSD-3-Clause
"""Who hears of what services do: logs, recordings."""

from __future__ import annotations

from typing import Any, Protocol

Sender = tuple[int, int]
"""(system id, component id) of who sent a message."""


class Listener(Protocol):
    """Hears of texts, parameters, commands and progress when they happen; it changes nothing."""

    def said(self, severity: int, text: str) -> None:
        """A text goes out to all clients, with its MAV_SEVERITY."""
        ...

    def parameter_set(self, name: str) -> None:
        """A client has set a parameter; the record has the new value."""
        ...

    def reached(self, seq: int) -> None:
        """A mission item was reached (MISSION_ITEM_REACHED)."""
        ...

    def commanded(self, fields: Any, frame: int, is_location: bool, sender: Sender, result: int) -> None:
        """A COMMAND_LONG or COMMAND_INT was answered.

        Args:
            fields: of the message.
            frame, is_location: of a COMMAND_LONG: the MAV_FRAME that it is taken in, whether p5 and p6 are degrees.
            sender: its system and component.
            result: MAV_RESULT.
        """
        ...
