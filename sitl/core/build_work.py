# SPDX-License-Identifier: BSD-3-Clause
"""How much of a build is done, reported while its units are still being compiled."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Mapping

_ALMOST = 0.95
"""A unit that is being compiled counts for at most this share of its work."""


class BuildWork:
    """The work of a build, in the unit of the weights.

    A unit that is being compiled counts by its time so far, at the speed of those that are complete.

    Args:
        weights: name of a unit -> its work; in seconds on a quiet core of some processor, until speeds are known.
    """

    def __init__(self, weights: Mapping[str, float]) -> None:
        self._weights = dict(weights)
        self.total = sum(self._weights.values())
        self._begun: dict[str, float] = {}
        self._complete = 0.0
        self._seconds = 0.0
        self._reported = 0.0

    def begin(self, name: str, now: float) -> None:
        """A unit is being compiled from ``now`` [s] on."""
        self._begun[name] = now

    def end(self, name: str, now: float) -> None:
        """It is complete."""
        self._seconds += now - self._begun.pop(name)
        self._complete += self._weights[name]

    def done(self, now: float) -> float:
        """What is done at ``now`` [s]; it never falls."""
        seconds_a_weight = self._seconds / self._complete if self._complete and self._seconds > 0.0 else 1.0
        running = sum(
            min((now - begun) / seconds_a_weight, _ALMOST * self._weights[name]) for name, begun in self._begun.items()
        )
        self._reported = max(self._reported, self._complete + running)
        return self._reported


FIRST_LINE = "gym-sitl compiles its core (once; later starts load it from the cache)"


class ProgressLines:
    """Progress as lines on standard error, for logs and for programs without a bar: the first at once, then one each
    quarter of a minute. Call it as ``core.compile.Progress``.

    Args:
        clock: wall time [s].
        first: the first line.
    """

    EVERY_S = 15.0

    def __init__(self, clock: Callable[[], float] = time.monotonic, first: str = FIRST_LINE) -> None:
        self._clock, self._first = clock, first
        self._begun = self._said = -1.0
        self._total = 0.0

    def __call__(self, unit: str, done: float, total: float) -> None:
        """Work ``done`` of ``total``; ``unit`` is the one that was begun or completed last."""
        now = self._clock()
        if self._begun < 0.0:
            self._say(self._first)
        if total != self._total:  # another part of the core
            self._begun, self._said, self._total = now, now, total
        elif now - self._said >= self.EVERY_S:
            self._said = now
            self._say(f"  {100.0 * done / total:3.0f} % after {now - self._begun:.0f} s ({unit})")

    @staticmethod
    def _say(line: str) -> None:
        print(line, file=sys.stderr, flush=True)
