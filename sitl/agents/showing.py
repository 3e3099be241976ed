# SPDX-License-Identifier: BSD-3-Clause
"""A learnt policy at work, in a window or on a film."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gymnasium as gym
from gymnasium.error import DependencyNotInstalled

from sitl.core.extras import MissingExtra

from . import environments
from .algorithms import Policy, policy_of
from .errors import AgentError
from .film import Reel
from .runs.folder import RunFolder

STEP_S = 1.0
"""Step time of environments that do not give one [s]."""
AfterStep = Callable[[Any], bool]
"""Called with the environment after each reset and step; False ends the show."""
Ended = Callable[[int, int, float, bool], None]
"""Called after an episode: its number, steps, reward, whether it ended by itself."""


def play(env: gym.Env[Any, Any], policy: Policy, episodes: int, seed: int, after: AfterStep, ended: Ended) -> None:
    """Play episodes, one after another."""
    policy.check(env.observation_space, env.action_space)
    for episode in range(episodes):
        one = environments.seed_of(seed, episode)
        observation, _ = env.reset(seed=one)
        policy.begin(one)
        steps, total, terminated, truncated = 0, 0.0, False, False
        going_on = after(env)
        while going_on and not (terminated or truncated):
            observation, reward, terminated, truncated, _ = env.step(policy.act(observation))
            steps, total = steps + 1, total + float(reward)
            going_on = after(env)
        ended(episode, steps, total, bool(terminated))
        if not going_on:
            return


def film(run: RunFolder, path: Path, episodes: int, seed: int, speed: float, ended: Ended, **options: Any) -> int:
    """Record episodes in a file; returns its number of frames.

    Args:
        run: run that has a model.
        path: .gif or .mp4.
        episodes: number of episodes.
        seed: seed of the episodes.
        speed: speed of the animation relative to real time.
        ended: see ``Ended``.
        options: options of the environment, which replace the run's.

    Raises:
        AgentError: no model, or no such film.
        MissingExtra: pictures need pygame, a GIF Pillow.
    """
    policy = policy_of(run)
    env = environments.make(run.config, render_mode="rgb_array", **options)
    try:
        with Reel(path, _step_s(env) / speed) as reel:
            taken = False

            def after(shown: Any) -> bool:
                nonlocal taken
                taken = reel.wants()
                if taken:
                    reel.add(shown.render())
                return True

            def at_end(*episode: Any) -> None:
                if not taken:  # how it ended must be seen
                    last: Any = env.render()
                    reel.add(last)
                ended(*episode)

            play(env, policy, episodes, seed, after, at_end)
        return reel.pictures
    except DependencyNotInstalled as error:
        raise MissingExtra(str(error)) from None
    finally:
        env.close()


def window(run: RunFolder, episodes: int, seed: int, speed: float, ended: Ended, **options: Any) -> None:
    """Show episodes in a window until it is closed; arguments as in ``film``.

    Raises:
        AgentError: no model, or no screen.
    """
    policy = policy_of(run)
    env = environments.make(run.config, render_mode="human", **options)
    pace = Pace(_step_s(env) / speed)

    def after(shown: Any) -> bool:
        _check_screen()
        return pace() and not _window_closed()

    try:
        play(env, policy, episodes, seed, after, ended)
    except DependencyNotInstalled as error:
        raise AgentError(str(error)) from None
    finally:
        env.close()


class Pace:
    """Limits the rate of calls: each call waits until ``seconds`` after the last one.

    Args:
        seconds: least time between two calls [s], wall time.
        clock, sleep: of the wall, unless a test has others.
    """

    def __init__(
        self,
        seconds: float,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        self._seconds, self._clock, self._sleep = seconds, clock, sleep
        self._next: float | None = None

    def __call__(self) -> bool:
        """Wait; returns True."""
        now = self._clock()
        if self._next is not None and self._next > now:
            self._sleep(self._next - now)
            now = self._next
        self._next = now + self._seconds
        return True


def _step_s(env: gym.Env[Any, Any]) -> float:
    """Simulated time of a step [s]."""
    seconds = environments.step_time(env)
    return STEP_S if math.isnan(seconds) else seconds


def _check_screen() -> None:
    """Refuse a display that nobody can see, unless the user asked for it. Raises AgentError."""
    import pygame

    if "SDL_VIDEODRIVER" not in os.environ and pygame.display.get_init():
        if pygame.display.get_driver() in ("dummy", "offscreen"):
            raise AgentError("there is no screen for a window; --out FILE.gif makes a film")


def _window_closed() -> bool:
    import pygame

    return bool(pygame.event.peek(pygame.QUIT))
