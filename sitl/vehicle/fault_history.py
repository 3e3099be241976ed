# SPDX-License-Identifier: BSD-3-Clause
"""Which faults have acted on a vehicle, from when to when: a test whose fault never acted has tested nothing.

A fault acts while it is in force, simulated time goes by, what it sets is not what was set before, and the vehicle
uses what fails: motors and servos while it is armed, sensors while they are switched on.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from ..core.constants import NEVER
from .acting import Value, acts_not
from .faults import Failure
from .ordered_faults import Ordered

Key = tuple[str, int]
"""Text of a fault and simulated time of its begin [us]."""


@dataclass
class Acted:
    """A fault, and when it acted."""

    fault: str
    begin_us: int
    """When it was to begin, simulated time since the start [us]."""
    end_us: int = NEVER
    spans: list[tuple[int, int]] = field(default_factory=list)
    """(begin, end) of the times in which it acted [us]."""
    why: str = "it was repaired before it began"
    """Why it did not act when it was last looked at."""

    @property
    def key(self) -> Key:
        """Of the fault that was ordered."""
        return (self.fault, self.begin_us)

    @property
    def title(self) -> str:
        """The fault without its times."""
        return self.fault.partition("@")[0]

    def __str__(self) -> str:
        if not self.spans:
            return f"fault {self.title} never acted: {self.why}"
        spans = ", ".join(f"{begin * 1e-6:.1f} to {end * 1e-6:.1f} s" for begin, end in self.spans)
        return f"fault {self.title} acted from {spans}"


class FaultHistory:
    """Of one vehicle; it is told whenever something changes."""

    def __init__(self) -> None:
        self.faults: list[Acted] = []
        """In the order in which they were ordered."""
        self._open: dict[int, int] = {}
        """Number of a fault that acts now -> since when [us]."""
        self._now_us = 0

    def ordered(self, order: Ordered, lasts_us: int) -> Acted:
        """One more was ordered, which lasts so long at most."""
        end_us = min(order.end_us, order.begin_us + lasts_us)
        self.faults.append(Acted(order.fault, order.begin_us, end_us))
        return self.faults[-1]

    def look(self, now_us: int, states: Mapping[Key, str]) -> None:
        """What is in force from now on.

        Args:
            now_us: simulated time since the start. Earlier than the last time after a snapshot was restored: what acted
                did so until the last time.
            states: each fault that has begun and is not over -> why it does not act; "": it does.
        """
        last_us, self._now_us = self._now_us, now_us
        for number in list(self._open):
            if now_us < last_us or states.get(self.faults[number].key) != "":
                self._close(number, max(now_us, last_us))
        for number, acted in enumerate(self.faults):
            state = states.get(acted.key)
            if state:
                acted.why = state
            elif state is not None:
                self._open.setdefault(number, now_us)

    def finish(self, now_us: int) -> list[Acted]:
        """All faults, as far as they have acted until now; those that act go on."""
        for number in list(self._open):
            self._close(number, now_us)
            self._open[number] = now_us
        for number, acted in enumerate(self.faults):
            if not acted.spans and acted.begin_us > now_us:
                acted.why = f"it begins at {acted.begin_us * 1e-6:.1f} s, and the flight ended at {now_us * 1e-6:.1f} s"
            elif not acted.spans and number in self._open:
                acted.why = "no simulated time went by"
        return self.faults

    def _close(self, number: int, until_us: int) -> None:
        acted, since_us = self.faults[number], self._open.pop(number)
        until_us = min(until_us, acted.end_us)
        if acted.spans and acted.spans[-1][1] == since_us < until_us:
            acted.spans[-1] = (acted.spans[-1][0], until_us)
        elif since_us < until_us:
            acted.spans.append((since_us, until_us))


def changes_nothing(failure: Failure, values: Mapping[str, float], before: Mapping[str, float], present: Value) -> str:
    """Why values of a fault do nothing; "": they do something.

    Args:
        failure: the fault.
        values: parameters that it sets.
        before: what they were without it.
        present: gives what is in force of all parameters.
    """
    if failure.unit in ("motor", "servo") and failure.type == "off" and failure.amount == 1.0:
        return "all of the pulse is left"
    reasons = [
        f"{name} was {value:g} before, too" if before.get(name) == value else acts_not(name, present)
        for name, value in values.items()
    ]
    return reasons[0] if all(reasons) and reasons else ""
