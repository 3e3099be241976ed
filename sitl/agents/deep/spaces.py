# SPDX-License-Identifier: BSD-3-Clause
"""Spaces of observations and actions, kept beside a network."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import gymnasium as gym
import numpy as np

from ..errors import AgentError

Spaces = tuple[gym.Space[Any], gym.Space[Any]]
"""Of an environment's observations and of its actions."""


def described(space: gym.Space[Any]) -> dict[str, Any]:
    """A space as JSON has it.

    Raises:
        AgentError: a kind that is none of box, discrete, multi-discrete and dict.
    """
    if isinstance(space, gym.spaces.Box):
        limits = {"low": space.low.tolist(), "high": space.high.tolist()}
        return {"kind": "box", **limits, "shape": list(space.shape), "dtype": str(space.dtype)}
    if isinstance(space, gym.spaces.Discrete):
        return {"kind": "discrete", "n": int(space.n), "start": int(space.start)}
    if isinstance(space, gym.spaces.MultiDiscrete):
        return {"kind": "multi", "n": space.nvec.tolist()}
    if isinstance(space, gym.spaces.Dict):
        return {"kind": "dict", "spaces": [[name, described(part)] for name, part in space.items()]}
    raise AgentError(f"a model that sees {space} cannot be kept")


def space_of(data: Mapping[str, Any]) -> gym.Space[Any]:
    """The space that ``described`` described.

    Raises:
        ValueError, KeyError, TypeError: it is no such description.
    """
    kind = data["kind"]
    if kind == "box":
        dtype: Any = np.dtype(data["dtype"])
        low, high = (np.array(data[name], dtype).reshape(data["shape"]) for name in ("low", "high"))
        return gym.spaces.Box(low, high, dtype=dtype)
    if kind == "discrete":
        return gym.spaces.Discrete(data["n"], start=data["start"])
    if kind == "multi":
        return gym.spaces.MultiDiscrete(data["n"])
    if kind == "dict":
        return gym.spaces.Dict([(name, space_of(part)) for name, part in data["spaces"]])
    raise ValueError(f"a space of the kind {kind!r}")
