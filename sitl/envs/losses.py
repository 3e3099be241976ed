# SPDX-License-Identifier: BSD-3-Clause
"""Drop-outs: readings that never arrive, one by one or several in a row; the last one that did is seen instead."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .noise import uniform

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


class LossRates(NamedTuple):
    """How often readings are lost: a Markov chain of two states (Gilbert, "Capacity of a burst-noise channel", Bell
    System Technical Journal 39(5), 1960)."""

    begin: float
    """Probability that a reading is lost after one that arrived."""
    go_on: float
    """Probability that a reading is lost after one that was lost."""


def rates_of(dropout: float, burst: float | None) -> LossRates:
    """The rates of a share of readings that are lost.

    Args:
        dropout: the share, within [0, 1).
        burst: mean number of readings that are lost in a row; None: each is lost independently of the others. At least
            1, and so many that a reading can arrive in between: dropout <= burst / (burst + 1).
    """
    if burst is None:
        return LossRates(dropout, dropout)
    return LossRates(dropout / (burst * (1.0 - dropout)), 1.0 - 1.0 / burst)


class Kept(NamedTuple):
    """What one robot's ``Losses`` needs to go on, for a snapshot."""

    lost: bool
    due: int
    step: int
    row: Floats


class Losses:
    """Which readings of each robot arrived, and the last one that did.

    Args:
        rates: how often they are lost.
        count: number of robots.
        width: numbers in a row.
    """

    def __init__(self, rates: LossRates, count: int, width: int) -> None:
        self._rates = rates
        self.lost = np.zeros(count, np.bool_)
        """Whether the last reading of each robot was lost, shape (count,)."""
        self._due, self.steps = np.zeros((2, count), np.int64)
        """Step of each robot's episode of which the last reading was, arrived or not; of that which is seen."""
        self.rows = np.zeros((count, width))
        """What is seen, shape (count, width)."""

    def begin(self, rows: Floats, which: npt.NDArray[np.bool_] | None) -> None:
        """Episodes of these robots (None: all) begin: the first reading arrives."""
        robots = slice(None) if which is None else which
        self.lost[robots], self._due[robots], self.steps[robots] = False, 0, 0
        self.rows[robots] = rows[robots]

    def receive(self, rows: Floats, due: Ints, seeds: Ints, robots: Ints) -> None:
        """Readings of these robots are to arrive.

        Args:
            rows: the newest of each robot, shape (count, width).
            due: step of its episode that it is of, shape (count,).
            seeds: of each robot's episode, shape (count,).
            robots: indices.
        """
        robots = robots[due[robots] != self._due[robots]]
        chances = np.where(self.lost[robots], self._rates.go_on, self._rates.begin)
        lost = uniform(seeds[robots], due[robots]) < chances
        self.lost[robots], self._due[robots] = lost, due[robots]
        here = robots[~lost]
        self.steps[here], self.rows[here] = due[here], rows[here]

    def memory(self, index: int) -> Kept:
        """For a snapshot of one robot."""
        return Kept(bool(self.lost[index]), int(self._due[index]), int(self.steps[index]), self.rows[index].copy())

    def recall(self, index: int, kept: Kept) -> None:
        """Go on as from a ``memory``."""
        self.lost[index], self._due[index], self.steps[index], self.rows[index] = kept
