# SPDX-License-Identifier: BSD-3-Clause
"""What the sequencer reports to the outside: what all of the autopilot does, and do-commands for the outside."""

from __future__ import annotations

from dataclasses import dataclass

from ..notes import CurrentChanged, EventNote
from .item import MissionItem


@dataclass(frozen=True, slots=True)
class OutputItem:
    """A do-command about what is fitted to the vehicle (``item.CARRIED_OUT``), to be carried out now."""

    item: MissionItem


Note = EventNote | CurrentChanged | OutputItem
