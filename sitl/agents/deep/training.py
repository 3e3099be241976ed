# SPDX-License-Identifier: BSD-3-Clause
"""Trains runs of DQN, PPO and SAC. Progress is kept between two rounds of learning, so that nothing is done twice."""

from __future__ import annotations

import time
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

import gymnasium as gym

from sitl.errors import SitlError

from .. import environments
from ..errors import AgentError
from ..runs.config import RunConfig
from ..runs.curriculum import Curriculum
from ..runs.folder import ENOUGH, RunFolder
from ..runs.watch import Watch
from . import checkpoint, models
from .actions import Actions
from .checks import BEST, Checks
from .features import Features
from .library import LIBRARIES, require, stable_baselines3, torch
from .network import network_of
from .policy import DeepPolicy
from .settings import OffPolicy, Settings, as_dict, learns_by_goal, settings_of
from .tally import Tally

__all__ = ["LENGTH", "LIBRARIES", "check", "policy", "settings", "train"]

LENGTH = {"steps": 1_000_000}
_PERIOD_S = 20.0
"""Least wall time between checkpoints."""
_SHARE = 20.0
"""They come no more often than takes this many times as long as one."""


def settings(algorithm: str, given: Mapping[str, Any]) -> dict[str, Any]:
    """See ``Algorithm``.

    Raises:
        MissingExtra: a run could not be trained.
    """
    require()
    return as_dict(settings_of(algorithm, given))


def check(config: RunConfig, observations: gym.Space[Any], actions: gym.Space[Any]) -> None:
    """See ``Algorithm``."""
    settings = settings_of(config.algorithm, config.settings)
    seen = Features(observations, settings.sectors)
    Actions(actions, config.algorithm)
    if not (isinstance(settings, OffPolicy) and learns_by_goal(settings)):
        return
    episodes = settings.robots * config.max_steps
    if settings.warm_up < episodes or settings.memory < 3 * episodes:
        raise AgentError(
            f"warm_up = {settings.warm_up}, memory = {settings.memory}: with hindsight they must be {episodes} "
            f"(robots * max_steps) and {3 * episodes} at least, as it replays whole episodes"
        )
    if not (seen.has_goals and settings.frames == 1):
        raise AgentError(
            f"hindsight = {settings.hindsight}, frames = {settings.frames} in {config.env}: replay with other goals "
            "needs a goal-conditioned environment (sitl envs) and frames = 1"
        )


def train(folder: RunFolder, watch: Watch) -> None:
    """See ``Algorithm``."""
    stable_baselines3()
    config = folder.config
    settings = settings_of(config.algorithm, config.settings)
    torch(settings.threads)
    env = environments.make_many(config, settings.robots)
    watch.shows(env)
    try:
        _train(folder, watch, settings, env)
    finally:
        env.close()


def _train(folder: RunFolder, watch: Watch, settings: Settings, env: gym.vector.VectorEnv[Any, Any, Any]) -> None:
    from .robots import Robots

    config, path = folder.config, folder.path / checkpoint.MODEL
    spaces = (env.single_observation_space, env.single_action_space)
    tally = Tally(settings.robots, environments.step_time(env))
    seeds = [environments.seed_of(config.seed, robot) for robot in range(settings.robots)]
    robots = Robots(
        env, Features(spaces[0], settings.sectors), settings.frames, Actions(spaces[1], config.algorithm),
        settings.reward_scale, tally, seeds, learns_by_goal(settings),
    )  # fmt: skip
    model = models.make(config.algorithm, settings, robots, config.seed)
    if path.exists():
        checkpoint.resume(path, model, robots)
    folder.episodes.keep(tally.done)
    curriculum = Curriculum(config.curriculum, env)
    curriculum.follow(tally.done_steps)
    checks = Checks(config, settings, folder.path / BEST, model.num_timesteps)
    last, spent = time.monotonic(), 0.0

    def save() -> None:
        nonlocal last, spent
        start = time.monotonic()
        folder.episodes.append(unwritten)  # first: the log may know more than the model, not less
        unwritten.clear()
        checkpoint.save(path, model, robots, spaces)
        last = time.monotonic()
        spent = last - start

    unwritten: list[Any] = []

    def between() -> bool:
        """Called between two rounds of learning; returns whether the run ends here."""
        tally.epsilon = float(getattr(model, "exploration_rate", "nan"))
        rows = tally.take()
        if rows:
            watch.on_progress(rows)
            unwritten.extend(rows)
        curriculum.follow(tally.done_steps)
        done = config.episodes is not None and tally.done >= config.episodes
        done = done or (config.steps is not None and tally.done_steps >= config.steps)
        solved = checks.after(model, done)  # before the model is kept: one that is gone on with has been checked
        if solved is not None:
            tally.solved_checks = tally.solved_checks + 1 if solved else 0
        if settings.enough and tally.solved_checks >= settings.enough:
            (folder.path / ENOUGH).touch()
            done = True
        if time.monotonic() - last > max(_PERIOD_S, _SHARE * spent):
            save()
        return done or watch.stop

    # learning rates and the like fall towards an end that the last, unfinished episodes cannot pass
    steps = config.steps if config.steps is not None else (config.episodes or 0) * config.max_steps
    try:
        _learn(model, steps + settings.robots * config.max_steps - model.num_timesteps, between)
    finally:
        checks.close()
    unwritten.extend(tally.take())
    save()


class _Enough(SitlError):
    """Ends learning between two rounds."""


def _learn(model: Any, steps: int, between: Any) -> None:
    from stable_baselines3.common.callbacks import BaseCallback

    class Between(BaseCallback):
        def _on_rollout_start(self) -> None:
            if between():
                raise _Enough

        def _on_step(self) -> bool:
            return True

    with suppress(_Enough):
        model.learn(steps, Between(), log_interval=None, reset_num_timesteps=model.num_timesteps == 0)


def model_of(folder: RunFolder) -> Path:
    """File of the network that plays: the best one of the checks, or the last one where there were none."""
    best = folder.path / BEST
    return best if best.exists() else folder.path / checkpoint.MODEL


def policy(folder: RunFolder) -> DeepPolicy:
    """See ``Algorithm``: the best network of the checks, or the last one where there were none."""
    config = folder.config
    settings = settings_of(config.algorithm, config.settings)
    torch(settings.threads)
    model, (observations, actions) = checkpoint.load(model_of(folder), config.algorithm)
    seen, moves = Features(observations, settings.sectors), Actions(actions, config.algorithm)
    return DeepPolicy(network_of(model), settings, seen, moves)
