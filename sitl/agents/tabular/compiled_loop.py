# SPDX-License-Identifier: BSD-3-Clause
"""One episode of learning as one compiled call: a Turtlebot on native physics with the paper's kind of task.

It calls the same laws as the environment (motion, lidar, crash, digits) and as the learner, so it gives the same bits
as ``loop.learn_episode``, many times faster.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import gymnasium as gym
import numpy as np
from gymnasium.wrappers import OrderEnforcing, PassiveEnvChecker, TimeLimit

from sitl.core.array_kernels import Flags, IntColumn, IntLine, IntTable, Kernel, Line, NarrowTable, Table
from sitl.core.kernels import law
from sitl.core.records import Records
from sitl.envs.actions import Discrete
from sitl.envs.navigate import Navigate
from sitl.envs.observations import DigitPlan, Digits, digits_of
from sitl.envs.rewards import ByAction
from sitl.envs.robots.turtlebot import Turtlebot
from sitl.envs.tasks import Task, count_crashes
from sitl.physics.native.turtlebot.compiled_fleet import Orders, advance_fleet
from sitl.physics.native.turtlebot.scan import Beams
from sitl.physics.native.turtlebot.state import Turtlebot as TurtlebotRecord
from sitl.turtlebots.native import Turtlebots, ticks_in
from sitl.worlds.geometry import Solids

from .exploration import LearnerState, Memory, key_of
from .learn import Move, choose_first, learn_first
from .learner import Learner, Outcome

_TRANSPARENT = (TimeLimit, OrderEnforcing, PassiveEnvChecker)
"""Wrappers that change nothing but when an episode is truncated."""


class Rules(NamedTuple):
    """What the environment says of a step."""

    table: Table
    """Set-point of each action, shape (actions, 2)."""
    action_rewards: Line
    """Of each action, shape (actions,)."""
    crash_range: float
    """A reading below it is a crash [m]."""
    contact_ends: bool
    crash_reward: float
    digits: DigitPlan


class Robot(NamedTuple):
    """A robot, as ``advance_fleet`` takes it, and what is seen of it."""

    fleet: Records[TurtlebotRecord]
    orders: Orders
    solids: Solids
    beams: Beams
    readings: NarrowTable
    crashed: Flags
    """Memory, shape (1,)."""
    digits: IntTable
    """Memory, shape (1, n)."""


class Extent(NamedTuple):
    """Where an episode begins, and how long it is."""

    first: int
    """Number of its first state."""
    limit: int
    """Of steps."""
    step_ticks: int
    """Length of a step [physics steps]."""


class Episode(NamedTuple):
    """How an episode went."""

    steps: int
    reward: float
    """Sum over the steps."""
    crashes: int


@law
def run_episode(
    learners: Records[LearnerState],
    table: Memory,
    radix: IntLine,
    extent: Extent,
    rules: Rules,
    robot: Robot,
    touched: IntColumn,
) -> Episode:
    """Learn from the episode of a robot that was reset.

    Args:
        learners: the learner, shape (1,).
        table: its own; there must be space for ``extent.limit`` states more.
        radix: see ``key_of``.
        extent: of the episode.
        rules: of the task.
        robot: that drives.
        touched: whether something stopped it, shape (1,).
    """
    key, total, steps = extent.first, 0.0, 0
    commands, plan = robot.orders.commands, rules.digits
    action = choose_first(learners, table, key)
    while True:
        commands[0, 0], commands[0, 1] = rules.table[action, 0], rules.table[action, 1]
        robot.orders.ticks[0] = extent.step_ticks
        advance_fleet(robot.fleet, robot.orders, robot.solids, robot.beams, robot.readings)
        ended = count_crashes(robot.readings, rules.crash_range, touched, rules.contact_ends, robot.crashed)
        reward = rules.crash_reward if ended != 0 else rules.action_rewards[action]
        digits_of(robot.readings, plan.every, plan.when_inf, plan.highest, robot.digits)
        after = key_of(robot.digits[0], radix)
        action = learn_first(learners, table, Move(key, action, reward, after, ended != 0))
        key = after
        steps += 1
        total += reward
        if ended != 0 or steps >= extent.limit:
            return Episode(steps, total, ended)


_episode = Kernel(run_episode)


class CompiledLoop:
    """``learn_episode`` for one environment and one learner; see ``suits``."""

    def __init__(self, env: gym.Env[Any, Any], learner: Learner) -> None:
        self._env, self._learner, self._limit = env.unwrapped, learner, _step_limit(env)
        navigate: Any = env.unwrapped
        session = navigate.session
        task, robot = session.task, session.robot
        terms: Any = task.terms
        plan = session.observation.plan
        self._rules = Rules(
            np.ascontiguousarray(session.action.table, float), np.ascontiguousarray(terms[0].rewards, float),
            float(task.limit), bool(task.contact_ends), float(task.crash_reward), plan,
        )  # fmt: skip
        robots: Turtlebots = robot.robots
        self._robot = Robot(*robots.arguments, np.zeros(1, np.bool_), np.zeros((1, plan.digits), np.int64))
        self._touched = robot.collided
        self._ticks = ticks_in(session.seconds)
        self._run = _episode.function()

    @staticmethod
    def suits(env: gym.Env[Any, Any]) -> bool:
        """Whether it can run this environment."""
        inner: Any = env
        while isinstance(inner, _TRANSPARENT):
            inner = inner.env
        if not isinstance(inner, Navigate) or inner.render_mode is not None or _step_limit(env) is None:
            return False
        session = inner.session
        tables = [len(term.rewards) for term in session.task.terms if isinstance(term, ByAction)]
        return (
            session.latency is None
            and not session.varies
            and type(session.robot) is Turtlebot
            and type(session.robot.robots) is Turtlebots
            and type(session.task) is Task
            and len(session.task.terms) == 1
            and type(session.observation) is Digits
            and type(session.action) is Discrete
            and tables == [len(session.action.table)]
        )

    def __call__(self, seed: int, options: dict[str, Any] | None = None) -> Outcome:
        """Learn from an episode; see ``learn_episode``."""
        learner, limit = self._learner, int(self._limit or 0)
        observation, _ = self._env.reset(seed=seed, options=options)
        first = learner.first_key(observation)
        extent = Extent(first, limit, self._ticks)
        episode = self._run(
            *learner.arguments(limit), learner.table.radix, extent, self._rules, self._robot, self._touched
        )
        return Outcome(episode.steps, float(episode.reward), episode.crashes != 0)


def _step_limit(env: Any) -> int | None:
    """The least limit of steps of an episode that the wrappers have."""
    limits = []
    while isinstance(env, gym.Wrapper):
        if isinstance(env, TimeLimit):
            limits.append(int(env._max_episode_steps))
        env = env.env
    return min(limits, default=None)
