# SPDX-License-Identifier: BSD-3-Clause
"""Latency: a command takes effect some time after the decision; the previous command holds until then."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from sitl.vehicles.properties.property import Property

from .options import EnvOptionError
from .robots.robot import Floats, Robot

Ints = npt.NDArray[np.int64]

LATENCY = Property("latency", "s", "from a decision until its command reaches the robot", 0.0, 60.0, 0.0)


@dataclass(frozen=True)
class Memory:
    """Pending commands of one robot; picklable."""

    ticks: int
    """Latency [ticks]."""
    done: int
    """Number of commands given in the episode."""
    kept: tuple[tuple[float, ...], ...]
    """Commands that have not taken effect yet, oldest first."""


class Latency:
    """Delays the commands of ``robot.count`` robots, each by its own latency.

    A command given at the start of step k takes effect a whole number of ticks later: in step k + q, after r ticks,
    where latency = q steps + r ticks. So at most one command takes effect in a step.

    Args:
        robot: robot that receives the commands; its ``tick`` is the unit of latency.
        seconds: initial latency of all robots [s], a whole number of ticks.
        step_time: duration of a step [s].
        width: number of columns of a command.

    Raises:
        EnvOptionError: the latency is out of range or no whole number of ticks, or the robot does not support it.
    """

    def __init__(self, robot: Robot, seconds: float, step_time: float, width: int) -> None:
        if not hasattr(robot, "advance_late"):
            raise EnvOptionError(f"latency: robot {robot.name!r} takes none, its class has no advance_late()")
        self._tick, self._step = robot.tick, round(step_time / robot.tick)
        self._robots = np.arange(robot.count)
        self._done: Ints = np.zeros(robot.count, np.int64)
        """Number of commands given to each robot in its episode."""
        self.ticks: Ints = np.full(robot.count, self._check(seconds), np.int64)
        """Latency of each robot [ticks]."""
        self._kept = np.zeros((self.ticks[0] // self._step + 1, robot.count, width))
        """Ring buffers, shape (depth, count, width): row k % depth holds the commands of step k of an episode."""
        self.due: Floats = np.zeros((robot.count, width))
        """Commands that take effect in this step, shape (count, width)."""
        self.waits: Ints = np.zeros(robot.count, np.int64)
        """Ticks of this step before ``due`` takes effect, shape (count,); a whole step's where none does."""

    def _check(self, seconds: Any) -> int:
        valid = isinstance(seconds, int | float | np.number) and not isinstance(seconds, bool)
        if not valid or not LATENCY.low <= seconds <= LATENCY.high:
            raise EnvOptionError(f"latency = {seconds!r}; it must be {LATENCY.low:g} .. {LATENCY.high:g} s")
        ticks = round(seconds / self._tick)
        if abs(seconds / self._tick - ticks) > 1e-5:
            raise EnvOptionError(f"latency = {seconds!r}; it must be a whole number of {self._tick:g} s")
        return ticks

    def set(self, index: int, seconds: float) -> None:
        """Set the latency of one robot for its next episode [s], rounded to the nearest tick.

        Raises:
            EnvOptionError: the latency is out of range.
        """
        if not math.isfinite(seconds):
            self._check(seconds)
        self.ticks[index] = self._check(round(seconds / self._tick) * self._tick)
        self._reserve(int(self.ticks[index]) // self._step + 1)

    def _reserve(self, rows: int) -> None:
        before = len(self._kept)
        if rows <= before:
            return
        kept, self._kept = self._kept, np.zeros((rows, *self._kept.shape[1:]))
        for age in range(1, before + 1):
            step = self._done - age
            self._kept[step % rows, self._robots] = kept[step % before, self._robots]

    def begin(self, index: int) -> None:
        """Start an episode of one robot: no command is pending."""
        self._done[index] = 0

    def post(self, commands: Floats, rows: npt.NDArray[np.bool_] | None) -> None:
        """Give these robots (None: all) their commands of a step, shape (count, width); sets ``due`` and ``waits``."""
        kept, depth = self._kept, len(self._kept)
        robots = self._robots if rows is None else np.flatnonzero(rows)
        done = self._done[robots]
        kept[done % depth, robots] = commands[robots]
        late, rest = np.divmod(self.ticks[robots], self._step)
        self.due[robots] = kept[(done - late) % depth, robots]
        self.waits[robots] = np.where(done >= late, rest, self._step)
        self._done[robots] = done + 1

    def memory(self, index: int) -> Memory:
        """Pending commands of one robot, for a snapshot."""
        ticks, done = int(self.ticks[index]), int(self._done[index])
        first = max(done - ticks // self._step - 1, 0)
        rows = (self._kept[step % len(self._kept), index] for step in range(first, done))
        return Memory(ticks, done, tuple(tuple(row.tolist()) for row in rows))

    def recall(self, index: int, memory: Memory) -> None:
        """Restore the pending commands of one robot."""
        self._reserve(memory.ticks // self._step + 1)
        self.ticks[index], self._done[index] = memory.ticks, memory.done
        for age, row in enumerate(reversed(memory.kept), 1):
            self._kept[(memory.done - age) % len(self._kept), index] = row
