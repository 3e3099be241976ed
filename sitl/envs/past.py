# SPDX-License-Identifier: BSD-3-Clause
"""What was seen at the ends of the last steps: for observations that are taken seldom, seen late, or have noise."""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from .options import EnvOptionError
from .robots.robot import Floats


class Film(NamedTuple):
    """What one robot's ``Past`` needs to go on, for a snapshot."""

    steps: int
    """Since the episode began."""
    seed: int
    rows: Floats
    """Of the last steps, shape (steps kept, width)."""


class Remembering(Protocol):
    """A piece of an observation that remembers the last steps."""

    def start(self, index: int, seed: int) -> None:
        """An episode of one robot begins; its noise follows from the seed. ``begin`` follows."""

    def begin(self, which: npt.NDArray[np.bool_] | None) -> None:
        """These robots (None: all) are at the beginning of their episodes, with readings of now."""

    def note(self, which: npt.NDArray[np.bool_] | None) -> None:
        """These robots (None: all) have gone on by a step."""

    def memory(self, index: int) -> Film:
        """For a snapshot of one robot."""

    def recall(self, index: int, film: Film) -> None:
        """Go on as from a ``memory``.

        Raises:
            EnvOptionError: it is of another rate or latency.
        """


class Past:
    """The last rows of each robot, a row a step.

    Args:
        who: whose it is, for messages.
        count: number of robots.
        width: numbers in a row.
        seconds: duration of a step [s].
        rate: rows that are taken a second [Hz], whole steps apart; None: one each step.
        latency: age of a row when it is seen [s], whole steps.

    Raises:
        EnvOptionError: rate or latency are not whole steps.
    """

    def __init__(self, who: str, count: int, width: int, seconds: float, rate: float | None, latency: float) -> None:
        self._who = who
        self._every = self._steps("1 / rate", 1.0 / rate, seconds) if rate else 1
        self._age = self._steps("latency", latency, seconds) if latency else 0
        self._rows = np.zeros((count, self._every + self._age, width))
        """Of the ends of steps: that of step k of an episode is at k % (number that is kept)."""
        self._count, self._seeds = np.zeros((2, count), np.int64)

    def _steps(self, what: str, wanted: float, seconds: float) -> int:
        steps = round(wanted / seconds)
        if steps < 1 or abs(steps * seconds - wanted) > 1e-6:
            raise EnvOptionError(
                f"observation {self._who!r}: {what} = {wanted:g} s is not a whole number of steps of {seconds:g} s"
            )
        return steps

    def start(self, index: int, seed: int) -> None:
        """An episode of one robot begins; ``begin`` follows."""
        self._count[index], self._seeds[index] = 0, seed

    def begin(self, rows: npt.NDArray[Any], which: npt.NDArray[np.bool_] | None) -> None:
        """First rows of the episodes of these robots (None: all), shape (count, width); before them was the same."""
        robots = slice(None) if which is None else which
        self._rows[robots] = rows[robots, None]

    def note(self, rows: npt.NDArray[Any], which: npt.NDArray[np.bool_] | None) -> None:
        """These robots (None: all) have gone on by a step; ``rows`` has a row for each robot, shape (count, width)."""
        robots = np.arange(len(self._count)) if which is None else np.flatnonzero(which)
        self._count[robots] += 1
        self._rows[robots, self._count[robots] % self._rows.shape[1]] = rows[robots]

    def taken(self) -> npt.NDArray[np.int64]:
        """Step of each robot's episode of which the row is that is seen now, shape (count,)."""
        found: npt.NDArray[np.int64] = np.maximum((self._count - self._age) // self._every * self._every, 0)
        return found

    def seen(self) -> Floats:
        """The rows that are seen now, a copy, shape (count, width)."""
        robots = np.arange(len(self._count))
        return np.ascontiguousarray(self._rows[robots, self.taken() % self._rows.shape[1]])

    def generators(self) -> list[np.random.Generator]:
        """Of each robot, for the noise of the row that is seen now: it is the same as long as that row is."""
        return [np.random.default_rng(pair) for pair in zip(self._seeds.tolist(), self.taken().tolist())]

    def memory(self, index: int) -> Film:
        """For a snapshot of one robot."""
        return Film(int(self._count[index]), int(self._seeds[index]), self._rows[index].copy())

    def recall(self, index: int, film: Any) -> None:
        """Go on as from a ``memory``.

        Raises:
            EnvOptionError: it is of another rate or latency.
        """
        if np.shape(film.rows) != self._rows[index].shape:
            raise EnvOptionError(f"snapshot cannot be restored: {self._who!r} had another rate or latency")
        self._count[index], self._seeds[index], self._rows[index] = film
