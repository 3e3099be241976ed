# SPDX-License-Identifier: BSD-3-Clause
"""What the sequencer tells the outside: the bridge turns each into a message."""

from __future__ import annotations

from dataclasses import dataclass

from .item import MissionItem

INFO = 6
"""MAV_SEVERITY"""
CRITICAL = 2
NOTICE = 5
WARNING = 4


@dataclass(frozen=True, slots=True)
class Text:
    """STATUSTEXT."""

    severity: int
    text: str


@dataclass(frozen=True, slots=True)
class ItemReached:
    """MISSION_ITEM_REACHED."""

    seq: int


@dataclass(frozen=True, slots=True)
class CurrentChanged:
    """MISSION_CURRENT."""

    seq: int


@dataclass(frozen=True, slots=True)
class OutputItem:
    """A do-command about servo outputs, relays or the camera, to be carried out now."""

    item: MissionItem


Note = Text | ItemReached | CurrentChanged | OutputItem
