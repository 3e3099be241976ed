# SPDX-License-Identifier: BSD-3-Clause
"""Observations as rows of numbers of the order of 1, which networks learn from."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from sitl.core import elementary_arrays as arrays
from sitl.core.elementary import log1p

from ..errors import AgentError
from .narrow import log1p_of_all, tanh_of_all

Rows = npt.NDArray[np.float32]
GOALS = ("achieved_goal", "desired_goal")
"""Parts of goal-conditioned observations, as Gymnasium-Robotics names them."""
_NEAR = 10.0
"""Distances and coordinates that give a feature of 1 [m]."""


class Features:
    """Makes features of the observations of one robot or many.

    - a scan: of each sector the nearest reading r as log(1 + r) / log(1 + range), so that a decimetre counts more near
      a wall than far from it; a lidar with other readings over the same field gives the same sectors;
    - digits: as a share of the greatest;
    - numbers of either sign: sign(x) log(1 + |x|), which tells centimetres near 0 and does not grow far from it
      (Hafner et al., "Mastering Diverse Domains through World Models", arXiv:2301.04104);
    - the way to a goal: distance, cosine and sine of the bearing; a pose: x, y, z, cosine and sine of the yaw;
    - "achieved_goal" and "desired_goal" of goal-conditioned environments: in tens of metres.

    Args:
        space: space of one robot's observations.
        sectors: number of sectors of a scan; 0: each reading is a feature.

    Raises:
        AgentError: a kind of observation that is none of these.
    """

    def __init__(self, space: gym.Space[Any], sectors: int) -> None:
        self.space, self._sectors = space, sectors
        self._parts: list[tuple[str | None, Callable[[Any], Rows]]] = []
        if isinstance(space, gym.spaces.Dict):
            for name, part in space.spaces.items():
                self._parts.append((name, self._part(name, part)))
        else:
            self._parts.append((None, self._part("scan", space)))
        sample: Any = space.sample()
        one = {k: v[None] for k, v in sample.items()} if isinstance(sample, dict) else sample[None]
        self.width = int(self(one).shape[1])
        """Number of features of a robot."""
        self.has_goals = set(GOALS) <= {name for name, _ in self._parts}
        """Whether the environment is goal-conditioned: its observations tell goals, and what of them is achieved."""
        ends = np.cumsum([make(one if name is None else one[name]).shape[1] for name, make in self._parts]).tolist()
        self._slices = {str(name): slice(a, b) for (name, _), a, b in zip(self._parts, [0, *ends], ends)}

    def _part(self, name: str, space: gym.Space[Any]) -> Callable[[Any], Rows]:
        if name == "goal" and space.shape == (2,):
            return _goal
        if name == "pose":
            return _pose
        if name in GOALS:
            return lambda goals: np.asarray(goals, np.float32) / np.float32(_NEAR)
        if isinstance(space, gym.spaces.MultiDiscrete):
            highest = np.maximum(space.nvec - 1, 1).astype(np.float32)
            return lambda digits: np.asarray(digits, np.float32) / highest
        if isinstance(space, gym.spaces.Box) and len(space.shape) == 1 and bool(np.any(space.low < 0.0)):
            return _either_sign
        if isinstance(space, gym.spaces.Box) and len(space.shape) == 1 and bool(np.all(np.isfinite(space.high))):
            scale = np.float32(1.0 / log1p(float(space.high.max())))
            sectors = self._sectors
            return lambda scan: _log1p(nearest(np.asarray(scan, np.float32), sectors)) * scale
        raise AgentError(
            f"observation {name!r} = {space} cannot be learnt from; rows of numbers, scans, digits, goals and poses can"
        )

    def __call__(self, observations: Any) -> Rows:
        """Features, shape (count, width), of observations with a row a robot."""
        rows = [make(observations if name is None else observations[name]) for name, make in self._parts]
        return rows[0] if len(rows) == 1 else np.concatenate(rows, axis=1)

    def by_name(self, rows: Rows) -> dict[str, Rows]:
        """Features of each part of a dict of observations, each of shape (count, its width)."""
        return {name: rows[:, at] for name, at in self._slices.items()}


def nearest(scans: Rows, sectors: int) -> Rows:
    """Nearest reading [m] of each of ``sectors`` sectors of equal width; scans have shape (count, readings)."""
    readings = scans.shape[1]
    if sectors == 0 or sectors >= readings:
        return scans
    edges = (np.arange(sectors) * readings) // sectors
    out: Rows = np.minimum.reduceat(scans, edges, axis=1)
    return out


def _either_sign(numbers: Any) -> Rows:
    rows = np.asarray(numbers, np.float32)
    out: Rows = np.sign(rows) * _log1p(np.abs(rows))
    return out


def _log1p(rows: Rows) -> Rows:
    """log(1 + x) of numbers from 0 on."""
    rows = np.ascontiguousarray(rows)
    out = np.empty_like(rows)
    log1p_of_all.unchecked()(rows.reshape(-1), out.reshape(-1))
    return out


def goals_of(features: Any) -> npt.NDArray[np.float64]:
    """Goals [m] whose features these are, of the same shape."""
    return np.asarray(features, np.float64) * _NEAR


def _goal(goals: Any) -> Rows:
    rows = np.asarray(goals, np.float32)
    near = np.empty(len(rows), np.float32)
    tanh_of_all.unchecked()(rows[:, 0] / np.float32(_NEAR), near)
    return np.stack([near, arrays.cos(rows[:, 1]), arrays.sin(rows[:, 1])], axis=1)


def _pose(poses: Any) -> Rows:
    rows = np.asarray(poses, np.float32)
    turned = np.stack([arrays.cos(rows[:, 3]), arrays.sin(rows[:, 3])], axis=1)
    return np.concatenate([rows[:, :3] / np.float32(_NEAR), turned], axis=1)


class Frames:
    """The last ``frames`` features of each robot in a row, the newest first.

    Args:
        count: number of robots.
        frames: number of observations in a row.
        width: number of features of a robot.
    """

    def __init__(self, count: int, frames: int, width: int) -> None:
        self._width = width
        self.rows: Rows = np.zeros((count, frames * width), np.float32)
        """Shape (count, frames * width)."""

    def begin(self, features: Rows, robots: Any = slice(None)) -> Rows:
        """Start episodes of these robots: all frames hold the first observation. Returns all rows, a row a robot."""
        times = self.rows.shape[1] // self._width
        self.rows[robots] = np.tile(features[robots], (1, times))
        return self.rows

    def push(self, features: Rows) -> Rows:
        """A step was made; returns all rows."""
        self.rows[:, self._width :] = self.rows[:, : -self._width].copy()
        self.rows[:, : self._width] = features
        return self.rows
