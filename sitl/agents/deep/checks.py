# SPDX-License-Identifier: BSD-3-Clause
"""Now and then the network of a run plays greedily, and the best one is kept.

The last network of a run is one of many: after an update it may crash where the one before it drove on. Learning does
not notice the checks: they have robots of their own and draw nothing from the learner's random numbers.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np

from .. import environments
from ..evaluate import Pose, moved_starts
from ..runs.config import RunConfig
from . import checkpoint
from .actions import Actions
from .features import Features, Frames
from .settings import Settings, learns_by_goal

BEST = "best.zip"
JITTER = 0.1
"""Distance by which start poses are moved where all are the same, in x and y [m] and yaw [rad]."""
SEED = 2**31
"""Seed of start poses and resets, the same for every network."""


class Checks:
    """Evaluates the network of one run at intervals and keeps the best one.

    Args:
        config: configuration of the run. Episodes are played as those of its evaluation, which may have other starts
            and be longer than those that are learnt from; where they all start at one position, starts are moved by up
            to 0.1 m and 0.1 rad.
        settings: its settings; they say how often.
        path: path of the best model; what another run left there is removed.
        begun: steps after which the run goes on; 0: it is new.
    """

    def __init__(self, config: RunConfig, settings: Settings, path: Path, begun: int) -> None:
        plan = config.evaluation
        self._config = config.with_(
            max_steps=plan.max_steps or config.max_steps, env_options={**config.env_options, **plan.options}
        )
        self._settings, self._path = settings, path
        self._every, self._count = settings.check_every, settings.check_episodes
        self._due = self._next(begun)
        self._best: checkpoint.Score = ()
        if begun and path.exists():
            self._best = checkpoint.score_of(path)
        else:
            path.unlink(missing_ok=True)
        self._env: gym.vector.VectorEnv[Any, Any, Any] | None = None
        self._poses: list[Pose] | None = None
        self.solved = 0
        """Episodes of the last check that solved the task."""

    def _next(self, steps: int) -> float:
        """Number of steps after which the next check is due."""
        return (steps // self._every + 1) * self._every if self._every else np.inf

    def after(self, model: Any, done: bool = False) -> bool | None:
        """Called after rounds of learning; ``done``: after the last one. Checks the network when it is due; then it
        returns whether every episode solved the task."""
        steps = model.num_timesteps
        if steps < self._due and not (done and self._every):
            return None
        self._due = self._next(steps)
        score = self.score(model)
        if score > self._best:
            self._best = score
            assert self._env is not None
            spaces = (self._env.single_observation_space, self._env.single_action_space)
            checkpoint.save_best(self._path, model, spaces, score)
        return self.solved == self._count

    def score(self, model: Any) -> checkpoint.Score:
        """Score of the model: all episodes are played at once. It is -inf after more crashes than the best model had:
        then the rest is not played."""
        env, self.solved = self._made(), 0
        features = Features(env.single_observation_space, self._settings.sectors)
        frames = Frames(self._count, self._settings.frames, features.width)
        actions = Actions(env.single_action_space, self._config.algorithm)
        rows = frames.begin(features(self._begun(env)))
        rewards, playing, crashes = np.zeros(self._count), np.ones(self._count, np.bool_), 0
        by_crashes, by_goal = self._settings.check_by == "crashes", learns_by_goal(self._settings)
        most = -self._best[0] if by_crashes and self._best else np.inf
        while playing.any():
            if crashes > most:
                return (-np.inf,)
            seen: Any = features.by_name(rows) if by_goal else rows
            chosen, _ = model.predict(seen, deterministic=True)
            observations, reward, terminated, truncated, infos = env.step(actions.to_environment(chosen))
            rewards[playing] += reward[playing]
            crashes += int(np.count_nonzero(terminated & playing))
            ended = playing & (terminated | truncated)
            self.solved += int(np.count_nonzero(ended & np.asarray(infos.get("is_success", False), np.bool_)))
            playing &= ~ended
            rows = frames.push(features(observations))
        mean = float(rewards.mean())
        return (-float(crashes), mean) if by_crashes else (mean,)

    def _made(self) -> gym.vector.VectorEnv[Any, Any, Any]:
        if self._env is None:
            listeners = {"gcs": None} if "gcs" in self._config.env_options else {}
            self._env = environments.make_many(self._config, self._count, **listeners)
            session = getattr(self._env.unwrapped, "session", None)
            if self._config.env_options.get("start") is None and (session is None or session.starts.fixed is not None):
                self._poses = moved_starts(self._env, self._count, SEED, JITTER)
        return self._env

    def _begun(self, env: gym.vector.VectorEnv[Any, Any, Any]) -> Any:
        """First observations of the episodes, the same in each check."""
        seeds: Any = [environments.seed_of(SEED, k) for k in range(self._count)]
        if self._poses is None:
            return env.reset(seed=seeds)[0]
        for robot, pose in enumerate(self._poses):
            observations, _ = env.reset(
                seed=seeds, options={"reset_mask": np.arange(self._count) == robot, "pose": pose}
            )
        return observations

    def close(self) -> None:
        """Close the environment."""
        if self._env is not None:
            self._env.close()
