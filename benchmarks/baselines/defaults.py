# SPDX-License-Identifier: BSD-3-Clause
"""Default settings: what stable-baselines3's PPO, SAC and DQN learn of an id by itself, within ten minutes.

A user's first try: ``PPO("MlpPolicy", gym.make(id)).learn(...)``, with nothing set. Now and then the network plays
greedily, in episodes of other seeds. A curve ends when it succeeds in nine of ten of them twice in a row, or after ten
minutes of processor time for learning, with one thread of torch.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import gymnasium as gym
import numpy as np

from sitl.agents import baselines
from sitl.agents.deep.library import algorithm_class, stable_baselines3, torch
from sitl.agents.runs.backends import Workers
from sitl.agents.runs.config import RunConfig, versions
from sitl.agents.runs.local import SendProgress, Stopped
from sitl.errors import SitlError

from .campaign import Campaign
from .entries import Entry
from .records import Record, digest
from .work import play

LIMIT_S = 600.0
"""Processor time for learning [s]."""
EVERY = {"ppo": 20_480, "sac": 5_000, "dqn": 10_000}
"""Steps between two evaluations."""
STEPS = {"ppo": 1_000_000, "sac": 200_000, "dqn": 200_000}
"""What ``learn`` is asked for: DQN explores in the first tenth of it."""
EPISODES, ENOUGH = 20, 0.9
"""Episodes of an evaluation, and the share of them that is to succeed."""


def algorithms_of(name: str) -> tuple[str, str]:
    """Those that learn the actions of a baseline's id."""
    return ("ppo", "dqn") if name.endswith(baselines.DISCRETE) else ("ppo", "sac")


@dataclass(frozen=True)
class Curve:
    """A curve to be made; picklable."""

    name: str
    """Of the baseline."""
    env: str
    algorithm: str
    env_digest: str
    max_steps: int
    until: float = float("inf")
    """Wall time at which it is given up, to be made anew later [s, as ``time.time``]."""
    limit_s: float = LIMIT_S
    every: int = 0
    """Steps between two evaluations; 0: as usual."""

    @property
    def key(self) -> str:
        """Of its result."""
        every = self.every or EVERY[self.algorithm]
        return digest(
            "default",
            self.env,
            self.algorithm,
            self.env_digest,
            self.limit_s,
            every,
            EPISODES,
            ENOUGH,
            STEPS[self.algorithm],
        )


def curve_of(found: Campaign, entry: Entry, algorithm: str) -> Curve:
    """The curve of a baseline's id and an algorithm."""
    steps = gym.spec(entry.env).max_episode_steps or 1000
    return Curve(entry.name, entry.env, algorithm, found.references.digest(entry.plain), steps)


def wanted(found: Campaign) -> list[Curve]:
    """All curves: PPO of all ids first."""
    plain = [entry for entry in found.chosen if not entry.is_variant]
    return [curve_of(found, entry, algorithms_of(entry.name)[k]) for k in (0, 1) for entry in plain]


def missing(found: Campaign) -> list[Curve]:
    """Those that are not there."""
    return [curve for curve in wanted(found) if curve.key not in found.records]


def do(curve: Curve, send_progress: SendProgress, stopped: Stopped) -> bool | None:
    """Make it; see ``work.do``."""

    def stop() -> bool:
        return stopped() or time.time() > curve.until

    if stop():
        return None
    try:
        record = learn(curve, stop)
    except SitlError as error:
        send_progress(("failed", f"{type(error).__name__}: {error}"))
        return False
    if record is not None:
        send_progress(record)
    return None if record is None else True


def learn(curve: Curve, stopped: Stopped) -> Record | None:
    """Learn and evaluate in turn; None when it was stopped."""
    stable_baselines3()
    torch(1)
    from stable_baselines3.common.callbacks import BaseCallback

    every = curve.every or EVERY[curve.algorithm]
    config = RunConfig(curve.env, curve.algorithm, steps=1, max_steps=curve.max_steps)
    points: list[tuple[int, float, float, float]] = []

    class Evaluations(BaseCallback):
        """Plays after every so many steps; the time of that does not count."""

        spent, began, good = 0.0, time.process_time(), 0

        def _on_step(self) -> bool:
            if self.num_timesteps % every == 0:
                self.spent += time.process_time() - self.began
                played = play(config, lambda seen: self.model.predict(seen, deterministic=True)[0], EPISODES, EPISODES)
                success = float(np.mean([one.reached for one in played]))
                reward = round(float(np.mean([one.reward for one in played])), 2)
                points.append((self.num_timesteps, round(self.spent, 1), success, reward))
                self.good = self.good + 1 if success >= ENOUGH else 0
                self.began = time.process_time()
            return not (stopped() or self.good >= 2 or self.spent >= curve.limit_s)

    env, watch = gym.make(curve.env), Evaluations()
    kind = "MultiInputPolicy" if isinstance(env.observation_space, gym.spaces.Dict) else "MlpPolicy"
    try:
        model = algorithm_class(curve.algorithm)(kind, env, seed=0, device="cpu")
        model.learn(STEPS[curve.algorithm], watch, log_interval=None)
    finally:
        env.close()
    if stopped():
        return None
    return {
        "kind": "default", "key": curve.key, "name": curve.name, "what": curve.algorithm, "env": curve.env, "seed": 0,
        "curve": points, "learnt": watch.good >= 2, "versions": versions("stable-baselines3", "torch"),
    }  # fmt: skip


def run(found: Campaign, workers: Workers, until: float, say: Callable[[str], None]) -> bool:
    """Make all curves that are missing, until a wall time [s]; returns whether all is done."""
    curves = [replace(curve, until=until) for curve in missing(found)]
    say(f"== default settings: {len(curves)} curves of at most {LIMIT_S / 60:g} min of processor time")

    def take(index: int, message: Any) -> None:
        curve = curves[index]
        title = f"{curve.env}, {curve.algorithm.upper()}"
        if isinstance(message, dict):
            found.records.add(message)
            say(f"{title}: {outcome(message)}")
        else:
            say(f"{title} failed: {message[1]}")

    return all(workers.each(do, curves, workers.jobs, take))


def outcome(record: Record) -> str:
    """Of a curve: "90 % after 40,960 steps, 1.2 min"."""
    steps, seconds, success, _ = record["curve"][-1]
    return f"{100 * success:.0f} % after {steps:,} steps, {seconds / 60:.1f} min"


def table_rows(found: Campaign) -> list[tuple[str, ...]]:
    """Rows of the table: id, what PPO learnt, what SAC or DQN did; learnt ones in bold."""
    rows = []
    for entry in found.chosen:
        if entry.is_variant:
            continue
        records = [found.records.get(curve_of(found, entry, name).key) for name in algorithms_of(entry.name)]
        cells = ["" if one is None else f"**{outcome(one)}**" if one["learnt"] else outcome(one) for one in records]
        if any(cells):
            rows.append((f"`{entry.env}`", *cells))
    return rows
