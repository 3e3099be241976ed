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
    is_sent: bool = True
    """False: only logs have it."""


@dataclass(frozen=True, slots=True)
class CurrentChanged:
    """MISSION_CURRENT."""

    seq: int


@dataclass(frozen=True, slots=True)
class OutputItem:
    """A do-command about what is fitted to the vehicle (``item.CARRIED_OUT``), to be carried out now."""

    item: MissionItem


@dataclass(frozen=True, slots=True)
class Switched:
    """A switch of something that is fitted to the vehicle was moved (``payload.SWITCH_*``)."""

    function: int
    position: int


@dataclass(frozen=True, slots=True)
class ParametersFound:
    """The firmware has changed these parameters for good: clients are told, and they are kept."""

    names: tuple[str, ...]


Note = Text | ItemReached | CurrentChanged | OutputItem | Switched | ParametersFound
