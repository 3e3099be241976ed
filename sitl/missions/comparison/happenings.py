# SPDX-License-Identifier: BSD-3-Clause
"""Compares what happened: mission items, modes, texts; what is missing, what is new, what came earlier or later."""

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
class Happening:
    """One thing that happened in golden, in the new flight, or in both."""

    kind: str
    """"items", "modes" or "texts"."""
    what: str
    """In words: "item 3", "mode RTL", "'Arming motors'"."""
    golden: float | None
    new: float | None
    """When, since the common start [s]."""
    seq: int = -1
    """Of an item."""

    @property
    def shift(self) -> float:
        """How much later it is in the new flight [s]; 0 when one has it alone."""
        return 0.0 if self.golden is None or self.new is None else self.new - self.golden

    @property
    def time(self) -> float:
        """When it is told: as the new flight has it, or golden."""
        return self.new if self.new is not None else self.golden or 0.0

    def difference(self, limit: float) -> str:
        """What is wrong with it: "", MISSING, ADDED or SHIFTED."""
        if self.new is None:
            return MISSING
        if self.golden is None:
            return ADDED
        return SHIFTED if abs(self.shift) > limit + 1e-6 else ""


def compare(pair: Pair, tolerance: Tolerance) -> list[Happening]:
    """All that happened in either, in the order in which it did."""
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
    return sorted(found, key=lambda happening: happening.time)


def _matched(
    kind: str,
    golden: Sequence[Any],
    new: Sequence[Any],
    key: Callable[[Any], Any],
    words: Callable[[Any], str],
) -> list[Happening]:
    """The longest common order of both; what is not in it is missing or added."""
    found = []

    def note(first: Any, second: Any) -> None:
        event = first if first is not None else second
        seq = event[1] if kind == "items" else -1
        times = [None if one is None else float(one[0]) for one in (first, second)]
        found.append(Happening(kind, words(event), times[0], times[1], seq))

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
