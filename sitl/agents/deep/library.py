# SPDX-License-Identifier: BSD-3-Clause
"""The libraries of deep agents, loaded when they are first needed."""

from __future__ import annotations

import importlib.util
import os
from typing import Any

from sitl.errors import MissingExtra

CLASSES = {"dqn": "DQN", "ppo": "PPO", "sac": "SAC"}
"""Algorithm -> its class in stable-baselines3."""
LIBRARIES = ("torch", "stable-baselines3")
"""Libraries whose versions results depend on."""


def require() -> None:
    """Check that the libraries are installed, without importing them, which takes seconds.

    Raises:
        MissingExtra: one is not installed.
    """
    if any(importlib.util.find_spec(name) is None for name in ("torch", "stable_baselines3")):
        raise MissingExtra(
            "dqn, ppo and sac need stable-baselines3 and torch: pip install 'gym-sitl[rl]'; for a torch without GPU "
            "libraries, before that: pip install torch --index-url https://download.pytorch.org/whl/cpu"
        )


def stable_baselines3() -> Any:
    """The module.

    Raises:
        MissingExtra: it is not installed.
    """
    require()
    import stable_baselines3

    return stable_baselines3


def torch(threads: int | None = None) -> Any:
    """The module torch; ``threads``: number of threads to set for this process.

    Raises:
        MissingExtra: it is not installed.
    """
    stable_baselines3()
    import torch

    if threads is not None:
        torch.set_num_threads(min(threads, os.cpu_count() or 1))
    return torch


def algorithm_class(algorithm: str) -> Any:
    """The class of "dqn", "ppo" or "sac"."""
    return getattr(stable_baselines3(), CLASSES[algorithm])
