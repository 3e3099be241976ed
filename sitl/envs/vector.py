# SPDX-License-Identifier: BSD-3-Clause
"""The environment for many robots: one compiled call advances all, with the same results as single environments."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import replace
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space

from sitl.view import page_library

from .options import EnvOptionError, unknown
from .page.watchers import Directly, Watcher, opened
from .presets import options_of
from .rendering import Renderer, tile
from .robots.robot import Robot
from .session import NavigateOptions, Session, Snapshot
from .sub_environment import OfSubEnvironments, row_of
from .tasks import Task
from .tensors import as_numpy, converter
from .worlds import WorldOption

_NUMBERS = {"b": np.bool_, "i": np.int64, "u": np.int64, "f": np.float64}
"""Arrays of Python's numbers, by kind of type."""
VECTOR_RENDER_MODES = ["rgb_array", "human"]
Flags = npt.NDArray[np.bool_]


class NavigateVector(OfSubEnvironments):
    """Many robots, each in a world of its own; what ``gymnasium.make_vec`` gives for this package's environments.

    Robot i behaves as a ``Navigate`` that was reset with ``seed + i``; observations, rewards and infos are those of
    ``gymnasium.vector.SyncVectorEnv`` over such environments, in each of Gymnasium's autoreset modes.

    Args:
        num_envs: number of robots.
        max_episode_steps: number of steps after which an episode is truncated; None: never.
        render_mode: "rgb_array"; "human", all robots on the page in the browser (extra ``view``); or None.
        autoreset_mode: when a robot whose episode has ended is reset: "NextStep", by the next ``step``, which ignores
            its action; "SameStep", by the step that ended the episode, whose last observation and info are then
            ``infos["final_obs"]`` and ``infos["final_info"]``; "Disabled", by ``reset`` only.
        array: what observations, rewards, and whether episodes have ended are: "numpy", "torch" or "jax", arrays of
            these libraries on the same memory (JAX has float32 where it has no float64). Infos are NumPy's. Actions may
            be any library's that has DLPack, in the processor's memory.
        tiled: whether ``render`` gives one image, a grid of all robots, and not an image of each.
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
        autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
        array: str = "numpy",
        tiled: bool = False,
        **options: Any,
    ) -> None:
        self._convert = converter(array)
        if num_envs < 1:
            raise EnvOptionError(f"num_envs = {num_envs}; it must be 1 or more")
        if max_episode_steps is not None and max_episode_steps < 1:
            raise EnvOptionError(f"max_episode_steps = {max_episode_steps}; it must be 1 or more, or None")
        if render_mode is not None and render_mode not in VECTOR_RENDER_MODES:
            raise unknown("render_mode", render_mode, VECTOR_RENDER_MODES)
        self.autoreset_mode = _mode(autoreset_mode)
        self.metadata = {**self.metadata, "autoreset_mode": self.autoreset_mode}
        self._session = session = Session(num_envs, NavigateOptions.of(options))
        if session.faults is not None and (why := session.faults.unreached(max_episode_steps, session.seconds)):
            session.robot.close()
            raise EnvOptionError(why)
        self.num_envs = num_envs
        self.max_episode_steps = max_episode_steps
        self.render_mode = render_mode
        self.tiled = tiled
        self.single_observation_space = session.observation_space
        self.single_action_space = session.action.space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.generators = [None] * num_envs
        self.seeds = [None] * num_envs
        self._steps = np.zeros(num_envs, np.int64)
        self._ended, self._all = np.zeros(num_envs, np.bool_), np.ones(num_envs, np.bool_)
        self._over: Flags | None = getattr(session.robot, "over", None)
        self._take_all: Callable[[Any, Any], bool] | None = getattr(session.action, "take", None)
        draws = render_mode == "rgb_array"
        if render_mode == "human":
            page_library.require()
        self._watcher: Watcher | None = None
        self._renderers = [Renderer(session.robot, session.task, i) for i in range(num_envs)] if draws else []

    @property
    def robot(self) -> Robot:
        """The robots; ``pose``, ``velocity``, ``scan``, ... have a row for each."""
        return self._session.robot

    @property
    def session(self) -> Session:
        """Robots, task, observation and action of this environment."""
        return self._session

    @property
    def task(self) -> Task:
        """The task of all robots."""
        return self._session.task

    @property
    def step_time(self) -> float:
        """Simulated time of a step [s]."""
        return self._session.seconds

    # ------------------------------------------------------------------ episodes

    def reset(  # type: ignore[override]
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """See ``gymnasium.vector.SyncVectorEnv.reset``.

        Args:
            seed: robot i gets ``seed + i``; or one for each robot, None for those that go on with their random numbers.
            options: "reset_mask": which robots, booleans of shape (num_envs,); "pose": start pose of all, or a list
                with one for each robot, None for those that start where they usually do; "world": world of all, or a
                list with one for each robot, None for those that draw theirs.

        Raises:
            EnvOptionError: an option that cannot be used.
            ValueError: not as many seeds as robots.
        """
        try:
            observations, infos = self._reset(seed, options)
        except BaseException as error:
            self._session.abandon(error)
            raise
        return (observations if self._convert is None else self._convert(observations)), infos

    def _reset(
        self, seed: int | Sequence[int | None] | None, options: dict[str, Any] | None
    ) -> tuple[Any, dict[str, Any]]:
        if seed is None or isinstance(seed, int | np.integer):
            seeds = [None if seed is None else int(seed) + i for i in range(self.num_envs)]
        else:
            seeds = list(seed)
        if len(seeds) != self.num_envs:
            raise ValueError(f"{len(seeds)} seeds for num_envs = {self.num_envs}")
        rows, each = self._reset_mask(options), {"pose": self._poses(options), "world": self._worlds(options)}
        own = {name: given for name, given in each.items() if given is not None}
        if self.render_mode == "human" and self._watcher is None:
            name = self.spec.id if self.spec is not None else self.robot.name
            self.watch(Directly(opened(self._session, f"{self.num_envs} of {name}"), self._session.seconds))
        for index in np.flatnonzero(rows).tolist():
            if seeds[index] is not None or self.generators[index] is None:
                self.generators[index], self.seeds[index] = seeding.np_random(seeds[index])
            mine = {name: given[index] for name, given in own.items()}
            self._start(index, {**(options or {}), **mine} if own else options)
        self._session.look(rows)
        self._steps[rows], self._ended[rows], self.closed = 0, False, False
        return self.observe(), self._worlds_of(rows)

    def set_worlds(self, world: WorldOption) -> None:
        """Draw the worlds of later episodes of all robots from others: see ``Navigate.set_worlds``."""
        self._session.set_worlds(world)

    def _reset_mask(self, options: dict[str, Any] | None) -> Flags:
        rows = None if options is None else options.get("reset_mask")
        if rows is None:
            return np.ones(self.num_envs, np.bool_)
        if not isinstance(rows, np.ndarray) or rows.dtype != np.bool_ or rows.shape != (self.num_envs,):
            raise EnvOptionError(f"reset_mask = {rows!r}; it must be an array of {self.num_envs} booleans")
        if not rows.any():
            raise EnvOptionError("reset_mask: it must be True for one robot at least")
        return rows

    def _poses(self, options: dict[str, Any] | None) -> Sequence[Any] | None:
        """Start poses, one for each robot, where ``options`` has such; None: one for all, or none."""
        given = None if options is None else options.get("pose")
        if given is None or not any(pose is None or np.ndim(pose) == 1 for pose in given):
            return None
        if len(given) != self.num_envs:
            raise EnvOptionError(f"pose: {len(given)} start poses for num_envs = {self.num_envs}")
        poses: Sequence[Any] = given
        return poses

    def _worlds(self, options: dict[str, Any] | None) -> Sequence[Any] | None:
        """Worlds, one for each robot, where ``options`` has such; None: one for all, or none."""
        given = None if options is None else options.get("world")
        if not isinstance(given, list | tuple):
            return None
        if len(given) != self.num_envs:
            raise EnvOptionError(f"world: {len(given)} worlds for num_envs = {self.num_envs}")
        return given

    def _start(self, index: int, options: dict[str, Any] | None = None) -> None:
        self._session.reset(index, self.generator(index), options)
        if self._renderers:
            self._renderers[index].start()
        if self._watcher is not None:
            self._watcher.started(index)

    def watch(self, watcher: Watcher) -> None:
        """Let somebody look at all episodes and steps from now on, until the environment is closed."""
        self._watcher = watcher

    # ------------------------------------------------------------------ steps

    def step(self, actions: Any) -> tuple[Any, npt.NDArray[np.float64], Flags, Flags, dict[str, Any]]:
        """See ``gymnasium.vector.VectorEnv.step``.

        Raises:
            InvalidAction: there is not one action in the space for each robot.
            ResetNeeded: before the first reset; without autoreset, when an episode has ended, too.
        """
        try:
            found = self._step(actions)
        except BaseException as error:
            self._session.abandon(error)
            raise
        return found if self._convert is None else (*map(self._convert, found[:4]), found[4])  # type: ignore[return-value]

    def _step(self, actions: Any) -> tuple[Any, npt.NDArray[np.float64], Flags, Flags, dict[str, Any]]:
        session, mode = self._session, self.autoreset_mode
        self._take(actions)
        self.generator(0)
        ended = self._ended
        again = mode is not AutoresetMode.SAME_STEP and bool(ended.any())
        if again:
            self._start_again(ended)
        session.advance(~ended if again else None)
        self._steps += 1
        rewards, terminated = session.rewards.copy(), session.terminated.copy()
        if again:
            session.begin(ended)
            self._steps[ended], rewards[ended], terminated[ended] = 0, 0.0, False
        limit = self.max_episode_steps
        truncated = np.zeros(self.num_envs, np.bool_) if limit is None else self._steps >= limit
        if self._over is not None:
            truncated |= self._over
        moved = ~ended if again else self._all
        if self._renderers:
            for index in np.flatnonzero(moved).tolist():
                self._renderers[index].note()
        self._ended = ended = terminated | truncated
        if mode is AutoresetMode.SAME_STEP and ended.any():
            observations, infos = self._end_within(ended)
        else:
            observations, infos = self.observe(), self._infos(moved)
        if session.varies:  # also of robots whose next episode begins with this step
            infos |= self._worlds_of(self._all)
        if self._watcher is not None:
            self._watcher.stepped(observations)
        return observations, rewards, terminated, truncated, infos

    def _start_again(self, ended: Flags) -> None:
        """Start the episodes of robots whose last one has ended."""
        if self.autoreset_mode is AutoresetMode.DISABLED:
            raise gym.error.ResetNeeded(
                f"the episodes of robots {np.flatnonzero(ended).tolist()} have ended, and autoreset is disabled: "
                'reset(options={"reset_mask": ...}) starts others'
            )
        for index in np.flatnonzero(ended).tolist():
            self._start(index)

    def _end_within(self, ended: Flags) -> tuple[Any, dict[str, Any]]:
        """Reset the robots whose episodes this step has ended; returns observations and infos, as Gymnasium's
        "SameStep" has them."""
        session = self._session
        last, last_info, infos = self.observe(), self._infos(ended), self._infos(~ended)
        final = np.full(self.num_envs, None, object)
        for index in np.flatnonzero(ended).tolist():
            final[index] = row_of(last, index)
        self._start_again(ended)
        session.look(ended)
        self._steps[ended] = 0
        infos |= {"final_obs": final, "_final_obs": ended, "final_info": last_info, "_final_info": ended.copy()}
        return self.observe(), infos

    def _take(self, actions: Any) -> None:
        session = self._session
        check, clip_all, rows = session.check, session.clip_all, session.actions
        if not isinstance(actions, np.ndarray):
            actions = as_numpy(actions)
        try:
            count = len(actions)
        except TypeError:
            count = -1
        if count != self.num_envs:
            raise gym.error.InvalidAction(f"actions {actions!r} are not {self.num_envs}, one for each robot")
        if isinstance(actions, np.ndarray) and self._take_all is not None and self._take_all(actions, rows):
            return
        if clip_all is not None and isinstance(actions, np.ndarray) and clip_all(actions, rows):
            return
        for index in range(count):
            rows[index] = check(actions[index])

    def _infos(self, rows: Flags) -> dict[str, Any]:
        """Infos in Gymnasium's vector form: each array with a mask "_name" of the robots that it is valid for."""
        if rows is not self._all and not rows.any():
            return {}
        infos = self._worlds_of(rows)
        others = None if rows is self._all else ~rows
        for name, value in self._session.info().items():
            # A copy, as the array belongs to the task; Gymnasium makes arrays of Python's numbers.
            masked = value.astype(_NUMBERS.get(value.dtype.kind, value.dtype) if value.ndim == 1 else value.dtype)
            if others is not None:
                masked[others] = 0
            infos[name], infos["_" + name] = masked, rows.copy()
        return infos

    def _worlds_of(self, rows: Flags) -> dict[str, Any]:
        """Info of the worlds of these robots, where there are several."""
        if not self._session.varies:
            return {}
        names = self._session.world_names.copy()
        names[~rows] = None
        return {"world": names, "_world": rows.copy()}

    # ------------------------------------------------------------------ snapshots

    def snapshot_of(self, index: int) -> Snapshot:
        """A snapshot of one robot as by ``Navigate.snapshot``, with its step count and whether its episode has
        ended."""
        kept = self._session.snapshot(index, self.generator(index))
        return replace(kept, steps=int(self._steps[index]), ended=bool(self._ended[index]))

    def restore_one(self, index: int, snapshot: Snapshot) -> None:
        """Restore one robot. Snapshots of a ``Navigate`` have a step count of 0."""
        generator = self.generators[index]
        if generator is None:
            generator, self.seeds[index] = seeding.np_random(0)
        self._session.restore(index, snapshot, generator)
        self.generators[index] = generator
        self._steps[index], self._ended[index] = snapshot.steps, snapshot.ended
        if self._renderers:
            self._renderers[index].start()

    def snapshot(self) -> list[Snapshot]:
        """A snapshot of each robot: see ``snapshot_of``."""
        return [self.snapshot_of(index) for index in range(self.num_envs)]

    def restore(self, snapshots: Sequence[Snapshot]) -> Any:
        """Restore every robot: see ``restore_one``; returns the observations."""
        if len(snapshots) != self.num_envs:
            raise EnvOptionError(f"{len(snapshots)} snapshots for num_envs = {self.num_envs}")
        for index, snapshot in enumerate(snapshots):
            self.restore_one(index, snapshot)
        return self.observe() if self._convert is None else self._convert(self.observe())

    def observe(self) -> Any:
        """The observations of now."""
        return self._session.observation.observe(self._session.robot)

    # ------------------------------------------------------------------ pictures

    def picture(self, index: int) -> npt.NDArray[np.uint8] | None:
        """An image of one robot, shape (height, width, 3), uint8; None without a render mode."""
        return self._renderers[index].picture() if self._renderers else None

    def render(self) -> Any:
        """An image of each robot, a tuple of arrays of shape (height, width, 3), uint8; with ``tiled`` one such array
        with all of them in a grid, row by row; None without a render mode."""
        if not self._renderers:
            return None
        pictures = tuple(renderer.picture() for renderer in self._renderers)
        return tile(pictures) if self.tiled else pictures

    def close_extras(self, **kwargs: Any) -> None:
        """See ``gymnasium.vector.VectorEnv.close``."""
        watcher, self._watcher = getattr(self, "_watcher", None), None
        with ExitStack() as rest:  # whatever fails: first the vehicles are left in a safe mode
            if watcher is not None:
                rest.callback(watcher.close)
            if hasattr(self, "_session"):  # older Gymnasiums close what was refused while it was made, too
                self._session.robot.close()


def _mode(given: str | AutoresetMode) -> AutoresetMode:
    try:
        return AutoresetMode(given)
    except ValueError:
        raise unknown("autoreset_mode", given, [mode.value for mode in AutoresetMode]) from None


class PresetNavigateVector(NavigateVector):
    """Many of an environment of a preset (``presets.PRESETS``); every option can still be replaced."""

    def __init__(self, preset: str, num_envs: int = 1, **options: Any) -> None:
        super().__init__(num_envs, **options_of(preset, options))
