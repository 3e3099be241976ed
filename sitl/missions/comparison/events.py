# SPDX-License-Identifier: BSD-3-Clause
"""Compares the events of two flights: mission items, modes, status texts; missing, added, earlier, later."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from typing import Any

from .alignment import Pair
from .tolerance import Tolerance

MISSING, ADDED, SHIFTED = "missing", "added", "at another time"
_NUMBER = re.compile(r"-?\d+(\.\d+)?")


@dataclass(frozen=True)
class Event:
    """A mission item, a change of mode or a status text, in the golden flight, the new one, or both."""

    kind: str
    """"items", "modes" or "texts"."""
    what: str
    """Description: "item 3", "mode RTL", "'Arming motors'"."""
    golden: float | None
    new: float | None
    """Time since the common start [s]; None: the flight does not have it."""
    seq: int = -1
    """Number of the mission item; -1 for other kinds."""

    @property
    def shift(self) -> float:
        """Delay in the new flight [s]; 0 when only one flight has it."""
        return 0.0 if self.golden is None or self.new is None else self.new - self.golden

    @property
    def time(self) -> float:
        """Time for sorting: of the new flight, or of golden where only that has it [s]."""
        return self.new if self.new is not None else self.golden or 0.0

    def difference(self, limit: float) -> str:
        """MISSING, ADDED, SHIFTED (by more than ``limit`` [s]), or ""."""
        if self.new is None:
            return MISSING
        if self.golden is None:
            return ADDED
        return SHIFTED if abs(self.shift) > limit + 1e-6 else ""


def compare_events(pair: Pair, tolerance: Tolerance) -> list[Event]:
    """The events of both flights, in the order of time."""
    golden, new = pair.golden, pair.new

    def counts(event: tuple[float, int, str]) -> bool:
        return not any(pattern.search(event[2]) for pattern in tolerance.ignore)

    def text(event: Any) -> str:
        plain = event[2].rstrip()
        return plain if tolerance.numbers or plain.startswith(("Reached", "Mission:")) else _NUMBER.sub("#", plain)

    texts = [list(filter(counts, track.texts)) for track in (golden, new)]
    found = _matched("items", golden.items, new.items, lambda e: e[1], lambda e: f"item {e[1]}")
    found += _matched("modes", golden.modes, new.modes, lambda e: e[1], lambda e: f"mode {e[1]}")
    found += _matched("texts", texts[0], texts[1], text, lambda e: f"{e[2]!r}")
    return sorted(found, key=lambda event: event.time)


def _matched(
    kind: str,
    golden: Sequence[Any],
    new: Sequence[Any],
    key: Callable[[Any], Any],
    words: Callable[[Any], str],
) -> list[Event]:
    """Events in the longest common subsequence are matched; the others are missing or added."""
    found = []

    def note(first: Any, second: Any) -> None:
        event = first if first is not None else second
        seq = event[1] if kind == "items" else -1
        times = [None if one is None else float(one[0]) for one in (first, second)]
        found.append(Event(kind, words(event), times[0], times[1], seq))

    matcher = SequenceMatcher(None, [key(event) for event in golden], [key(event) for event in new], autojunk=False)
    for tag, a, b, c, d in matcher.get_opcodes():
        if tag == "equal":
            for first, second in zip(golden[a:b], new[c:d], strict=True):
                note(first, second)
        else:
            for first in golden[a:b]:
                note(first, None)
            for second in new[c:d]:
                note(None, second)
    return found
