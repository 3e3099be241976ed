# SPDX-License-Identifier: BSD-3-Clause
"""The environment for one robot: any robot in any world, with any task, observation and action."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from functools import partial
from typing import Any

import gymnasium as gym

from sitl.view import page_library
from sitl.worlds import World

from .boxes import GoalConditioned
from .options import EnvOptionError, unknown
from .page.watchers import Directly, Watcher, opened
from .rendering import RENDER_MODES, Renderer
from .robots.robot import Robot
from .session import NavigateOptions, Session, Snapshot
from .tasks import Task, reward_of_goals
from .worlds import WorldOption


class Navigate(gym.Env[Any, Any]):
    """A robot that navigates by lidar.

    Args:
        render_mode: "rgb_array"; "human": the browser view if the extra ``view`` is installed, else a window;
            "window"; or None.
        options: see ``NavigateOptions``: robot, world, task, observation, action, setpoint, step_time, start,
            randomise, latency, faults, info, judge, costs, and options of the robot's class.

    ``reset`` takes ``options={"pose": (x, y, yaw)}``, the start pose [m, rad], and "world", the episode's world.
    ``info`` has "crashed", the task's entries (``Task.info``), and those that the option ``info`` names.

    Raises:
        EnvOptionError: an option that cannot be used; the message says what is allowed.
    """

    metadata = {"render_modes": RENDER_MODES, "render_fps": 30}  # noqa: RUF012 (Gymnasium's)

    def __init__(self, *, render_mode: str | None = None, **options: Any) -> None:
        if render_mode is not None and render_mode not in RENDER_MODES:
            raise unknown("render_mode", render_mode, RENDER_MODES)
        if "autoreset_mode" in options:
            raise EnvOptionError(
                f"autoreset_mode = {options['autoreset_mode']!r}: a single environment is reset by reset(); "
                'gymnasium.make_vec with vectorization_mode="sync" or "async" takes the mode in vector_kwargs'
            )
        self._session = session = Session(1, NavigateOptions.of(options))
        self.observation_space = session.observation_space
        self.action_space = session.action.space
        self.render_mode = render_mode
        self._watcher: Watcher | None = None
        self._is_on_page = render_mode == "human" and page_library.is_installed()
        draws = render_mode is not None and not self._is_on_page
        self._renderer = Renderer(session.robot, session.task) if draws else None
        self._is_begun = False
        self._bind()

    def _bind(self) -> None:
        """Look up once what every step needs."""
        session = self._session
        self._check, self._actions, self._advance = session.check, session.actions, session.advance
        self._observe, self._info = session.observation.observe, session.info
        has_more = session.faults is not None or session.details or session.costs
        self._plain_info = type(session.task).info is Task.info and not has_more
        self._infos_stay = session.infos_stay()
        self._takes: list[tuple[str, Callable[[], Any]]] | None = None
        """Entries of ``info`` and what gives them, where the arrays that they are taken from stay; None: not yet."""
        self._over = getattr(session.robot, "over", None)
        self._is_dict = isinstance(self.observation_space, gym.spaces.Dict)

    @property
    def robot(self) -> Robot:
        """The robot: ``pose``, ``velocity``, ``scan``, ... with one row."""
        return self._session.robot

    @property
    def world(self) -> World:
        """The world of the present episode."""
        return self._session.robot.world

    @property
    def session(self) -> Session:
        """Robot, task, observation and action of this environment."""
        return self._session

    @property
    def task(self) -> Task:
        """The task."""
        return self._session.task

    @property
    def step_time(self) -> float:
        """Simulated time of a step [s]."""
        return self._session.seconds

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """See ``gymnasium.Env.reset``; options: "pose" and "world" of this episode."""
        try:
            return self._reset(seed, options)
        except BaseException as error:
            self._session.abandon(error)
            raise

    def _reset(self, seed: int | None, options: dict[str, Any] | None) -> tuple[Any, dict[str, Any]]:
        if options and "reset_mask" in options:
            raise EnvOptionError("reset: option 'reset_mask' is for vector environments only")
        super().reset(seed=seed)
        if not self._is_begun:
            self._say_unreached()
        self._session.reset(0, self.np_random, options)
        self._session.look()
        self._is_begun = True
        if self._renderer is not None:
            self._renderer.start()
            self._show()
        if self._is_on_page and self._watcher is None:
            self.watch(Directly(opened(self._session, self._title), self._session.seconds))
        if self._watcher is not None:
            self._watcher.started(0)
        return self._observation(), {"world": self._session.world_names[0]} if self._session.varies else {}

    def set_worlds(self, world: WorldOption) -> None:
        """Draw the worlds of later episodes from others: a curriculum (docs/worlds.md). The present episode goes on.

        Args:
            world: as the option ``world``.

        Raises:
            EnvOptionError: no such world, or one that robot or task cannot be in; those before stay.
        """
        self._session.set_worlds(world)

    def _say_unreached(self) -> None:
        """Warn of a fault that no episode reaches; ``gymnasium.make`` keeps to itself which limit it was given."""
        registered = gym.registry.get(self.spec.id) if self.spec is not None else None
        if self._session.faults is not None and registered is not None:
            why = self._session.faults.unreached(registered.max_episode_steps, self._session.seconds)
            if why:
                gym.logger.warn(f"{why}, unless max_episode_steps was given")

    def watch(self, watcher: Watcher) -> None:
        """Show all episodes and steps to a watcher, from the next reset until the environment is closed."""
        self._watcher = watcher

    @property
    def _title(self) -> str:
        return self.spec.id if self.spec is not None else f"{self.robot.name} in {self.world.name}"

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """See ``gymnasium.Env.step``. An episode is truncated by a ``TimeLimit``, or when the agent has lost control of
        a vehicle at a connection: ``info["handed_over"]`` says why.

        Raises:
            InvalidAction: the action is not in the space: a number that is not finite, another shape, without
                ``clip_actions`` a number outside of its limits, too.
            ResetNeeded: before the first ``reset``.
        """
        try:
            return self._step(action)
        except BaseException as error:
            self._session.abandon(error)
            raise

    def _step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        if not self._is_begun:
            raise gym.error.ResetNeeded("step() before the first reset(): call reset() first")
        session = self._session
        self._actions[0] = self._check(action)
        self._advance()
        terminated = bool(session.terminated[0])
        if self._plain_info:
            info: dict[str, Any] = {"crashed": terminated}
        elif self._takes is not None:
            session.write_details()
            info = {name: take() for name, take in self._takes}
        else:
            rows = self._info().items()
            takes = [(name, value.item if value.ndim == 1 else value[0].copy) for name, value in rows]
            info = {name: take() for name, take in takes}
            if self._infos_stay:
                self._takes = takes
        if session.varies:
            info["world"] = session.world_names[0]
        truncated = self._over is not None and bool(self._over[0])
        if truncated:
            info["handed_over"] = session.robot.why_over()  # type: ignore[attr-defined]
        if self._renderer is not None:
            self._renderer.note()
            self._show()
        return self._observation(self._watcher), float(session.rewards[0]), terminated, truncated, info

    def _observation(self, watcher: Watcher | None = None) -> Any:
        rows = self._observe(self._session.robot)
        if watcher is not None:
            watcher.stepped(rows)
        if self._is_dict:
            return {name: value[0] for name, value in rows.items()}
        return rows[0]

    @property
    def compute_reward(self) -> Callable[[Any, Any, Any], Any]:
        """The reward of goals in a goal-conditioned environment: see ``Hold.compute_reward``. Other environments do not
        have this attribute, which is how libraries tell them apart.

        Raises:
            AttributeError: the task has no goal that counts alone, or the observation does not tell it.
        """
        if not isinstance(self._session.observation, GoalConditioned):
            raise AttributeError(f"compute_reward: task {self.task!r} is not observed by its goal (GoalConditioned)")
        return partial(reward_of_goals, self.task)

    def snapshot(self) -> Snapshot:
        """State of robot, episode and random numbers; after ``restore`` it continues bit for bit. Picklable.

        The step count of a ``TimeLimit`` around this environment is not part of it.
        """
        return self._session.snapshot(0, self.np_random)

    def restore(self, snapshot: Snapshot) -> Any:
        """Restore a snapshot of this or of an equal environment; returns the observation."""
        self._session.restore(0, snapshot, self.np_random)
        self._is_begun = True
        if self._renderer is not None:
            self._renderer.start()
        return self._observation()

    def render(self) -> Any:
        """An image from above, shape (height, width, 3), uint8; None in the other modes, where ``step`` shows it."""
        if self._is_on_page:
            return None
        if self._renderer is None:
            gym.logger.warn(
                "render() without a render mode: make the environment with "
                f'gym.make("{self.spec.id if self.spec else "sitl/Navigate-v1"}", render_mode="rgb_array")'
            )
            return None
        return self._renderer.picture() if self.render_mode == "rgb_array" else self._renderer.show()

    def _show(self) -> None:
        if self.render_mode in ("human", "window") and self._renderer is not None:
            self._renderer.show()

    def close(self) -> None:
        """Close the window or the page, and the robot's connections; may be called twice."""
        watcher, self._watcher = self._watcher, None
        with ExitStack() as rest:  # whatever fails: first the vehicle is left in a safe mode
            if self._renderer is not None:
                rest.callback(self._renderer.close)
            if watcher is not None:
                rest.callback(watcher.close)
            self._session.robot.close()

    def __getstate__(self) -> dict[str, Any]:
        bound = ("_check", "_actions", "_advance", "_observe", "_info", "_over", "_takes")
        return {**{name: value for name, value in vars(self).items() if name not in bound}, "_watcher": None}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        self._bind()
