# SPDX-License-Identifier: BSD-3-Clause
"""What was seen at the ends of the last steps: for observations that are taken seldom, seen late, or have noise."""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from .losses import Kept, Losses, LossRates
from .options import EnvOptionError
from .robots.robot import Floats

LATENCY_STREAM = 1 << 41
"""Second word of the seeds of latencies."""


class Film(NamedTuple):
    """What one robot's ``Past`` needs to go on, for a snapshot."""

    steps: int
    """Since the episode began."""
    seed: int
    rows: Floats
    """Of the last steps, shape (steps kept, width)."""
    kept: Kept | None = None
    """What arrived last; None: nothing is lost."""


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
        latency: age of a row when it is seen [s], whole steps; or (least, greatest), of which each episode draws one,
            all whole steps in between being equally likely.
        losses: how often rows are lost; None: never.

    Raises:
        EnvOptionError: rate or latency are not whole steps.
    """

    def __init__(
        self, who: str, count: int, width: int, seconds: float, rate: float | None,
        latency: float | tuple[float, float], losses: LossRates | None = None,
    ) -> None:  # fmt: skip
        self._who = who
        self._every = self._steps("1 / rate", 1.0 / rate, seconds) if rate else 1
        ends = latency if isinstance(latency, tuple) else (latency, latency)
        self._least, self._most = (self._steps("latency", end, seconds) if end else 0 for end in ends)
        self._ages = np.full(count, self._least, np.int64)
        """Of each robot's rows when they are seen [steps]."""
        self._rows = np.zeros((count, self._every + self._most, width))
        """Of the ends of steps: that of step k of an episode is at k % (number that is kept)."""
        self._count, self._seeds = np.zeros((2, count), np.int64)
        self._losses = None if losses is None else Losses(losses, count, width)

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
        self._draw(index, seed)

    def _draw(self, index: int, seed: int) -> None:
        if self._most > self._least:
            rng = np.random.default_rng((seed, LATENCY_STREAM))
            self._ages[index] = rng.integers(self._least, self._most + 1)

    def begin(self, rows: npt.NDArray[Any], which: npt.NDArray[np.bool_] | None) -> None:
        """First rows of the episodes of these robots (None: all), shape (count, width); before them was the same."""
        robots = slice(None) if which is None else which
        self._rows[robots] = rows[robots, None]
        if self._losses is not None:
            self._losses.begin(rows, which)

    def note(self, rows: npt.NDArray[Any], which: npt.NDArray[np.bool_] | None) -> None:
        """These robots (None: all) have gone on by a step; ``rows`` has a row for each robot, shape (count, width)."""
        robots = np.arange(len(self._count)) if which is None else np.flatnonzero(which)
        self._count[robots] += 1
        self._rows[robots, self._count[robots] % self._rows.shape[1]] = rows[robots]
        if self._losses is not None:
            self._losses.receive(self._newest(), self._due(), self._seeds, robots)

    def _due(self) -> npt.NDArray[np.int64]:
        found: npt.NDArray[np.int64] = np.maximum((self._count - self._ages) // self._every * self._every, 0)
        return found

    def taken(self) -> npt.NDArray[np.int64]:
        """Step of each robot's episode of which the row is that is seen now, shape (count,)."""
        return self._due() if self._losses is None else self._losses.steps

    @property
    def arrives(self) -> npt.NDArray[np.bool_]:
        """Whether the last row of each robot has arrived, shape (count,)."""
        return np.ones(len(self._count), np.bool_) if self._losses is None else ~self._losses.lost

    def seen(self) -> Floats:
        """The rows that are seen now, a copy, shape (count, width)."""
        return self._newest() if self._losses is None else self._losses.rows.copy()

    def _newest(self) -> Floats:
        robots = np.arange(len(self._count))
        return np.ascontiguousarray(self._rows[robots, self._due() % self._rows.shape[1]])

    def generators(self) -> list[np.random.Generator]:
        """Of each robot, for the noise of the row that is seen now: it is the same as long as that row is."""
        return [np.random.default_rng(pair) for pair in zip(self._seeds.tolist(), self.taken().tolist())]

    def memory(self, index: int) -> Film:
        """For a snapshot of one robot."""
        kept = None if self._losses is None else self._losses.memory(index)
        return Film(int(self._count[index]), int(self._seeds[index]), self._rows[index].copy(), kept)

    def recall(self, index: int, film: Any) -> None:
        """Go on as from a ``memory``.

        Raises:
            EnvOptionError: it is of another rate, latency or dropout.
        """
        if np.shape(film.rows) != self._rows[index].shape or (film.kept is None) != (self._losses is None):
            raise EnvOptionError(f"snapshot cannot be restored: {self._who!r} had another rate, latency or dropout")
        self._count[index], self._seeds[index], self._rows[index] = film.steps, film.seed, film.rows
        self._draw(index, film.seed)
        if self._losses is not None and film.kept is not None:
            self._losses.recall(index, film.kept)
