# SPDX-License-Identifier: BSD-3-Clause
"""Pass gates in order and in their direction: a race."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from sitl.core.array_kernels import Flags, IntLine, Kernel, Line, Table
from sitl.core.kernels import law
from sitl.worlds import World

from ...core.elementary import sincos
from ..arena import flies
from ..options import EnvOptionError
from ..rewards import Floats, Step
from ..robots.robot import Robot, world_of
from ..senses import SensingRobot
from ..worlds import PerWorld
from .target_task import Outcome, TargetTask, checked_far


class Gate(NamedTuple):
    """An upright rectangle that is passed in the direction of its yaw."""

    x: float
    y: float
    z: float
    """Of its middle, in the world's frame [m]."""
    yaw: float
    """[rad]"""
    width: float = 2.0
    height: float = 2.0
    """[m]"""


@law
def cross_gates(before: Table, now: Table, gates: Table, counts: IntLine, at: IntLine, passed: Flags) -> None:
    """Which robots have passed their gate in its direction during a step.

    Args:
        before, now: x, y, z of each robot at the step's ends [m], shape (count, 3 or more).
        gates: rows of ``Gate``, one robot's after another's, each with as many, shape (count * most, 6).
        counts: how many of each robot's rows are gates, shape (count,).
        at: number of each robot's gate, shape (count,).
        passed: written, shape (count,).
    """
    most = gates.shape[0] // at.shape[0]
    for i in range(at.shape[0]):
        row = i * most + at[i] % counts[i]
        s, c = sincos(gates[row, 3])
        x, y = before[i, 0] - gates[row, 0], before[i, 1] - gates[row, 1]
        u, v = now[i, 0] - gates[row, 0], now[i, 1] - gates[row, 1]
        a, b = x * c + y * s, u * c + v * s
        passed[i] = False
        if a < 0.0 <= b:
            share = a / (a - b)
            aside = (y * c - x * s) + share * ((v * c - u * s) - (y * c - x * s))
            above = before[i, 2] + share * (now[i, 2] - before[i, 2]) - gates[row, 2]
            passed[i] = abs(aside) <= 0.5 * gates[row, 4] and abs(above) <= 0.5 * gates[row, 5]


class GatePrices(NamedTuple):
    """What is paid."""

    progress: float
    """For each metre nearer to a gate's middle."""
    far: float
    """Distances from there on count as this one [m]."""
    gate: float
    """For each gate."""
    time: float
    """For a step."""


class Course(NamedTuple):
    """What robots fly or drive through."""

    positions: Table
    """Middles of the gates of all laps, one robot after another [m], shape (count * n, 3)."""
    counts: IntLine
    """Gates of a lap of each robot, shape (count,)."""
    laps: int


class Runs(NamedTuple):
    """How far robots are, a row each."""

    at: IntLine
    """Number of each robot's gate; goes on where that is passed."""
    laps: Table
    """When each robot's lap began, how long its last one took, and its shortest one [s], shape (count, 3)."""
    passed: Flags
    """Whether each robot has passed its gate."""


@law
def pay_gates(
    prices: GatePrices, before: Table, now: Table, course: Course, time: Line, runs: Runs, outcome: Outcome
) -> None:
    """Pay for a step through gates.

    Args:
        prices: see ``GatePrices``.
        before, now: x, y, z of each robot at the step's ends [m], shape (count, 3); ``before`` becomes ``now``.
        course: see ``Course``.
        time: of each robot's episode [s], shape (count,).
        runs: see ``Runs``.
        outcome: see ``Outcome``; terms of the rewards: progress, gates, time.
    """
    positions, counts, at, laps, passed = course.positions, course.counts, runs.at, runs.laps, runs.passed
    success, rewards, paid = outcome.success, outcome.rewards, outcome.paid
    per_robot = positions.shape[0] // at.shape[0]
    for i in range(rewards.shape[0]):
        row = i * per_robot + min(at[i], per_robot - 1)
        x, y, z = positions[row, 0] - before[i, 0], positions[row, 1] - before[i, 1], positions[row, 2] - before[i, 2]
        u, v, w = positions[row, 0] - now[i, 0], positions[row, 1] - now[i, 1], positions[row, 2] - now[i, 2]
        was, left = math.sqrt(x * x + y * y + z * z), math.sqrt(u * u + v * v + w * w)
        nearer = min(was, prices.far) - min(left, prices.far)
        gain, gate = prices.progress * nearer, prices.gate if passed[i] else 0.0
        rewards[i] += gain + gate + prices.time
        paid[0, i], paid[1, i], paid[2, i] = gain, gate, prices.time
        if outcome.crashed[i]:
            paid[0, i], paid[1, i], paid[2, i] = 0.0, 0.0, 0.0
        before[i, 0], before[i, 1], before[i, 2] = now[i, 0], now[i, 1], now[i, 2]
        if passed[i]:
            at[i] += 1
            if at[i] % counts[i] == 0:
                took = time[i] - laps[i, 0]
                best = min(laps[i, 2], took) if laps[i, 2] > 0.0 else took
                laps[i, 0], laps[i, 1], laps[i, 2] = time[i], took, best
        success[i] = at[i] == course.laps * counts[i]
        if success[i]:
            outcome.terminated[i] = True


_cross, _pay = Kernel(cross_gates), Kernel(pay_gates)
_HIGH = 4.0
"""Of gates that are marked on the floor [m]."""


class Gates(TargetTask):
    """Pass gates in order and in their direction, for one or more laps. The end of the last lap is success and ends
    the episode.

    Reward of a step: ``progress`` times the decrease of the distance to the next gate's centre [m], plus
    ``each_second`` times the step's seconds, plus ``gate_reward`` when the gate is passed. A robot that misses a gate
    has to go back and pass it. "goal" and "path" are exact vectors to gate centres, and gates are judged by the robot's
    true position: there is no estimation error in them. ``info["passed"]`` counts gates; ``info["lap_time"]`` is the
    time of the last complete lap and ``info["best_lap"]`` the shortest one [s], 0 before the first.

    Args:
        gates: gates in order; None: the world's markings "gate 1", "gate 2", ...
        laps: number of laps.
        progress: reward for each metre nearer to the centre of the next gate.
        far: distance from which on nearer is worth nothing, and farther costs nothing [m].
        gate_reward: reward for each gate passed.
        each_second: reward per second.
        others: further arguments of ``TargetTask``.
    """

    sees_truth = True

    _rows: Floats
    """Gates of each robot's world, shape (count, gates, 6); valid after ``prepare``."""
    _counts: npt.NDArray[np.int64]
    """How many of them there are, shape (count,)."""

    def __init__(
        self,
        gates: Sequence[Gate | Sequence[float]] | None = None,
        laps: int = 1,
        progress: float = 1.0,
        gate_reward: float = 5.0,
        each_second: float = -0.5,
        far: float = math.inf,
        **others: Any,
    ) -> None:
        super().__init__(**others)
        self._given_gates = None if gates is None else _checked(gates)
        if not 1 <= laps <= 100:
            raise EnvOptionError(f"Gates(laps={laps}); it must be 1 .. 100")
        self.laps, self.progress, self.gate_reward, self.each_second = laps, progress, gate_reward, each_second
        self.far = checked_far(self, far)

    def _gates_of(self, world: World) -> Floats:
        """Rows of ``Gate`` of a world, shape (gates, 6)."""
        return self._painted(world) if self._given_gates is None else self._given_gates

    def _painted(self, world: World) -> Floats:
        """The gates that are marked on the world's floor."""
        found = {m.name: m for m in world.markings if m.name.startswith("gate ")}
        names = [f"gate {k + 1}" for k in range(len(found))]
        if not found or set(names) != set(found):
            has = ", ".join(found) or "none"
            raise EnvOptionError(f'Gates: world {world.name!r} needs markings "gate 1", "gate 2", ...; it has {has}')
        middle = world.floor_z + 0.5 * _HIGH if self.flies else world.start(self._robot.name).position[2]
        marked = [found[name] for name in names]
        return _checked([Gate(*m.centre, middle, m.yaw, m.size[1], _HIGH) for m in marked])

    def gates_at(self, index: int) -> list[Gate]:
        """Those of one robot's world, in their order."""
        return [Gate(*gate) for gate in self._gates_in(world_of(self._robot, index)).tolist()]

    @property
    def gates(self) -> list[Gate]:
        """Those of the first robot's world."""
        return self.gates_at(0)

    @property
    def per_robot(self) -> int:
        """See ``TargetTask``: gates of all rounds, in the world that has most; of others the last gate comes again."""
        return self.laps * self._rows.shape[1]

    @property
    def is_of_one_world(self) -> bool:  # type: ignore[override]
        """See ``Task``."""
        return self._given_gates is not None

    def _fixed_in(self, world: World) -> Floats | None:
        return self._gates_in(world)[:, :3]

    def _held(self, index: int) -> int:
        return self.laps * int(self._counts[index])

    def enter(self, index: int, robot: Robot) -> None:
        """See ``Task``."""
        super().enter(index, robot)
        gates = self._gates_in(world_of(robot, index))
        more = len(gates) - self._rows.shape[1]
        if more > 0:
            self._rows = np.concatenate((self._rows, np.repeat(self._rows[:, -1:], more, axis=1)), axis=1)
            self.positions = np.concatenate(
                (self.positions, np.repeat(self.positions[:, -1:], self.laps * more, axis=1)), axis=1
            )
            self._link()
        self._rows[index, : len(gates)], self._rows[index, len(gates) :] = gates, gates[-1]
        self._counts[index] = len(gates)

    def prepare(self, robot: Robot) -> None:
        """See ``Task``."""
        if not isinstance(robot, SensingRobot):
            raise EnvOptionError(f"task: robot {robot.name!r} does not say where it is")
        self._robot, self.flies = robot, flies(robot)
        self._gates_in = PerWorld(self._gates_of)
        gates = self._gates_in(robot.world)
        self._rows = np.tile(gates, (robot.count, 1, 1))
        self._counts = np.full(robot.count, len(gates))
        super().prepare(robot)
        self._sensing: SensingRobot = robot
        self._before = np.zeros((robot.count, 3))
        self._passed = np.zeros(robot.count, np.bool_)
        self._lap = np.zeros((robot.count, 3))
        """When each robot's round began, how long its last one took, and its shortest one [s]."""

    def start(self, index: int, robot: Robot, rng: np.random.Generator) -> None:
        """See ``Task``."""
        gates = self._rows[index, : self._counts[index], :3]
        self.positions[index] = gates[-1]
        self.positions[index, : self._held(index)] = np.tile(gates, (self.laps, 1))
        self.at[index], self.success[index], self._lap[index] = 0, False, 0.0
        self._before[index] = self._sensing.judged_state()[index, :3]

    def _from(self) -> Floats:
        """See ``TargetTask``: where the robot really is."""
        return self._sensing.judged_state()

    def _judge(self, step: Step, rewards: Floats, terminated: npt.NDArray[np.bool_]) -> None:
        now = step.judge.true_table()
        _cross.unchecked()(self._before, now, self._rows.reshape(-1, 6), self._counts, self.at, self._passed)
        prices = GatePrices(
            float(self.progress), float(self.far), float(self.gate_reward), float(self.each_second * step.seconds)
        )
        _pay.unchecked()(
            prices, self._before, now, Course(self._spots, self._counts, self.laps),
            np.ascontiguousarray(step.robot.time), Runs(self.at, self._lap, self._passed),
            self._outcome(rewards, terminated),
        )  # fmt: skip

    def paid_names(self) -> tuple[str, ...]:
        """See ``TargetTask``."""
        return "progress", "gates", "time"

    info_stays = True

    def info(self, step: Step) -> dict[str, npt.NDArray[Any]]:
        """See ``Task``."""
        laps = {"lap_time": self._lap[:, 1], "best_lap": self._lap[:, 2]}
        return {**super().info(step), "passed": self.at, **laps}

    def memory(self, index: int) -> Any:
        """See ``Task``."""
        return *super().memory(index), self._before[index].copy(), self._lap[index].copy()

    def recall(self, index: int, memory: Any) -> None:
        """See ``Task``."""
        super().recall(index, memory)
        self._before[index], self._lap[index] = memory[3:5]


def _checked(gates: Any) -> Floats:
    """Rows of ``Gate``, shape (gates, 6)."""
    try:
        rows = np.array([tuple(Gate(*gate)) for gate in gates], np.float64)
    except (TypeError, ValueError):
        rows = np.full((0, 6), np.nan)
    if not len(rows) or not np.isfinite(rows).all() or not (rows[:, 4:] > 0.0).all():
        raise EnvOptionError(f"Gates(gates={gates!r}); it must be (x, y, z, yaw[, width, height]), one at least")
    return rows
