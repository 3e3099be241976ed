# SPDX-License-Identifier: BSD-3-Clause
"""What a mode of any firmware is, why modes change or do not, and modes of other packages.

Each mode is a file of its firmware (``FIRMWARE/modes/NAME.py``) that ends with its ``MODE``.
``FIRMWARE/modes/table.py`` lists them, and all else that depends on the modes there are is made from that list.
"""

from __future__ import annotations

import importlib
import os
import re
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, TypeVar

from ..core.kernels import law
from ..errors import SitlError

# Why a mode changed (ArduPilot's ModeReason, the number that its logs carry)
REASON_RC = 1
REASON_GCS = 2
REASON_RADIO_FAILSAFE = 3
REASON_BATTERY_FAILSAFE = 4
REASON_GCS_FAILSAFE = 5
REASON_EKF_FAILSAFE = 6
REASON_MISSION_END = 8
REASON_THROTTLE_LAND_ESCAPE = 9
REASON_CRASH_FAILSAFE = 19
REASON_FAILSAFE = 25
REASON_INITIALISED = 26

# Why it did not
ACCEPTED = 0
NO_SUCH_MODE = 1
INIT_FAILED = 2
REQUIRES_POSITION = 3
THROTTLE_TOO_HIGH = 4
NEEDS_ALTITUDE = 5
MISSING_TAKEOFF = 6
NO_MISSION = 7

VARIABLE = "SITL_MODES"
"""Environment variable with the modes of other packages, "copter=package.module:MODE ...": processes started from this
one, those that compile too, know them."""
NUMBER_MAX = 2**24 - 1
"""A command of MAVLink carries the number as a float."""

V = TypeVar("V")
M = TypeVar("M", bound="Mode[Any]")


class ModeError(SitlError, ValueError):
    """A mode of another package that cannot be taken; the message says which, and why."""


@law
def accept(v: object) -> int:
    """Start of a mode that needs no preparation."""
    return ACCEPTED


@dataclass(frozen=True, kw_only=True)
class Mode(Generic[V]):
    """A mode: what it is called, what it needs, what it does. Firmwares add what only their modes have."""

    number: int
    """ArduPilot's custom mode."""
    name: str
    run: Callable[[V], None]
    """Law of one period."""
    start: Callable[[V], int] = accept
    """Law that prepares it: ACCEPTED, or why it cannot be entered (then it has changed nothing)."""
    needs_position: bool = False
    """Cannot be entered in motion without a position."""
    autonomous: bool = False
    """Moves without the pilot's sticks."""
    standard_mode: int = 0
    """MAV_STANDARD_MODE"""
    selectable: bool = True
    """By the user."""

    @property
    def description(self) -> str:
        """What the first paragraph of its file says of it."""
        text = " ".join((sys.modules[self.run.__module__].__doc__ or "").split("\n\n")[0].split())
        return text.removeprefix(f"{self.name}: ").rstrip(".")


def numbers(modes: Sequence[M], flag: str) -> tuple[int, ...]:
    """Numbers of the modes in which ``flag``, one of their attributes, is set."""
    return tuple(mode.number for mode in modes if getattr(mode, flag))


_listed: set[str] = set()
"""Firmwares whose list of modes is complete."""


def register_mode(firmware: str, place: str) -> None:
    """Give a firmware a mode of another package, before the firmware is imported.

    Args:
        firmware: "copter" or "rover".
        place: where its ``MODE`` is: "package.module:NAME", importable by that name.

    Raises:
        ModeError: there is no such firmware, its modes are listed already, or ``place`` is no such text.
    """
    if not (Path(__file__).parent / firmware / "modes" / "table.py").exists():
        raise ModeError(f"mode {place}: there is no firmware {firmware!r} to add it to")
    if firmware in _listed:
        raise ModeError(f"mode {place}: too late, the {firmware} firmware is loaded; register it before")
    if not re.fullmatch(r"[\w.]+:\w+", place):
        raise ModeError(f'mode {place!r}: where it is must be written as "package.module:NAME"')
    known = os.environ.get(VARIABLE, "").split()
    if f"{firmware}={place}" not in known:
        os.environ[VARIABLE] = " ".join((*known, f"{firmware}={place}"))


def with_registered(firmware: str, modes: tuple[M, ...]) -> tuple[M, ...]:
    """A firmware's own modes, then those that other packages gave it.

    Raises:
        ModeError: one cannot be imported, is no mode of this firmware, or has a number or name that is taken.
    """
    _listed.add(firmware)
    for entry in os.environ.get(VARIABLE, "").split():
        owner, _, place = entry.partition("=")
        if owner == firmware:
            modes += (_checked(place, _load(place), modes),)
    return modes


def _load(place: str) -> object:
    module, _, name = place.partition(":")
    try:
        return getattr(importlib.import_module(module), name)
    except (ImportError, AttributeError, ValueError) as error:
        raise ModeError(f"mode {place}: {error}") from error


def _checked(place: str, found: object, modes: tuple[M, ...]) -> M:
    kind = type(modes[0])
    if not isinstance(found, kind):
        raise ModeError(f"mode {place}: {found!r} is no {kind.__name__}")
    if not 0 <= found.number <= NUMBER_MAX:
        raise ModeError(f"mode {place}: number {found.number} is not within 0 .. {NUMBER_MAX}")
    for mode in modes:
        if found.number == mode.number or found.name == mode.name:
            raise ModeError(
                f"mode {place}: {found.name} ({found.number}) takes the place of {mode.name} ({mode.number})"
            )
    return found
