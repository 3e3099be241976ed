# SPDX-License-Identifier: BSD-3-Clause
"""Several swarms as one vector environment of Gymnasium: a row for each agent, for one policy that all share."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space, create_empty_array

from ..options import EnvOptionError
from ..sub_environment import row_of
from .parallel import SwarmEnv
from .tasks import Task

Flags = npt.NDArray[np.bool_]


class Agent:
    """One agent of a swarm, for what libraries ask of single environments: its attributes are the swarm's."""

    def __init__(self, swarm: SwarmEnv, name: str) -> None:
        self.swarm, self.name = swarm, name

    def get_wrapper_attr(self, name: str) -> Any:
        """See ``gymnasium.Env.get_wrapper_attr``."""
        return getattr(self.swarm, name)


class SwarmVectorEnv(VectorEnv[Any, Any, Any]):
    """Agents of several swarms, each a row: those of the first swarm in their order, then those of the second one.

    Rows see and do what ``SwarmEnv`` says of an agent. Actions of all have the same width; a rover takes no notice of
    the third number. A swarm begins anew within the step ("SameStep") in which the episode of one of its agents has
    ended. Agents whose own episode would have gone on are truncated with it; their last observations are, as those of
    all, in ``infos["final_obs"]``. Swarm k gives what a ``SwarmEnv`` gives that was reset with ``seed`` + k.

    Args:
        task: as of ``SwarmEnv``; a ``Task`` object is of one swarm alone.
        swarms: how many.
        count: vehicles of a swarm; None: the task's own.
        options: as of ``SwarmEnv``.

    Raises:
        EnvOptionError: a number or an option that cannot be.
    """

    swarms: Sequence[SwarmEnv] = ()
    """Each of them."""
    metadata = {"render_modes": [], "autoreset_mode": AutoresetMode.SAME_STEP}  # noqa: RUF012 (Gymnasium's)

    def __init__(
        self, task: str | Task = "formation", swarms: int = 1, count: int | None = None, **options: Any
    ) -> None:
        if not isinstance(swarms, int) or swarms < 1:
            raise EnvOptionError(f"swarms = {swarms!r}; it must be a whole number from 1 on")
        if swarms > 1 and not isinstance(task, str):
            raise EnvOptionError(f"task {task!r} remembers one episode: {swarms} swarms need a task's name")
        self.swarms = [SwarmEnv(task, count, **options) for _ in range(swarms)]
        first = self.swarms[0]
        for swarm in self.swarms:
            swarm.prepared = first.prepared
        agents = first.possible_agents
        self.agents = tuple(agents)
        """Names of the agents of each swarm."""
        self._widths = [first.action_space(agent).shape[0] for agent in agents]
        self.num_envs = swarms * len(agents)
        self.single_observation_space = space = first.observation_space(agents[0])
        if any(first.observation_space(agent) != space for agent in agents):
            self.close_extras()
            raise EnvOptionError(f"task {task!r}: agents do not observe the same, as rows of a vector do")
        self.single_action_space = gym.spaces.Box(-1.0, 1.0, (max(self._widths),), np.float32)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self._seen: Any = create_empty_array(self.single_observation_space, self.num_envs)

    @property
    def envs(self) -> list[Agent]:
        """Of each row its agent."""
        return [Agent(swarm, name) for swarm in self.swarms for name in self.agents]

    def reset(  # type: ignore[override]
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Begin an episode of all swarms.

        Args:
            seed: swarm k gets ``seed`` + k; or one for each agent, of which that of a swarm's first one counts.
            options: none.

        Raises:
            ValueError: not as many seeds as agents.
        """
        each = len(self.agents)
        if seed is None or isinstance(seed, int | np.integer):
            seeds = [None if seed is None else int(seed) + k for k in range(len(self.swarms))]
        else:
            if len(seed) != self.num_envs:
                raise ValueError(f"{len(seed)} seeds for num_envs = {self.num_envs}")
            seeds = list(seed[::each])
        for k, (swarm, its_seed) in enumerate(zip(self.swarms, seeds, strict=True)):
            observations, _ = swarm.reset(seed=its_seed)
            self._see(k, observations)
        return _copy(self._seen), {}

    def _see(self, k: int, observations: dict[str, Any]) -> None:
        for row, agent in enumerate(self.agents, k * len(self.agents)):
            seen = observations[agent]
            if isinstance(seen, dict):
                for name, value in seen.items():
                    self._seen[name][row] = value
            else:
                self._seen[row] = seen

    def step(self, actions: npt.NDArray[Any]) -> tuple[Any, npt.NDArray[np.float64], Flags, Flags, dict[str, Any]]:
        """Velocities of all agents for a step: see ``gymnasium.vector.VectorEnv.step``.

        Args:
            actions: shape (num_envs, 3), or (num_envs, 2) where all are rovers.

        Raises:
            InvalidAction: they have another shape, or one is outside of its space.
            ResetNeeded: before the first ``reset``.
        """
        actions = np.asarray(actions, np.float32)
        if actions.shape != self.action_space.shape:
            raise gym.error.InvalidAction(f"actions of shape {actions.shape}; it must be {self.action_space.shape}")
        rewards = np.zeros(self.num_envs)
        terminated, truncated = np.zeros((2, self.num_envs), np.bool_)
        columns: dict[str, Any] = {
            "is_success": np.zeros(self.num_envs, np.bool_),
            "was_hit": np.zeros(self.num_envs, np.bool_),
            "true_place": np.zeros((self.num_envs, 3)),
        }
        given = [self._given(actions, k) for k in range(len(self.swarms))]
        for swarm, theirs in zip(self.swarms, given, strict=True):
            swarm.check(theirs)  # all of them before the first swarm moves
        for k, swarm in enumerate(self.swarms):
            first = k * len(self.agents)
            observations, paid, terminations, _, infos = swarm.step(given[k])
            self._see(k, observations)
            over = len(swarm.agents) < len(self.agents)
            for row, agent in enumerate(self.agents, first):
                rewards[row], terminated[row] = paid[agent], terminations[agent]
                truncated[row] = over and not terminations[agent]
                for name, values in columns.items():
                    values[row] = infos[agent][name]
        ended = terminated | truncated
        return self._seen_after(ended), rewards, terminated, truncated, self._infos(columns, ended)

    def _given(self, actions: npt.NDArray[Any], k: int) -> dict[str, Any]:
        """Actions of a swarm's agents."""
        rows = enumerate(zip(self.agents, self._widths, strict=True), k * len(self.agents))
        return {agent: actions[row, :width] for row, (agent, width) in rows}

    def _seen_after(self, ended: Flags) -> Any:
        """Observations, of the next episode where one has ended; keeps the last ones of those."""
        self._last = _copy(self._seen)
        for k in np.flatnonzero(ended[:: len(self.agents)]).tolist():
            observations, _ = self.swarms[k].reset()
            self._see(k, observations)
        return _copy(self._seen)

    def _infos(self, columns: dict[str, Any], ended: Flags) -> dict[str, Any]:
        """In Gymnasium's form of "SameStep": what the last step of an episode told is in "final_info"."""
        infos = _masked(columns, ~ended)
        if ended.any():
            last = np.full(self.num_envs, None, object)
            for row in np.flatnonzero(ended).tolist():
                last[row] = row_of(self._last, row)
            final = _masked(columns, ended)
            infos |= {"final_obs": last, "_final_obs": ended, "final_info": final, "_final_info": ended.copy()}
        return infos

    def close_extras(self, **kwargs: Any) -> None:
        """Let go of all vehicles."""
        for swarm in self.swarms:
            swarm.close()


def _copy(seen: Any) -> Any:
    return {name: values.copy() for name, values in seen.items()} if isinstance(seen, dict) else seen.copy()


def _masked(columns: dict[str, Any], rows: Flags) -> dict[str, Any]:
    infos: dict[str, Any] = {}
    if rows.any():
        for name, values in columns.items():
            kept = values.copy()
            kept[~rows] = 0
            infos[name], infos["_" + name] = kept, rows.copy()
    return infos
