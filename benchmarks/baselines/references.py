# SPDX-License-Identifier: BSD-3-Clause
"""Reference plays: a few figures of random episodes, by which a changed environment is noticed.

They are compared with a tolerance, because new machine code may change the last bits of a flight, which changes no
result that is worth a training. What differs by more gives the environment a new digest, and makes all results of the
old one out of date.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np

from sitl.agents import environments
from sitl.agents.runs.config import RunConfig
from sitl.agents.runs.files import make_folder, write_bytes

from .records import digest

FILE = "environments.json"
EPISODES, STEPS, EVERY = 2, 60, 20
TOLERANCE = 1e-3
"""Of a figure, or of its part where it is larger than 1."""
PLAIN = bool | int | float | str
Reference = dict[str, Any]
"""{"env": id, "spaces": text, "task": values, "play": figures}."""


def play(config: RunConfig) -> Reference:
    """Play it.

    Args:
        config: of a run in the environment.
    """
    env = environments.make(config)
    figures: list[float] = []
    try:
        env.action_space.seed(0)
        for episode in range(EPISODES):
            observation, _ = env.reset(seed=environments.seed_of(7, episode))
            total, ended, step = 0.0, False, 0
            figures.append(_weighed(env.observation_space, observation))
            while not ended and step < STEPS:
                observation, reward, terminated, truncated, _ = env.step(env.action_space.sample())
                total, step, ended = total + float(reward), step + 1, terminated or truncated
                if ended or step % EVERY == 0:
                    figures += [total, _weighed(env.observation_space, observation)]
            figures.append(float(step))
        spaces = f"{env.observation_space} {env.action_space}"
        task = _plain(getattr(getattr(env.unwrapped, "session", None), "task", None))
    finally:
        env.close()
    return {"env": config.env, "spaces": digest(spaces), "task": task, "play": [round(one, 4) for one in figures]}


def _weighed(space: gym.Space[Any], observation: Any) -> float:
    """An observation in one figure: each part counts with another weight."""
    flat = np.asarray(gym.spaces.flatten(space, observation), np.float64)
    return float((np.clip(flat, -1e3, 1e3) * np.cos(np.arange(len(flat)))).sum())


def _plain(task: Any) -> dict[str, Any]:
    """Name and figures of a task: rewards that a short random play may not reach."""
    values = {name: value for name, value in sorted(vars(task).items()) if isinstance(value, PLAIN)} if task else {}
    return {"class": type(task).__name__, **values}


def same(one: Reference, other: Reference) -> bool:
    """Whether two plays are of the same environment."""
    if any(one[name] != other[name] for name in ("env", "spaces", "task")) or len(one["play"]) != len(other["play"]):
        return False
    a, b = np.array(one["play"]), np.array(other["play"])
    return bool((np.abs(a - b) <= TOLERANCE * np.maximum(1.0, np.abs(a))).all())


class References:
    """The kept plays of a folder of results.

    Args:
        folder: of results.
    """

    def __init__(self, folder: Path) -> None:
        self._path = folder / FILE
        self._kept: dict[str, Reference] = json.loads(self._path.read_text()) if self._path.exists() else {}

    def digest(self, name: str) -> str:
        """Of the environment of a baseline; "" where it was never played."""
        return digest(self._kept[name]) if name in self._kept else ""

    def check(self, configs: Mapping[str, RunConfig]) -> list[str]:
        """Play environments, by the names of baselines, and keep what is new; returns the names of those that had been
        kept and have changed."""
        changed, before = [], dict(self._kept)
        for name, config in configs.items():
            now = play(config)
            if name in self._kept and same(self._kept[name], now):
                continue
            if name in self._kept:
                changed.append(name)
            self._kept[name] = now
        if self._kept != before:
            make_folder(self._path.parent)
            rows = ",\n".join(f"{json.dumps(name)}: {json.dumps(self._kept[name])}" for name in sorted(self._kept))
            write_bytes(self._path, ("{\n" + rows + "\n}\n").encode())
        return changed
