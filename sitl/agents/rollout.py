# SPDX-License-Identifier: BSD-3-Clause
"""Plays many episodes of an environment with a policy: fleets in this process, in several, or on a Ray cluster.

Episode k follows from the seed and from k. Episodes are divided into parts, always the same ones, and a worker plays
one part after another: which worker that is, and how many there are, changes nothing.
"""

from __future__ import annotations

import pickle
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from sitl.core import code_in_files
from sitl.envs.robots.vehicles import INPROCESS

from . import environments, learnt
from .errors import AgentError
from .evaluate import Evaluation, Played
from .named_policies import Named, policies_of
from .runs.backends import BACKENDS, Workers
from .runs.config import MAX_STEPS, RunConfig
from .runs.files import make_folder, write_arrays
from .runs.local import SendProgress, Stopped

ROBOTS = 64
"""Default number of robots of a worker."""
EPISODES_A_ROBOT = 4
"""Episodes of a part, by the number of its robots: a robot whose episode has ended plays the part's next one."""
TRAJECTORIES = "trajectories.npz"


@dataclass(frozen=True)
class Part:
    """Episodes that one worker plays; picklable."""

    config: RunConfig
    policy: Named
    seed: int
    first: int
    """Number of the first episode."""
    episodes: int
    robots: int
    folder: Path | None
    """Where trajectories are written; None: nowhere."""

    def __repr__(self) -> str:
        return f"episodes {self.first} to {self.first + self.episodes - 1} of {self.config.env}"


def rollout(
    policy: Named,
    env: str | None = None,
    episodes: int = 100,
    *,
    seed: int = 0,
    max_steps: int | None = None,
    options: Mapping[str, Any] | None = None,
    robots: int = ROBOTS,
    workers: Workers | None = None,
    trajectories: Path | None = None,
    on_progress: Any = lambda index, ended: None,
) -> Evaluation:
    """Play episodes; the results are in their order.

    Args:
        policy: folder of a run, or the file (.npz) of a policy; "random"; a function that takes observations with
            a row a robot; or the name of one, "MODULE:FUNCTION". A function must remember nothing from call to call.
        env: id of the environment; None: that of the run.
        episodes: number of episodes.
        seed: seed of all; that of episode k is ``environments.seed_of(seed, k)``, of its reset and of its policy.
        max_steps: of an episode; None: as the run has it, else 1500.
        options: of the environment, beside those of the run, in whose place they come.
        robots: that a worker flies at once, in one vector environment.
        workers: how many and where; None: this process.
        trajectories: folder to write trajectories to (see ``docs/scaling.md``); None: they are not kept.
        on_progress: called with the number of a part and of its episodes that have ended since the last call.

    Raises:
        AgentError: no such environment, policy or option; a number that cannot be; a policy that cannot be sent.
        KeyboardInterrupt: it was interrupted.
        RuntimeError: a worker died (with Ray: three times on the same part).
    """
    workers = workers or Workers()
    if episodes < 1 or robots < 1:
        name, value = ("episodes", episodes) if episodes < 1 else ("robots", robots)
        raise AgentError(f"{name} = {value}; it must be 1 or more")
    config = _config(policy, env, max_steps, dict(options or {}))
    connection = config.env_options.get("connection", INPROCESS)
    if connection != INPROCESS and (workers.jobs > 1 or workers.backend != BACKENDS[0]):
        raise AgentError(
            f"connection {connection!r} leads to one vehicle: one process of this machine flies it (--jobs 1)"
        )
    if workers.backend == "local" and workers.jobs > 1:
        _check_sendable(policy)
    length = robots * EPISODES_A_ROBOT
    parts = []
    for first in range(0, episodes, length):
        count = min(length, episodes - first)
        folder = None if trajectories is None else trajectories / f"{first:07d}"
        if folder is not None:
            make_folder(folder)
        parts.append(Part(config, policy, seed, first, count, min(robots, count), folder))
    played = workers.each(play, parts, workers.jobs, on_progress)
    if None in played:
        raise KeyboardInterrupt
    return Evaluation(tuple(one for part in played for one in part))


def _config(policy: Named, env: str | None, max_steps: int | None, options: Mapping[str, Any]) -> RunConfig:
    if isinstance(policy, Path):
        run = learnt.load(policy, code_in_files.EVERY).config
        same = env is None or _unversioned(env) == _unversioned(run.env)
        refused = code_in_files.refusal(policy, run.code_but(options)) if same else None
        if refused is not None:
            raise AgentError(refused)
        return run.with_(
            env=env or run.env,
            max_steps=max_steps or run.max_steps,
            env_options={**run.env_options, **options} if same else options,
        )
    if env is None:
        raise AgentError(f"policy {policy!r} has no environment of its own: give ENV, the id of one")
    return RunConfig(env, "none", options, max_steps=max_steps or MAX_STEPS)


def _unversioned(env: str) -> str:
    """An id without its version: versions have the same observations and actions."""
    return re.sub(r"-v\d+$", "", env)


def _check_sendable(policy: Named) -> None:
    try:
        pickle.dumps(policy)
    except Exception as error:
        raise AgentError(
            f"policy {policy!r} cannot be sent to other processes ({error}); define it at the top of a module"
        ) from None


def play(part: Part, send_progress: SendProgress, stopped: Stopped) -> list[Played] | None:
    """Play a part; None when it was stopped."""
    env = environments.make_many(part.config, part.robots)
    try:
        play = _Play(part, env)
        while play.goes_on:
            ended = play.step()
            if ended:
                send_progress(ended)
            if stopped():
                return None
        if part.folder is not None:
            write_arrays(part.folder / TRAJECTORIES, play.trajectories())
        return play.results()
    finally:
        env.close()


class _Play:
    """The episodes of a part in progress."""

    def __init__(self, part: Part, env: gym.vector.VectorEnv[Any, Any, Any]) -> None:
        self._part, self._env, count = part, env, env.num_envs
        self._policies = policies_of(part.policy, env)
        self._step_time = environments.step_time(env)
        self._episode = np.arange(count)
        """Number within the part of the episode that each robot plays; -1: there was none left for it."""
        self._next = count
        self._reward, self._steps = np.zeros(part.episodes), np.zeros(part.episodes, np.int64)
        self._terminated, self._crashed, self._reached = np.zeros((3, part.episodes), np.bool_)
        self._kept: list[dict[str, Any]] = []
        """Of each step, what trajectories have, with a row for each robot that plays."""
        self._last: list[dict[str, Any]] = []
        """The same of final observations."""
        self._observations: Any = None
        self._begin(np.ones(count, np.bool_))

    @property
    def goes_on(self) -> bool:
        """Whether an episode has not ended."""
        return bool((self._episode >= 0).any())

    def _begin(self, rows: npt.NDArray[np.bool_]) -> None:
        seeds: list[int | None] = [None] * len(rows)
        robots = np.flatnonzero(rows)
        for robot in robots.tolist():
            seeds[robot] = environments.seed_of(self._part.seed, self._part.first + int(self._episode[robot]))
        options = None if rows.all() else {"reset_mask": rows}
        self._observations, _ = self._env.reset(seed=seeds, options=options)  # type: ignore[arg-type]
        self._policies.begin(robots, [seeds[robot] for robot in robots])  # type: ignore[misc]

    def step(self) -> int:
        """One step of all robots; returns how many episodes ended with it."""
        playing = self._episode >= 0
        episodes = self._episode[playing]
        before = self._observations
        keeps = self._part.folder is not None
        actions = self._policies.act(before)
        if keeps:
            kept = {**_rows("observations", before, playing), "actions": np.asarray(actions)[playing]}
        self._observations, rewards, terminated, truncated, infos = self._env.step(actions)
        self._reward[episodes] += rewards[playing]
        self._steps[episodes] += 1
        if keeps:
            self._kept.append({"episode": episodes, **kept, "rewards": rewards[playing]})
        ended = playing & (terminated | truncated)
        if not ended.any():
            return 0
        done, none = self._episode[ended], np.zeros(len(ended), np.bool_)
        self._terminated[done] = terminated[ended]
        self._crashed[done] = infos.get("crashed", none)[ended]
        self._reached[done] = infos.get("is_success", infos.get("reached", none))[ended]
        if keeps:
            self._last.append({"episode": done, **_rows("final_observations", self._observations, ended)})
        again = np.flatnonzero(ended)[: self._part.episodes - self._next]
        self._episode[ended] = -1
        if len(again):
            self._episode[again] = np.arange(self._next, self._next + len(again))
            self._next += len(again)
            mask = none.copy()
            mask[again] = True
            self._begin(mask)
        return len(done)

    def results(self) -> list[Played]:
        """Results in the order of episodes."""
        judge = environments.judged_by(self._env)
        columns = (self._reward, self._steps, self._terminated, self._crashed, self._reached)
        return [
            Played(reward, steps, terminated, crashed, reached, steps * self._step_time, float("nan"), judge)
            for reward, steps, terminated, crashed, reached in zip(*(column.tolist() for column in columns))
        ]

    def trajectories(self) -> dict[str, npt.NDArray[Any]]:
        """All steps, episode after episode, and the observations after the last steps."""
        return {
            "first_episode": np.array(self._part.first),
            "steps": self._steps,
            "terminated": self._terminated,
            **_in_order(self._kept),
            **_in_order(self._last),
        }


def _rows(name: str, observations: Any, rows: npt.NDArray[np.bool_]) -> dict[str, Any]:
    """Copies of some robots' observations, by name."""
    if isinstance(observations, dict):
        return {f"{name}.{part}": values[rows] for part, values in observations.items()}
    return {name: observations[rows]}


def _in_order(pieces: Sequence[Mapping[str, Any]]) -> dict[str, npt.NDArray[Any]]:
    """Pieces in one, by episode, and within an episode as they came."""
    order = np.argsort(np.concatenate([piece["episode"] for piece in pieces]), kind="stable")
    return {name: np.concatenate([piece[name] for piece in pieces])[order] for name in pieces[0] if name != "episode"}
