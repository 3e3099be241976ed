# SPDX-License-Identifier: BSD-3-Clause
"""The environment for many robots: one compiled call advances all, with the same results as single environments."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from .options import EnvOptionError, unknown
from .rendering import Renderer
from .robots.robot import Robot
from .session import NavigateOptions, Session, Snapshot

VECTOR_RENDER_MODES = ["rgb_array"]


class NavigateVector(VectorEnv[Any, Any, Any]):
    """Many robots, each in a world of its own; what ``gymnasium.make_vec`` gives for this package's environments.

    Robot i behaves as a ``Navigate`` that was reset with ``seed + i``. As in Gymnasium's own vector environments, a
    robot whose episode has ended is reset by the next ``step``, which ignores its action (``AutoresetMode.NEXT_STEP``).

    Args:
        num_envs: number of robots.
        max_episode_steps: number of steps after which an episode is truncated; None: never.
        render_mode: "rgb_array" or None.
        options: see ``NavigateOptions``.
    """

    metadata = {  # noqa: RUF012 (Gymnasium's)
        "render_modes": VECTOR_RENDER_MODES,
        "render_fps": 30,
        "autoreset_mode": AutoresetMode.NEXT_STEP,
    }

    def __init__(
        self,
        num_envs: int = 1,
        max_episode_steps: int | None = None,
        *,
        render_mode: str | None = None,
        **options: Any,
    ) -> None:
        if num_envs < 1:
            raise EnvOptionError(f"num_envs = {num_envs}; it must be 1 or more")
        if max_episode_steps is not None and max_episode_steps < 1:
            raise EnvOptionError(f"max_episode_steps = {max_episode_steps}; it must be 1 or more, or None")
        if render_mode is not None and render_mode not in VECTOR_RENDER_MODES:
            raise unknown("render_mode", render_mode, VECTOR_RENDER_MODES)
        self._session = session = Session(num_envs, NavigateOptions.of(options))
        self.num_envs = num_envs
        self.max_episode_steps = max_episode_steps
        self.render_mode = render_mode
        self.single_observation_space = session.observation_space
        self.single_action_space = session.action.space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._generators: list[np.random.Generator | None] = [None] * num_envs
        self._steps = np.zeros(num_envs, np.int64)
        self._ended = np.zeros(num_envs, np.bool_)
        self._renderers = [Renderer(session.robot, session.task, i) for i in range(num_envs)] if render_mode else []

    @property
    def robot(self) -> Robot:
        """The robots; ``pose``, ``velocity``, ``scan``, ... have a row for each."""
        return self._session.robot

    @property
    def step_time(self) -> float:
        """Simulated time of a step [s]."""
        return self._session.seconds

    def reset(  # type: ignore[override]
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """See ``gymnasium.vector.SyncVectorEnv.reset``; options: "reset_mask" (which robots), "pose"."""
        if seed is None or isinstance(seed, int | np.integer):
            seeds = [None if seed is None else int(seed) + i for i in range(self.num_envs)]
        else:
            seeds = list(seed)
        if len(seeds) != self.num_envs:
            raise ValueError(f"{len(seeds)} seeds for num_envs = {self.num_envs}")
        rows = self._reset_mask(options)
        for index in np.flatnonzero(rows):
            if seeds[index] is not None or self._generators[index] is None:
                self._generators[index], _ = seeding.np_random(seeds[index])
            self._start(int(index), options)
        self._session.look(rows)
        self._steps[rows], self._ended[rows] = 0, False
        return self._session.observation.observe(self._session.robot), {}

    def _reset_mask(self, options: dict[str, Any] | None) -> npt.NDArray[np.bool_]:
        rows = np.ones(self.num_envs, np.bool_) if options is None else options.get("reset_mask")
        if rows is None:
            return np.ones(self.num_envs, np.bool_)
        if not isinstance(rows, np.ndarray) or rows.dtype != np.bool_ or rows.shape != (self.num_envs,):
            raise EnvOptionError(f"reset_mask = {rows!r}; it must be an array of {self.num_envs} booleans")
        return rows

    def _generator(self, index: int) -> np.random.Generator:
        generator = self._generators[index]
        if generator is None:
            raise gym.error.ResetNeeded("the robots stand nowhere before the first reset()")
        return generator

    def _start(self, index: int, options: dict[str, Any] | None) -> None:
        self._session.reset(index, self._generator(index), options)
        if self._renderers:
            self._renderers[index].start()

    def step(
        self, actions: Any
    ) -> tuple[Any, npt.NDArray[np.float64], npt.NDArray[np.bool_], npt.NDArray[np.bool_], dict[str, Any]]:
        """See ``gymnasium.vector.VectorEnv.step``.

        Raises:
            InvalidAction: there is not one action in the space for each robot.
        """
        session, ended = self._session, self._ended
        self._take(actions)
        again = bool(ended.any())
        if again:
            for index in np.flatnonzero(ended):
                self._start(int(index), None)
        self._generator(0)
        session.advance(~ended if again else None)
        self._steps += 1
        rewards, terminated = session.rewards.copy(), session.terminated.copy()
        if again:
            self._steps[ended], rewards[ended], terminated[ended] = 0, 0.0, False
        limit = self.max_episode_steps
        truncated = np.zeros(self.num_envs, np.bool_) if limit is None else self._steps >= limit
        infos = self._infos(~ended)
        self._ended = terminated | truncated
        for renderer in self._renderers:
            renderer.note()
        return session.observation.observe(session.robot), rewards, terminated, truncated, infos

    def _take(self, actions: Any) -> None:
        check, rows = self._session.action.check, self._session.actions
        try:
            count = len(actions)
        except TypeError:
            count = -1
        if count != self.num_envs:
            raise gym.error.InvalidAction(f"actions {actions!r} are not {self.num_envs}, one for each robot")
        if isinstance(actions, np.ndarray) and self.action_space.contains(actions):
            rows[...] = actions
            return
        for index in range(count):
            rows[index] = check(actions[index])

    def _infos(self, rows: npt.NDArray[np.bool_]) -> dict[str, Any]:
        """Infos in Gymnasium's vector form: each array with a mask "_name" of the robots that it is valid for."""
        infos: dict[str, Any] = {}
        for name, value in self._session.task.info(self._session.step).items():
            masked = np.array(value)  # a copy: the array belongs to the task
            masked[~rows] = 0
            infos[name], infos["_" + name] = masked, rows.copy()
        return infos

    def snapshot(self) -> list[Snapshot]:
        """A snapshot of each robot as by ``Navigate.snapshot``, with its step count and whether its episode has
        ended."""
        return [
            replace(
                self._session.snapshot(index, self._generator(index)),
                steps=int(self._steps[index]),
                ended=bool(self._ended[index]),
            )
            for index in range(self.num_envs)
        ]

    def restore(self, snapshots: Sequence[Snapshot]) -> Any:
        """Restore every robot; returns the observations. Snapshots of a ``Navigate`` have a step count of 0."""
        if len(snapshots) != self.num_envs:
            raise EnvOptionError(f"{len(snapshots)} snapshots for num_envs = {self.num_envs}")
        for index, snapshot in enumerate(snapshots):
            generator = self._generators[index]
            if generator is None:
                generator, _ = seeding.np_random(0)
            self._session.restore(index, snapshot, generator)
            self._generators[index] = generator
            self._steps[index], self._ended[index] = snapshot.steps, snapshot.ended
        for renderer in self._renderers:
            renderer.start()
        return self._session.observation.observe(self._session.robot)

    def render(self) -> tuple[npt.NDArray[np.uint8], ...] | None:
        """An image of each robot, shape (height, width, 3), uint8; None without a render mode."""
        return tuple(renderer.picture() for renderer in self._renderers) if self._renderers else None

    def close_extras(self, **kwargs: Any) -> None:
        """See ``gymnasium.vector.VectorEnv.close``."""
        self._session.robot.close()
