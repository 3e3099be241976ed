# SPDX-License-Identifier: BSD-3-Clause
"""What logs need to know of a kind of vehicle: part "logs" of ``sitl.vehicle.kind.Kind``."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ..vehicle.kinds import KINDS

if TYPE_CHECKING:
    from .dataflash.formats import Message
    from .tlog_flight import Flight


@dataclass(frozen=True)
class KindLogs:
    """Logs of one kind of vehicle."""

    messages: Callable[[int, int, bool], tuple[Message, ...]]
    """``messages(LOG_BITMASK, boot [unix us], simulated)`` of a DataFlash log."""
    title: str
    """What readers know the firmware by: its name in MSG."""
    build_type: int
    """Its number in VER."""
    word: str
    """A word of MSG that tells logs of this kind, also of other builds."""
    mav_types: tuple[int, ...]
    """MAV_TYPEs whose telemetry logs can be read as this kind's."""
    mode_names: tuple[str, ...]
    """ArduPilot's names of all modes by their numbers, those that we do not have included; "-": not in use."""
    saved: Callable[[Any], tuple[str, ...]] | None = None
    """Parameters that the firmware learns in flight and saves with each disarming, of the vehicle's record."""
    parameters: tuple[str, ...] = ()
    """Parameters that no other firmware has: they tell logs of this kind that do not name the firmware."""
    panels: tuple[Callable[[Any, Flight], None], ...] = ()
    """What a picture of a flight shows beside the plan view: three functions of (axes, flight)."""


def logs_of(kind: str) -> KindLogs:
    """Of a kind of vehicle, by its name.

    Raises:
        UnknownKindError, MissingPartError: there is no such kind, or it keeps no logs.
    """
    return KINDS[kind].part("logs", KindLogs)


def kinds_with_logs() -> dict[str, KindLogs]:
    """All kinds that keep logs, by their names."""
    return {name: logs_of(name) for name, kind in KINDS.items() if "logs" in kind.parts}


def kind_of_mav_type(number: int) -> str | None:
    """Name of the kind that a MAV_TYPE's logs are of; None: of none."""
    return next((name for name, logs in kinds_with_logs().items() if number in logs.mav_types), None)


def mode_name(kind: str, number: int) -> str:
    """Name of a mode of ArduPilot's; "MODE 30" when it has none."""
    names = logs_of(kind).mode_names
    return names[number] if 0 <= number < len(names) and names[number] != "-" else f"MODE {number}"
