# SPDX-License-Identifier: BSD-3-Clause
"""Numbers of robots that one compiled call gathers into an observation, from arrays that stay in place."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from sitl.core.array_kernels import Flags, IntLine, IntTable, Kernel, NarrowLine, NarrowTable, Table
from sitl.core.kernels import law

STATE, TRUTH, REPORTS, TRUE_REPORTS, COMPUTED, SCAN, ACTIONS, CHOSEN = range(8)
"""Where numbers are taken from: see ``gather``."""
Floats = npt.NDArray[np.float64]


class Known(NamedTuple):
    """Where numbers are taken from, a row a robot."""

    state: Table
    """Shape (count, 12)."""
    truth: Table
    """Shape (count, 12)."""
    reports: Table
    """Shape (count, 10)."""
    true_reports: Table
    """Shape (count, 9)."""
    computed: Table
    """What has been computed for this observation, shape (count, m)."""
    scan: NarrowTable
    """Readings [m], shape (count, readings)."""


class Last(NamedTuple):
    """The last actions, a row a robot."""

    actions: Table
    """Of boxes, shape (count, columns)."""
    chosen: IntLine
    """Of tables, shape (count,)."""
    acted: Flags
    """Whether there was one; else its columns are 0; shape (count,)."""


@law
def gather(blocks: IntTable, known: Known, last: Last, low: NarrowLine, high: NarrowLine, out: NarrowTable) -> None:
    """Write numbers of robots, a row a robot, within their bounds; NaN stays.

    Args:
        blocks: what is written: where from (``STATE`` ...), first column there, first column of ``out``, how many;
            shape (n, 4). Of ``CHOSEN``, a column is 1 for the action of this number, 0 for others.
        known: see ``Known``.
        last: see ``Last``.
        low, high: bounds of each column of ``out``, shape (columns,).
        out: shape (count, columns).
    """
    for i in range(out.shape[0]):
        for b in range(blocks.shape[0]):
            source, first, to = blocks[b, 0], blocks[b, 1], blocks[b, 2]
            for k in range(blocks[b, 3]):
                value = 0.0
                if source == STATE:
                    value = known.state[i, first + k]
                elif source == TRUTH:
                    value = known.truth[i, first + k]
                elif source == REPORTS:
                    value = known.reports[i, first + k]
                elif source == TRUE_REPORTS:
                    value = known.true_reports[i, first + k]
                elif source == COMPUTED:
                    value = known.computed[i, first + k]
                elif source == SCAN:
                    value = float(known.scan[i, first + k])
                elif source == ACTIONS:
                    value = last.actions[i, first + k] if last.acted[i] else 0.0
                elif last.chosen[i] == first + k and last.acted[i]:
                    value = 1.0
                out[i, to + k] = value
                narrow = out[i, to + k]
                if not narrow > low[to + k] and narrow == narrow:
                    out[i, to + k] = low[to + k]
                if not out[i, to + k] < high[to + k] and narrow == narrow:
                    out[i, to + k] = high[to + k]


_gather = Kernel(gather)


def stands_for(thing: object, fast: str, slow: str) -> bool:
    """Whether a method does what another one does, faster: a class that has a ``slow`` one of its own, and inherits
    the ``fast`` one, means its own."""
    return _stands_for(type(thing), fast, slow)  # type: ignore[arg-type]  # mypy: a class is hashable


@cache
def _stands_for(kind: type, fast: str, slow: str) -> bool:
    owned = ({fast, slow} & vars(owner).keys() for owner in kind.__mro__)
    return fast in next(filter(None, owned), ())


class Gathering:
    """The plan of an observation's columns that are gathered.

    Args:
        session: see ``parts.Surroundings``; its robot's arrays stay in place (``senses.arrays_stay``).
    """

    def __init__(self, session: Any) -> None:
        self.session = session
        self._blocks: list[tuple[int, int, int, int]] = []
        self._makers: list[tuple[Callable[[Floats, int], Callable[[], object]], int]] = []
        self._width = 0
        self._to = 0
        self._before: list[Callable[[], object]] = []

    def at(self, column: int) -> None:
        """What is planned next is written from this column on."""
        self._to = column

    def take(self, source: int, first: int, count: int) -> None:
        """Plan ``count`` columns of an array, from column ``first`` on."""
        self._blocks.append((source, first, self._to, count))
        self._to += count

    def compute(self, count: int, maker: Callable[[Floats, int], Callable[[], object]]) -> None:
        """Plan ``count`` columns that a function computes before each observation.

        Args:
            count: number of columns.
            maker: gives this function, of the table and the column where it writes from.
        """
        self._makers.append((maker, self._width))
        self.take(COMPUTED, self._width, count)
        self._width += count

    def before(self, function: Callable[[], object]) -> None:
        """Call a function before each observation, once for all that ask for it."""
        if function not in self._before:
            self._before.append(function)

    def made(self, low: npt.NDArray[np.float32], high: npt.NDArray[np.float32]) -> Callable[[Any], None]:
        """A function that writes what is planned into an array of float32, shape (count, columns), in one piece.

        Args:
            low, high: bounds of all columns.
        """
        session, robot = self.session, self.session.robot
        none, none_chosen = np.zeros((robot.count, 1)), np.zeros(robot.count, np.int64)
        computed = np.zeros((robot.count, max(self._width, 1)))
        before = (*self._before, *(maker(computed, first) for maker, first in self._makers))
        sources = {source for source, *_ in self._blocks}

        def used(source: int, array: Callable[[], Any], instead: Any = none) -> Any:
            return array() if source in sources else instead

        write = _gather.bind(
            np.array(self._blocks, np.int64).reshape(-1, 4),
            Known(
                used(STATE, lambda: robot.state), used(TRUTH, lambda: robot.true_state()),
                used(REPORTS, lambda: robot.reports), used(TRUE_REPORTS, lambda: robot.true_reports()),
                computed, robot.scan,
            ),
            Last(
                used(ACTIONS, lambda: session.actions), used(CHOSEN, lambda: session.actions, none_chosen),
                session.acted,
            ), low, high,
        )  # fmt: skip
        if not before:
            return write

        def write_all(out: Any) -> None:
            for function in before:
                function()
            write(out)

        return write_all
