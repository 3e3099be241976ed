# SPDX-License-Identifier: BSD-3-Clause
"""What a run has learnt, shown: on the page in the browser, in a window, or as a film (a GIF, or an MP4 where the
program ffmpeg is installed)."""

from __future__ import annotations

import itertools
import math
import shutil
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import Any, Protocol

import gymnasium as gym
from gymnasium.error import DependencyNotInstalled

from sitl.errors import MissingExtra
from sitl.view import page_library

from . import environments
from .algorithms import Policy, policy_of
from .errors import AgentError
from .gif import Gif, Picture, pillow
from .runs.folder import RunFolder

FASTEST_S = 0.04
"""Shortest duration of a frame [s]: viewers slow down GIFs with shorter ones."""
LARGEST = 4_000_000
"""Size of a GIF [bytes]: what pages, issues and mails take."""


class Film(Protocol):
    """An animation file; complete when it is closed."""

    size: int
    """Bytes written so far, of a file that grows with each frame; else 0."""

    def add(self, picture: Picture, times: int = 1) -> None:
        """Append a frame, shape (height, width, 3); all frames have the same size. It stands for ``times`` the usual
        duration."""

    def close(self) -> None:
        """Write what is buffered, and close the file."""


class Mp4:
    """An MP4 (H.264), encoded by ffmpeg frame by frame."""

    size = 0

    def __init__(self, path: Path, seconds: float, program: str) -> None:
        self._path, self._rate, self._program = path, 1.0 / seconds, program
        self._process: subprocess.Popen[bytes] | None = None

    def add(self, picture: Picture, times: int = 1) -> None:
        """See ``Film``."""
        if self._process is None:
            height, width = picture.shape[:2]
            raw = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", f"{self._rate:.6g}"]
            even = ["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p"]  # H.264 wants even sides
            words = [self._program, "-loglevel", "error", "-y", *raw, "-i", "-", *even, str(self._path)]
            pipe = subprocess.PIPE
            # In a session of its own: a terminal's Ctrl-C shall end the play, and ffmpeg what it has begun.
            self._process = subprocess.Popen(words, stdin=pipe, stderr=pipe, start_new_session=True)
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(picture.tobytes())
        except BrokenPipeError:
            self.close()

    def close(self) -> None:
        """See ``Film``."""
        if self._process is None:
            return
        _, errors = self._process.communicate()
        code, self._process = self._process.returncode, None
        if code != 0:
            last = errors.decode(errors="replace").strip().splitlines()
            raise AgentError(f"{self._path} cannot be written: ffmpeg: {last[-1] if last else f'exit code {code}'}")


class Reel:
    """An animation of an episode; steps are left out where frames would be shorter than FASTEST_S. A GIF stays at about
    LARGEST: each time half of what is left of it is full, only every second of the steps still becomes a frame, which
    stands for twice as long.

    Args:
        path: .gif or .mp4.
        step_s: how long a step shall last in the film [s].

    Raises:
        AgentError: another kind of file, or no ffmpeg for an MP4.
        MissingExtra: no Pillow for a GIF.
    """

    def __init__(self, path: Path, step_s: float) -> None:
        self.every = max(round(FASTEST_S / step_s), 1) if step_s < FASTEST_S else 1
        """Number of steps per frame."""
        self._first, self._left = self.every, LARGEST
        seconds = self.every * step_s
        self._steps, self._next, self.pictures = 0, 0, 0
        if not path.parent.is_dir():
            raise AgentError(f"{path} cannot be written: there is no folder {path.parent}")
        self._film: Film
        if path.suffix.lower() == ".gif":
            pillow()
            self._film = Gif(path, seconds)
        elif path.suffix.lower() == ".mp4":
            program = shutil.which("ffmpeg")
            if program is None:
                raise AgentError(f"{path}: an MP4 needs the program ffmpeg, which is not installed; a .gif does not")
            self._film = Mp4(path, seconds, program)
        else:
            raise AgentError(f"{path}: a film is a .gif or an .mp4")

    def wants(self) -> bool:
        """Whether this step becomes a frame; call it once per step."""
        wanted = self._steps >= self._next
        if wanted:
            self._next = self._steps + self.every
        self._steps += 1
        return wanted

    def add(self, picture: Picture) -> None:
        """Append a frame, shape (height, width, 3)."""
        if self._film.size > LARGEST - self._left // 2:
            self._left //= 2
            self._next += self.every
            self.every *= 2
        self._film.add(picture, self.every // self._first)
        self.pictures += 1

    def __enter__(self) -> Reel:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None):
        self._film.close()


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


def can_be_on_page(run: RunFolder, **options: Any) -> bool:
    """Whether the environment of a run is one of this package, which know the page, and the page is installed."""
    return page_library.is_installed() and _has_window(run, **options)


def _has_window(run: RunFolder, **options: Any) -> bool:
    env = environments.make(run.config, **options)
    env.close()
    return "window" in env.metadata["render_modes"]


def page(run: RunFolder, episodes: int | None, seed: int, speed: float, ended: Ended, **options: Any) -> None:
    """Show episodes on the page in the browser; arguments as in ``film``, ``episodes`` None: until an interrupt.

    Raises:
        AgentError: no model.
        MissingExtra: the library that draws the page is not installed.
    """
    page_library.require()
    policy = policy_of(run)
    env = environments.make(run.config, render_mode="human", **options)
    pace = Pace(_step_s(env) / speed)
    try:
        for first in itertools.count() if episodes is None else range(1):
            count = 1 if episodes is None else episodes
            play(env, policy, count, seed + first, lambda shown: pace(), ended)
    except KeyboardInterrupt:
        if episodes is not None:
            raise
    finally:
        env.close()


def window(run: RunFolder, episodes: int, seed: int, speed: float, ended: Ended, **options: Any) -> None:
    """Show episodes in a window until it is closed; arguments as in ``film``.

    Raises:
        AgentError: no model, or no screen.
    """
    policy = policy_of(run)
    env = environments.make(run.config, render_mode="window" if _has_window(run, **options) else "human", **options)
    pace = Pace(_step_s(env) / speed)

    def after(shown: Any) -> bool:
        return pace() and not _window_closed()

    try:
        play(env, policy, episodes, seed, after, ended)
    except DependencyNotInstalled as error:
        raise AgentError(f"{error}; --out FILE.gif makes a film") from None
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


def _window_closed() -> bool:
    import pygame

    return bool(pygame.event.peek(pygame.QUIT))
