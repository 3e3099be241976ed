# SPDX-License-Identifier: BSD-3-Clause
"""Latency: commands reach a robot some time after they were decided on; until then the one before goes on."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from sitl.vehicles.figures.figure import Figure

from .options import EnvOptionError
from .robots.robot import Floats, Robot

Ints = npt.NDArray[np.int64]

LATENCY = Figure("latency", "s", "from a decision until its command reaches the robot", 0.0, 60.0, 0.0)


@dataclass(frozen=True)
class Memory:
    """What is under way to one robot; can be pickled."""

    ticks: int
    done: int
    kept: tuple[tuple[float, ...], ...]
    """Commands that have not arrived yet, oldest first."""


class Latency:
    """Delays commands of ``robot.count`` robots, each by a time of its own.

    A command that is decided on at the begin of step k arrives a whole number of ticks later: in step k + q, after r
    ticks of it, where latency = q steps + r ticks. So at most one command arrives in a step.

    Args:
        robot: that the commands are for; see ``Robot.tick``.
        seconds: of latency, for all robots [s].
        step_time: of a step [s].
        width: numbers of a command.

    Raises:
        EnvOptionError: a latency that cannot be, or a robot whose class knows of none.
    """

    def __init__(self, robot: Robot, seconds: float, step_time: float, width: int) -> None:
        if not hasattr(robot, "advance_late"):
            raise EnvOptionError(f"latency: robot {robot.name!r} takes none, its class has no advance_late()")
        self._tick, self._step = robot.tick, round(step_time / robot.tick)
        self._robots = np.arange(robot.count)
        self._done: Ints = np.zeros(robot.count, np.int64)
        """Commands that each robot was given in its episode."""
        self.ticks: Ints = np.full(robot.count, self._check(seconds), np.int64)
        """Of each robot."""
        self._kept = np.zeros((self.ticks[0] // self._step + 1, robot.count, width))
        """Rings: the command of step k of an episode is row k % len."""
        self.due: Floats = np.zeros((robot.count, width))
        """The commands that arrive in this step."""
        self.waits: Ints = np.zeros(robot.count, np.int64)
        """Ticks of the step that pass before; those of a whole step where none arrives in it."""

    def _check(self, seconds: Any) -> int:
        valid = isinstance(seconds, int | float | np.number) and not isinstance(seconds, bool)
        if not valid or not LATENCY.low <= seconds <= LATENCY.high:
            raise EnvOptionError(f"latency = {seconds!r}; it must be {LATENCY.low:g} .. {LATENCY.high:g} s")
        ticks = round(seconds / self._tick)
        if abs(seconds / self._tick - ticks) > 1e-5:
            raise EnvOptionError(f"latency = {seconds!r}; it must be a whole number of {self._tick:g} s")
        return ticks

    def set(self, index: int, seconds: float) -> None:
        """Another latency for the next episode of a robot, to the nearest tick.

        Raises:
            EnvOptionError: it cannot be so long.
        """
        if not math.isfinite(seconds):
            self._check(seconds)
        self.ticks[index] = self._check(round(seconds / self._tick) * self._tick)
        self._make_room(int(self.ticks[index]) // self._step + 1)

    def _make_room(self, rows: int) -> None:
        before = len(self._kept)
        if rows <= before:
            return
        kept, self._kept = self._kept, np.zeros((rows, *self._kept.shape[1:]))
        for age in range(1, before + 1):
            step = self._done - age
            self._kept[step % rows, self._robots] = kept[step % before, self._robots]

    def begin(self, index: int) -> None:
        """An episode of one robot begins: nothing is under way."""
        self._done[index] = 0

    def post(self, commands: Floats, rows: npt.NDArray[np.bool_] | None) -> None:
        """These robots (None: all) decide; sets ``due`` and ``waits`` of the step."""
        kept, depth = self._kept, len(self._kept)
        robots = self._robots if rows is None else np.flatnonzero(rows)
        done = self._done[robots]
        kept[done % depth, robots] = commands[robots]
        late, rest = np.divmod(self.ticks[robots], self._step)
        self.due[robots] = kept[(done - late) % depth, robots]
        self.waits[robots] = np.where(done >= late, rest, self._step)
        self._done[robots] = done + 1

    def memory(self, index: int) -> Memory:
        """Of one robot."""
        ticks, done = int(self.ticks[index]), int(self._done[index])
        first = max(done - ticks // self._step - 1, 0)
        rows = (self._kept[step % len(self._kept), index] for step in range(first, done))
        return Memory(ticks, done, tuple(tuple(row.tolist()) for row in rows))

    def recall(self, index: int, memory: Memory) -> None:
        """Go on from there."""
        self._make_room(memory.ticks // self._step + 1)
        self.ticks[index], self._done[index] = memory.ticks, memory.done
        for age, row in enumerate(reversed(memory.kept), 1):
            self._kept[(memory.done - age) % len(self._kept), index] = row
