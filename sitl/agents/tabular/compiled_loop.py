# SPDX-License-Identifier: BSD-3-Clause
"""One episode of learning as one compiled call: a Turtlebot on native physics with the paper's kind of task.

It calls the same laws as the environment (motion, lidar, crash, digits) and as the learner, so it gives the same bits
as ``loop.learn_episode``, many times faster.
"""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.wrappers import OrderEnforcing, PassiveEnvChecker, TimeLimit

from sitl.core.array_kernels import kernel
from sitl.core.kernels import law
from sitl.envs.actions import Discrete
from sitl.envs.navigate import Navigate
from sitl.envs.observations import Digits, digits_of
from sitl.envs.rewards import ByAction
from sitl.envs.robots.turtlebot import Turtlebot
from sitl.envs.tasks import Task, count_crashes
from sitl.physics.native.turtlebot.fleet import advance_fleet
from sitl.physics.native.turtlebot.state import Turtlebot as TurtlebotRecord
from sitl.turtlebots.native import Turtlebots, ticks_in

from .learn import choose_first, learn_first, learners_type
from .learner import Learner
from .outcome import Outcome
from .slots import key_of

_TRANSPARENT = (TimeLimit, OrderEnforcing, PassiveEnvChecker)
"""Wrappers that change nothing but when an episode is truncated."""


@law
def run_episode(
    learners, keys, values, visits, first, radix, limit, step_ticks,
    table, action_rewards, crash_range, contact_ends, crash_reward, every, when_inf, highest,
    crashed, touched, digits,
    fleet, commands, ticks, solids, grid, cells, rays, directions, ranges, readings,
):  # fmt: skip
    """Learn from the episode of a robot that was reset; returns steps, sum of rewards, and whether it crashed (1, 0).

    Args:
        learners, keys, values, visits: of a learner; there must be room for ``limit`` states more.
        first: number of the first state.
        radix: see ``key_of``.
        limit: largest number of steps.
        step_ticks: length of a step [physics steps].
        table: set-point of each action, shape (actions, 2).
        action_rewards: reward of each action, shape (actions,).
        crash_range, contact_ends, crash_reward: of the task.
        every, when_inf, highest: of the digits.
        crashed, touched, digits: room, shape (1,); the robot's ``collided``; room, shape (1, n).
        fleet, commands, ticks, solids, grid, cells, rays, directions, ranges, readings: see ``advance_fleet``.
    """
    key, total, steps = first, 0.0, 0
    action = choose_first(learners, keys, values, key)
    while True:
        commands[0, 0], commands[0, 1] = table[action, 0], table[action, 1]
        ticks[0] = step_ticks
        advance_fleet(fleet, commands, ticks, solids, grid, cells, rays, directions, ranges, readings)
        ended = count_crashes(readings, crash_range, touched, contact_ends, crashed)
        reward = crash_reward if ended != 0 else float(action_rewards[action])
        digits_of(readings, every, when_inf, highest, digits)
        after = key_of(digits[0], radix)
        action = learn_first(learners, keys, values, visits, key, action, reward, after, ended)
        key = after
        steps += 1
        total += reward
        if ended != 0 or steps >= limit:
            return steps, total, ended


def _signature() -> Any:
    from numba import types

    from sitl.core.numba_records import numba_type

    whole, number = types.int64, types.float64
    line, table, wholes = number[::1], number[:, ::1], whole[::1]
    fleet = types.Array(numba_type(TurtlebotRecord), 1, "C")
    learner = (learners_type(), wholes, table, whole[:, ::1])
    task = (table, line, number, whole, number, whole, whole, whole)
    room = (types.boolean[::1], whole[:], whole[:, ::1])
    robot = (fleet, table, wholes, table, line, wholes, table, table, line, types.float32[:, ::1])
    result = types.Tuple((whole, number, whole))
    return result(*learner, whole, wholes, whole, whole, *task, *room, *robot)


_episode = kernel(_signature)(run_episode)


class CompiledLoop:
    """``learn_episode`` for one environment and one learner; see ``suits``."""

    def __init__(self, env: gym.Env[Any, Any], learner: Learner) -> None:
        self._env, self._learner, self._limit = env.unwrapped, learner, _step_limit(env)
        navigate: Any = env.unwrapped
        session = navigate.session
        task, robot = session.task, session.robot
        terms: Any = task.terms
        every, when_inf, highest, taken = session.observation.plan
        self._steps = (
            np.ascontiguousarray(session.action.table),
            np.ascontiguousarray(terms[0].rewards),
            float(task.limit), int(task.contact_ends), float(task.crash_reward),
            every, when_inf, highest,
            np.zeros(1, np.bool_), robot.collided, np.zeros((1, taken), np.int64),
        )  # fmt: skip
        self._robots: Turtlebots = robot.robots
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
        steps, total, ended = self._run(
            *learner.arguments(limit), first, learner.table.radix, limit, self._ticks,
            *self._steps, *self._robots.arguments,
        )  # fmt: skip
        return Outcome(int(steps), float(total), bool(ended))


def _step_limit(env: Any) -> int | None:
    """The least limit of steps of an episode that the wrappers have."""
    limits = []
    while isinstance(env, gym.Wrapper):
        if isinstance(env, TimeLimit):
            limits.append(int(env._max_episode_steps))
        env = env.env
    return min(limits, default=None)
