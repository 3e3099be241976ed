# SPDX-License-Identifier: BSD-3-Clause
"""What the core reports to the shell: a ring of (time, code, two numbers) in the record, and what an event is.

An event is declared once, in the file of the feature whose law emits it, with what is said and logged of it.
``FIRMWARE/events.py`` lists those of a firmware; the bridge and the logs act by that list.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from typing import Any

from ..core.extensions import ExtensionError, Extensions
from ..core.kernels import law
from ..core.mavlink import MavSeverity
from ..core.records import Floats, Ints, Record, array
from .notes import EventNote, Text

EVENT_RING = 64
_EXTENSIONS = Extensions("SITL_EVENTS", "event")

Row = tuple[str, tuple[Any, ...]]
"""A message of a DataFlash log: its name, and its values behind TimeUS."""
Says = str | Mapping[int, str | tuple[int, str]] | Callable[[Any, float, float], Sequence[EventNote]]
Log = Row | Callable[[Any, float, float], Sequence[Row]]


class Event(int):
    """A code that laws emit with two numbers, ``a`` and ``b``::

        LOST = Event(40, MavSeverity.EMERGENCY, "Potential Thrust Loss ({a:.0f})", log=err(THRUST_LOSS_CHECK, 1))

    Args:
        code: its number in the ring; no other event of the firmware has it.
        severity: MAV_SEVERITY of its text.
        says: its text (STATUSTEXT), as a format of ``a`` and ``b``; or one for each whole number ``a``, which may bring
            a severity of its own; or a function of the vehicle's record, ``a`` and ``b`` that gives all that is
            reported.
            Empty: nothing is.
        log: its message in a DataFlash log, or a function, as above, that gives its messages.
    """

    severity: int
    says: Says
    log: Log | None

    def __new__(cls, code: int, severity: int = MavSeverity.INFO, says: Says = "", log: Log | None = None) -> Event:
        self = super().__new__(cls, code)
        self.severity, self.says, self.log = severity, says, log
        return self

    def saying(self, severity: int = MavSeverity.INFO, says: Says = "", log: Log | None = None) -> Event:
        """The same event in a firmware that has its own words for it, and (``log``) its own messages."""
        return Event(self, severity, says, log or self.log)

    def notes(self, v: Any, a: float, b: float) -> Sequence[EventNote]:
        """What is reported of it, as the vehicle's record ``v`` is."""
        says, severity = self.says, self.severity
        if callable(says):
            return says(v, a, b)
        if isinstance(says, Mapping):
            chosen = says[int(a)]
            severity, says = (severity, chosen) if isinstance(chosen, str) else chosen
        return [Text(severity, says.format(a=a, b=b))] if says else []

    def rows(self, v: Any, a: float, b: float) -> Sequence[Row]:
        """What is logged of it, as the vehicle's record ``v`` is."""
        if self.log is None:
            return []
        return self.log(v, a, b) if callable(self.log) else [self.log]


def ev(number: int) -> Row:
    """EV (https://ardupilot.org/copter/docs/logmessages.html#ev)."""
    return "EV", (number,)


def err(subsystem: int, code: int) -> Row:
    """ERR (https://ardupilot.org/copter/docs/logmessages.html#err)."""
    return "ERR", (subsystem, code)


def register_event(firmware: str, reference: str) -> None:
    """Give a firmware an event of another package, before the firmware is imported.

    Args:
        firmware: "copter" or "rover".
        reference: where the ``Event`` is: "package.module:NAME", importable by that name.

    Raises:
        ExtensionError: too late, or ``reference`` is no such text.
    """
    _EXTENSIONS.add(firmware, reference)


def with_registered(firmware: str, listed: Sequence[Event]) -> dict[int, Event]:
    """A firmware's own events by their codes, in their order, then those that other packages gave it.

    Raises:
        ValueError: the codes of its own are not in order, or two have one code.
        ExtensionError: one cannot be imported, is no event, or has a code that is taken.
    """
    for before, event in pairwise(listed):
        if event <= before:
            where = f"events of the {firmware}: {int(event)} stands behind {int(before)}"
            raise ValueError(f"{where}; they are in the order of their numbers; the greatest is {max(listed):d}")
    events = {int(event): event for event in listed}
    for _, reference, found in _EXTENSIONS.of(firmware):
        if not isinstance(found, Event):
            raise ExtensionError(f"event {reference}: {found!r} is no Event")
        if int(found) in events:
            raise ExtensionError(f"event {reference}: the {firmware} has an event {int(found)} already")
        events[int(found)] = found
    return events


class Events(Record):
    """A ring of what happened, for the shell."""

    count: int  # events so far; event k is at k % EVENT_RING
    attention: bool  # the core returns to the shell at the end of this tick
    time_us: Ints = array(EVENT_RING, stored="i8")
    code: Ints = array(EVENT_RING, stored="i4")
    a: Floats = array(EVENT_RING)
    b: Floats = array(EVENT_RING)


@law
def emit(events: Events, time_us: int, code: int, a: float, b: float) -> None:
    """Append an event; the oldest is overwritten when the shell did not fetch it in time."""
    k = events.count % EVENT_RING
    events.time_us[k] = time_us
    events.code[k] = code
    events.a[k] = a
    events.b[k] = b
    events.count += 1


@law
def emit_and_return(events: Events, time_us: int, code: int, a: float, b: float) -> None:
    """Append an event that needs Python: the core returns to the shell at the end of this tick."""
    emit(events, time_us, code, a, b)
    events.attention = True
