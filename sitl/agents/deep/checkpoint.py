# SPDX-License-Identifier: BSD-3-Clause
"""A run's model as one file: weights, and beside them what else is needed to go on bit for bit.

It is data only: weights and optimisers as torch keeps tensors, the rest as JSON and arrays. Nothing in it is unpickled
(what stable-baselines3 saves by itself is), so that somebody else's run can be opened.
"""

from __future__ import annotations

import io
import json
import random
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from sitl.core import array_files, documents
from sitl.core.array_files import MIB, each_array, read_npz, unpack

from ..errors import AgentError, ResumeError
from ..runs.files import write_bytes
from . import models, plain
from .library import torch
from .spaces import Spaces, described, space_of

MODEL = "model.zip"
_ABOUT, _STATE, _ARRAYS, _MEMORY = "about.json", "state.json", "state.npz", "memory.npz"
_TENSORS, _SUFFIX = "tensors.pth", ".weights.pth"
Score = tuple[float, ...]
"""How good a model is, the most important value first; greater is better."""
_REMEMBERED = ("actions", "rewards", "dones", "timeouts")
_SEEN = ("observations", "next_observations")
"""Arrays of a replay buffer; of a goal-conditioned one the latter are arrays by name, and it has those of _EPISODES."""
_EPISODES = ("ep_start", "ep_length")
_BEGUN, _CURSOR = "_current_ep_start", "place"
MOST = 1024 * MIB
"""Memory that each of a model's weights, its state and the description may take when it is read [bytes]; that of a
replay buffer, what the buffer has."""
_STATE_KINDS = array_files.KINDS + "SU" + array_files.RECORDS
_COUNTED = (
    "num_timesteps", "_total_timesteps", "_num_timesteps_at_start", "_episode_num", "_n_updates", "_n_calls",
    "_current_progress_remaining", "exploration_rate", "_last_obs", "_last_episode_starts", "_last_original_obs",
)  # fmt: skip
"""What a model knows of its learning besides tensors; not every algorithm has all."""


def save(path: Path, model: Any, robots: Any, spaces: Spaces) -> None:
    """Write the file, whole or not at all.

    Args:
        path: of the file.
        model: of stable-baselines3.
        robots: that it learns with (``Robots``).
        spaces: of the environment's observations and actions.

    Raises:
        AgentError: it cannot be written.
    """
    content, arrays = io.BytesIO(), plain.Arrays()
    counted = {name: getattr(model, name) for name in _COUNTED if hasattr(model, name)}
    state = plain.encode({"model": counted, "robots": robots.memory(), "random": _generators(model)}, arrays)
    with zipfile.ZipFile(content, "w") as archive:
        _write_weights(archive, model, spaces, {})
        archive.writestr(_STATE, json.dumps(state))
        archive.writestr(_ARRAYS, _arrays(arrays))
        memory = getattr(model, "replay_buffer", None)
        if memory is not None:
            archive.writestr(_MEMORY, _remembered(memory))
    write_bytes(path, content.getvalue())


def save_best(path: Path, model: Any, spaces: Spaces, score: Score) -> None:
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
    with zipfile.ZipFile(content, "w") as archive:
        _write_weights(archive, model, spaces, {"score": score, "steps": model.num_timesteps})
    write_bytes(path, content.getvalue())


def score_of(path: Path) -> Score:
    """The score of a model that ``save_best`` wrote.

    Raises:
        AgentError: it is no such file.
    """
    try:
        with _opened(path) as archive:
            return tuple(float(value) for value in documents.of_json(unpack(archive, _ABOUT, MOST))["score"])
    except (ValueError, KeyError, TypeError, zipfile.BadZipFile) as error:
        raise AgentError(f"{path} is no best model: {error}") from None


def resume(path: Path, model: Any, robots: Any) -> None:
    """Put a new model, and ``robots``, where those of a file were.

    Args:
        path: of the file.
        model: made with the settings of the run (``models.make``).
        robots: that it was made with.

    Raises:
        AgentError: there is no such file.
        ResumeError: it is of another environment, other settings, or a version with another state of vehicles.
    """
    try:
        with _opened(path) as archive:
            _read_weights(archive, model)
            arrays = read_npz(unpack(archive, _ARRAYS, MOST), MOST, _STATE_KINDS)
            state = plain.decode(documents.of_json(unpack(archive, _STATE, MOST)), arrays)
            for name in _COUNTED:
                if name in state["model"]:
                    setattr(model, name, state["model"][name])
            robots.recall(state["robots"])
            if _MEMORY in archive.namelist():
                _remember(model.replay_buffer, archive)
        _recall_generators(model, state["random"])
    except (*_BROKEN, AttributeError) as error:
        raise ResumeError(
            f"{path} cannot be gone on with, it is of another environment, other settings or another version: {error}"
        ) from None


def load(path: Path, algorithm: str) -> tuple[Any, Spaces]:
    """The model alone, to play; and the spaces of the environment's observations and actions.

    Raises:
        AgentError: it is no such file.
    """
    try:
        with _opened(path) as archive:
            about = documents.of_json(unpack(archive, _ABOUT, MOST))
            seen, actions = space_of(about["features"]), space_of(about["moves"])
            model = models.empty(algorithm, about["net_arch"], seen, actions)
            _read_weights(archive, model)
            return model, (space_of(about["observations"]), space_of(about["actions"]))
    except _BROKEN as error:
        raise AgentError(f"{path} is no model of {algorithm}: {error}") from None


_BROKEN = (ValueError, KeyError, TypeError, RuntimeError, EOFError, zipfile.BadZipFile, AssertionError)
"""What json, zip, numpy and torch raise when a file is damaged or of something else."""


def _opened(path: Path) -> zipfile.ZipFile:
    try:
        content = path.read_bytes()
    except FileNotFoundError:
        raise AgentError(f"there is no model {path}") from None
    except OSError as error:
        raise AgentError(f"{path} cannot be read: {error.strerror}") from None
    if not zipfile.is_zipfile(io.BytesIO(content)):
        raise AgentError(f"{path} is no model")
    archive = zipfile.ZipFile(io.BytesIO(content))
    if _ABOUT not in archive.namelist():
        archive.close()
        raise AgentError(
            f"{path} is no model of this version: it has no {_ABOUT}. Models of earlier versions, and those that "
            "stable-baselines3 saves by itself, hold pickles, which can run code when they are opened; train it anew"
        )
    return archive


# ---------------------------------------------------------------------- weights


def _write_weights(archive: zipfile.ZipFile, model: Any, spaces: Spaces, more: Mapping[str, Any]) -> None:
    about = {
        "net_arch": model.policy_kwargs["net_arch"], "features": described(model.observation_space),
        "moves": described(model.action_space), "observations": described(spaces[0]),
        "actions": described(spaces[1]), **more,
    }  # fmt: skip
    archive.writestr(_ABOUT, json.dumps(about))
    for name, values in model.get_parameters().items():
        archive.writestr(name + _SUFFIX, _tensors(values))
    archive.writestr(_TENSORS, _tensors({name: getattr(model, name) for name in model._get_torch_save_params()[1]}))


def _read_weights(archive: zipfile.ZipFile, model: Any) -> None:
    """Raises ValueError or RuntimeError when they are of another network."""
    stored = [name for name in archive.namelist() if name.endswith(_SUFFIX)]
    model.set_parameters({name.removesuffix(_SUFFIX): _loaded(archive, name) for name in stored}, exact_match=True)
    for name, value in _loaded(archive, _TENSORS).items():
        if name not in model._get_torch_save_params()[1]:
            raise ValueError(f"{name} is no tensor of this algorithm")
        getattr(model, name).data = value.data


def _tensors(values: Any) -> bytes:
    content = io.BytesIO()
    torch().save(values, content)
    return content.getvalue()


def _checked(content: bytes) -> bytes:
    """Tensors as torch writes them: nothing in the file is packed. Raises ValueError when it unpacks to much more."""
    with zipfile.ZipFile(io.BytesIO(content)) as tensors:
        size = sum(member.file_size for member in tensors.infolist())
    if size > len(content):
        raise ValueError(f"a file of {len(content):,} bytes unpacks to {size:,}")
    return content


def _loaded(archive: zipfile.ZipFile, name: str) -> Any:
    """Tensors alone: ``weights_only`` refuses everything that would run code."""
    from pickle import UnpicklingError  # torch's word for what it refuses

    try:
        return torch().load(io.BytesIO(_checked(unpack(archive, name, MOST))), map_location="cpu", weights_only=True)
    except UnpicklingError as error:
        raise ValueError(f"{name} holds more than weights: {str(error).splitlines()[0]}") from None


# ---------------------------------------------------------------------- all the rest


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


def _arrays(arrays: plain.Arrays) -> bytes:
    content = io.BytesIO()
    np.savez(content, **arrays)  # type: ignore[arg-type]
    return content.getvalue()


def _remembered(memory: Any) -> bytes:
    """The filled part of a replay buffer."""
    filled = memory.buffer_size if memory.full else memory.pos
    rows = {name: array[:filled] for name, array in _columns(memory).items()}
    if hasattr(memory, _BEGUN):
        rows[_BEGUN] = getattr(memory, _BEGUN)
    return _arrays({_CURSOR: np.array([memory.pos, memory.full]), **rows})


def _columns(memory: Any) -> plain.Arrays:
    """The arrays of a replay buffer, by name, a row a step."""
    out: plain.Arrays = {name: getattr(memory, name) for name in (*_REMEMBERED, *_EPISODES) if hasattr(memory, name)}
    for name in _SEEN:
        seen = getattr(memory, name)
        out |= {f"{name}.{part}": array for part, array in seen.items()} if isinstance(seen, dict) else {name: seen}
    return out


def _remember(memory: Any, archive: zipfile.ZipFile) -> None:
    """Raises ValueError when it is more than the buffer holds, or something else."""
    columns = _columns(memory)
    most = sum(array.nbytes for array in columns.values()) + MIB
    seen = set()
    for name, rows in each_array(unpack(archive, _MEMORY, most + MIB), most):
        seen.add(name)
        if name == _CURSOR:
            memory.pos, memory.full = int(rows[0]), bool(rows[1])
        elif name == _BEGUN and hasattr(memory, _BEGUN):
            getattr(memory, _BEGUN)[:] = rows
        else:
            columns[name][: len(rows)] = rows
    missing = {_CURSOR, *columns} - seen
    if missing:
        raise ValueError(f"its memory has no {', '.join(sorted(missing))}")
