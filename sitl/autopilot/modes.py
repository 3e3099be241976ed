# SPDX-License-Identifier: BSD-3-Clause
"""What a mode of any firmware is, why modes change or do not, and modes of other packages.

Each mode is a file of its firmware (``FIRMWARE/modes/NAME.py``) that ends with its ``MODE``.
``FIRMWARE/modes/table.py`` lists them, and all else that depends on the modes there are is made from that list.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, Generic, TypeVar

from ..core.extensions import ExtensionError, Extensions
from ..core.kernels import law
from ..core.records import Record
from .events import Event, Events, emit, err
from .log_events import LogErrorSubsystem
from .state import Modes


class ModeReason(IntEnum):
    """Why a mode changed: ArduPilot's number, which its logs carry."""

    RC = 1
    GCS = 2
    RADIO_FAILSAFE = 3
    BATTERY_FAILSAFE = 4
    GCS_FAILSAFE = 5
    EKF_FAILSAFE = 6
    MISSION_END = 8
    THROTTLE_LAND_ESCAPE = 9
    FENCE_BREACHED = 10
    TERRAIN_FAILSAFE = 11
    FLIP_COMPLETE = 13
    THROW_COMPLETE = 16
    CRASH_FAILSAFE = 19
    FAILSAFE = 25
    INITIALISED = 26
    AUTO_RTL_EXIT = 44


class ModeResult(IntEnum):
    """Whether a mode can be entered, or why not."""

    ACCEPTED = 0
    NO_SUCH_MODE = 1
    INIT_FAILED = 2
    REQUIRES_POSITION = 3
    THROTTLE_TOO_HIGH = 4
    NEEDS_ALTITUDE = 5
    MISSING_TAKEOFF = 6
    NO_MISSION = 7
    NO_RETURN = 8
    NO_PATH = 9
    NO_LANDING = 10
    IN_FENCE_RECOVERY = 11
    NO_RADIO = 12
    GCS_BLOCKED = 13


MODE_CHANGED = Event(3, log=lambda v, a, b: [("MODE", (int(a) & 255, int(a) & 255, int(b) & 255))])
"""a: number, b: reason"""
MODE_REFUSED = Event(19, log=lambda v, a, b: [err(LogErrorSubsystem.FLIGHT_MODE, int(a) & 255)])
"""a: number, b: cause"""

_NO_SEQUENCE = "Unable to start landing sequence"
_HINTS: dict[int, str] = {
    ModeResult.MISSING_TAKEOFF: "Auto: Missing Takeoff Cmd",
    ModeResult.NO_MISSION: "No Mission. Can't set AUTO.",
    ModeResult.NO_RETURN: _NO_SEQUENCE,
    ModeResult.NO_LANDING: _NO_SEQUENCE,
}

NUMBER_MAX = 2**24 - 1
"""A command of MAVLink carries the number as a float."""
_EXTENSIONS = Extensions("SITL_MODES", "mode")
_STATES = Extensions("SITL_MODE_STATES", "state of modes")

V = TypeVar("V")
M = TypeVar("M", bound="Mode[Any]")
S = TypeVar("S", bound=Modes)


@law
def accept(v: object) -> int:
    """Start of a mode that needs no preparation."""
    return ModeResult.ACCEPTED


@law
def enter(modes: Modes, events: Events, time_us: int, number: int, reason: int, auto: int) -> None:
    """Note that mode ``number`` has begun, and why.

    The shell is notified; at once when ``auto``, the mode that flies missions, begins or ends.
    """
    modes.previous = modes.number
    modes.number = number
    modes.shown = 0
    modes.reason = reason
    modes.wanted = 0
    emit(events, time_us, MODE_CHANGED, float(number), float(reason))
    if number == auto or modes.previous == auto:
        events.attention = True


@law
def shown(modes: Modes) -> int:
    """Number of the mode as clients get it."""
    return modes.shown if modes.shown != 0 else modes.number


@law
def ask(modes: Modes, number: int, reason: int) -> None:
    """A mode asks for another one, which begins after its period."""
    modes.wanted = number + 1
    modes.wanted_reason = reason


@law
def take_asked(modes: Modes) -> int:
    """The mode that was asked for, once; -1 none."""
    number = modes.wanted - 1
    modes.wanted = 0
    return number


def refusal_texts(number: int, cause: int, failed: str) -> list[str]:
    """Status texts (MAV_SEVERITY_WARNING) of a refused mode change; empty when it was accepted.

    ``failed``: the firmware's own text of all causes but an unknown number.
    """
    if cause == ModeResult.ACCEPTED:
        return []
    if cause == ModeResult.NO_SUCH_MODE:
        return [f"No such mode {number}"]
    return [_HINTS[cause], failed] if cause in _HINTS else [failed]


@dataclass(frozen=True, kw_only=True)
class Mode(Generic[V]):
    """A mode: what it is called, what it needs, what it does. Firmwares add what only their modes have."""

    number: int
    """ArduPilot's custom mode."""
    name: str
    title: str = ""
    """As ground stations get it, where that is not the name."""
    run: Callable[[V], None]
    """Law of one period."""
    start: Callable[[V], int] = accept
    """Law that prepares it: ACCEPTED, or why it cannot be entered (then it has changed nothing)."""
    needs_position: bool = False
    """Cannot be entered in motion without a position."""
    needs_pilot: bool = False
    """Cannot be entered in radio failsafe, by anybody: nobody would fly it."""
    autonomous: bool = False
    """Moves without the pilot's sticks."""
    standard_mode: int = 0
    """MAV_STANDARD_MODE"""
    selectable: bool = True
    """By the user."""

    @property
    def description(self) -> str:
        """What its file says of it behind its name; empty when that begins otherwise."""
        text = " ".join((sys.modules[self.run.__module__].__doc__ or "").split("\n\n")[0].split())
        return text.removeprefix(f"{self.name}: ").rstrip(".") if text.startswith(f"{self.name}: ") else ""


def is_blocked(number: int, in_order: Sequence[int], block: float) -> bool:
    """Whether ground stations may not choose a mode.

    Args:
        number: of the mode.
        in_order: numbers of the modes that can be blocked, as the bits of ``block`` mean them.
        block: FLTMODE_GCSBLOCK.
    """
    return number in in_order and int(block) >> in_order.index(number) & 1 != 0


def numbers(modes: Sequence[M], flag: str) -> tuple[int, ...]:
    """Numbers of the modes in which ``flag``, one of their attributes, is set."""
    return tuple(mode.number for mode in modes if getattr(mode, flag))


def register_mode(firmware: str, reference: str) -> None:
    """Give a firmware a mode of another package, before the firmware is imported.

    Args:
        firmware: "copter" or "rover".
        reference: where its ``MODE`` is: "package.module:NAME", importable by that name.

    Raises:
        ExtensionError: too late, or ``reference`` is no such text.
    """
    _EXTENSIONS.add(firmware, reference)


def register_state(firmware: str, name: str, reference: str) -> None:
    """Give a firmware's record space for what a mode of another package remembers, before the firmware is imported.

    Laws read and write it as ``autopilot.modes.NAME``; it is zero at power-on, and part of snapshots.

    Args:
        firmware: "copter" or "rover".
        name: small letters, digits and "_", not taken.
        reference: where the class of the record is: "package.module:NAME", importable by that name. Its module imports
            nothing of the firmware.

    Raises:
        ExtensionError: too late, or an argument is no such text.
    """
    if not re.fullmatch(r"[a-z][a-z0-9_]*", name):
        raise ExtensionError(f"state of modes {reference}: name {name!r} is not small letters, digits and _")
    _STATES.add(f"{firmware}.{name}", reference)


def with_states(firmware: str, record: type[S]) -> type[S]:
    """A firmware's record of modes with the records that other packages gave it.

    Raises:
        ExtensionError: one cannot be imported, is no Record, or has a name that is taken.
    """
    return _STATES.join(firmware, record, Record)


def with_registered(firmware: str, modes: tuple[M, ...]) -> tuple[M, ...]:
    """A firmware's own modes, then those that other packages gave it.

    Raises:
        ExtensionError: one cannot be imported, is no mode of this firmware, or has a number or name that is taken.
    """
    kind = type(modes[0])
    for _, reference, found in _EXTENSIONS.of(firmware):
        if not isinstance(found, kind):
            raise ExtensionError(f"mode {reference}: {found!r} is no {kind.__name__}")
        if not 0 <= found.number <= NUMBER_MAX:
            raise ExtensionError(f"mode {reference}: number {found.number} is not within 0 .. {NUMBER_MAX}")
        for mode in modes:
            if found.number == mode.number or found.name == mode.name:
                taken = f"{mode.name} ({mode.number})"
                raise ExtensionError(f"mode {reference}: {found.name} ({found.number}) takes the place of {taken}")
        modes += (found,)
    return modes
