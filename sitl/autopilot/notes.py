# SPDX-License-Identifier: BSD-3-Clause
"""What the autopilot reports to the outside besides telemetry: the bridge turns each into a message, or acts on it."""

from __future__ import annotations

from dataclasses import dataclass


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
class Switched:
    """A switch of something that is fitted to the vehicle was moved (``payload.SWITCH_*``)."""

    function: int
    position: int


@dataclass(frozen=True, slots=True)
class ParametersFound:
    """The firmware has changed these parameters for good: clients are sent them, and they are kept."""

    names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class ChecksFailed:
    """Arming was refused; clients get the reasons."""

    failed: int
    """Bits of the failed checks (``arming_checks``)."""


EventNote = Text | ItemReached | Switched | ParametersFound | ChecksFailed
"""What follows from an event of the core."""
