# SPDX-License-Identifier: BSD-3-Clause
"""A run's model as one file: what stable-baselines3 saves, and beside it what else is needed to go on bit for bit."""

from __future__ import annotations

import io
import json
import pickle
import random
import zipfile
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np

from ..errors import AgentError
from ..runs.files import write_bytes
from .library import algorithm_class, torch

MODEL = "model.zip"
_SPACES, _STATE, _MEMORY, _SCORE = "spaces.pkl", "state.pkl", "memory.npz", "score.json"
Score = tuple[float, ...]
"""How good a model is, the most important figure first; greater is better."""
_REMEMBERED = ("observations", "next_observations", "actions", "rewards", "dones", "timeouts")


def save(path: Path, model: Any, robots: Any, spaces: tuple[gym.Space[Any], gym.Space[Any]]) -> None:
    """Write the file, whole or not at all.

    Args:
        path: of the file.
        model: of stable-baselines3.
        robots: that it learns with (``Robots``).
        spaces: of the environment's observations and actions.

    Raises:
        AgentError: it cannot be written.
    """
    content = io.BytesIO()
    model.save(content)
    state = {"robots": robots.memory(), "random": _generators(model)}
    with zipfile.ZipFile(content, "a") as archive:
        archive.writestr(_SPACES, pickle.dumps(spaces))
        archive.writestr(_STATE, pickle.dumps(state))
        memory = getattr(model, "replay_buffer", None)
        if memory is not None:
            archive.writestr(_MEMORY, _remembered(memory))
    write_bytes(path, content.getvalue())


def save_best(path: Path, model: Any, spaces: tuple[gym.Space[Any], gym.Space[Any]], score: Score) -> None:
    """Write a model that can be played, not gone on with.

    Args:
        path: of the file.
        model: of stable-baselines3.
        spaces: of the environment's observations and actions.
        score: that it was kept for.

    Raises:
        AgentError: it cannot be written.
    """
    content = io.BytesIO()
    model.save(content)
    with zipfile.ZipFile(content, "a") as archive:
        archive.writestr(_SPACES, pickle.dumps(spaces))
        archive.writestr(_SCORE, json.dumps({"score": score, "steps": model.num_timesteps}))
    write_bytes(path, content.getvalue())


def score_of(path: Path) -> Score:
    """The score of a model that ``save_best`` wrote.

    Raises:
        AgentError: it is no such file.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(_read(path))) as archive:
            return tuple(float(figure) for figure in json.loads(archive.read(_SCORE))["score"])
    except (ValueError, KeyError, TypeError) as error:
        raise AgentError(f"{path} is no best model: {error}") from None


def resume(path: Path, algorithm: str, robots: Any) -> Any:
    """The model of a file, and ``robots`` where they were.

    Raises:
        AgentError: it is no such file, or of another environment.
    """
    content = _read(path)
    try:
        model = algorithm_class(algorithm).load(io.BytesIO(content), env=robots, device="cpu", force_reset=False)
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            state = pickle.loads(archive.read(_STATE))
            robots.recall(state["robots"])
            if _MEMORY in archive.namelist():
                _remember(model.replay_buffer, archive.read(_MEMORY))
        _recall_generators(model, state["random"])
    except (ValueError, KeyError) as error:
        raise AgentError(f"{path} cannot be gone on with: {error}") from None
    return model


def load(path: Path, algorithm: str) -> tuple[Any, tuple[gym.Space[Any], gym.Space[Any]]]:
    """The model alone, to play; and the spaces of the environment's observations and actions.

    Raises:
        AgentError: it is no such file.
    """
    content = _read(path)
    small = {} if algorithm == "ppo" else {"buffer_size": 1}
    try:
        model = algorithm_class(algorithm).load(io.BytesIO(content), device="cpu", **small)
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            return model, pickle.loads(archive.read(_SPACES))
    except (ValueError, KeyError) as error:
        raise AgentError(f"{path} is no model of {algorithm}: {error}") from None


def _read(path: Path) -> bytes:
    try:
        content = path.read_bytes()
    except FileNotFoundError:
        raise AgentError(f"there is no model {path}") from None
    except OSError as error:
        raise AgentError(f"{path} cannot be read: {error.strerror}") from None
    if not zipfile.is_zipfile(io.BytesIO(content)):
        raise AgentError(f"{path} is no model")
    return content


def _generators(model: Any) -> dict[str, Any]:
    """Every random generator that a model draws from: stable-baselines3 uses those of the process."""
    return {
        "python": random.getstate(),
        "numpy": np.random.get_state(),
        "torch": torch().get_rng_state().numpy(),
        "actions": model.action_space.np_random.bit_generator.state,
    }


def _recall_generators(model: Any, states: dict[str, Any]) -> None:
    random.setstate(states["python"])
    np.random.set_state(states["numpy"])
    torch().set_rng_state(torch().from_numpy(states["torch"].copy()))
    model.action_space.np_random.bit_generator.state = states["actions"]


def _remembered(memory: Any) -> bytes:
    """The filled part of a replay buffer."""
    filled = memory.buffer_size if memory.full else memory.pos
    content = io.BytesIO()
    np.savez(
        content, place=np.array([memory.pos, memory.full]),
        **{name: getattr(memory, name)[:filled] for name in _REMEMBERED},
    )  # fmt: skip
    return content.getvalue()


def _remember(memory: Any, content: bytes) -> None:
    with np.load(io.BytesIO(content), allow_pickle=False) as stored:
        memory.pos, memory.full = int(stored["place"][0]), bool(stored["place"][1])
        for name in _REMEMBERED:
            rows = stored[name]
            getattr(memory, name)[: len(rows)] = rows
