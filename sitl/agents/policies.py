# SPDX-License-Identifier: BSD-3-Clause
"""Policies of many robots at once: a row a robot, of observations and of actions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt


class Policies(Protocol):
    """The policies of some robots, by number."""

    def begin(self, robots: npt.NDArray[np.int64], seeds: Sequence[int]) -> None:
        """Start an episode of each of these robots; the same seed gives the same choices."""

    def act(self, observations: Any) -> Any:
        """The actions of all robots for their observations."""


class OneEach:
    """A policy for each robot, asked one after the other.

    Args:
        policies: one a robot, as ``algorithms.Policy``.
    """

    def __init__(self, policies: Sequence[Any]) -> None:
        self._policies = policies

    def begin(self, robots: npt.NDArray[np.int64], seeds: Sequence[int]) -> None:
        """See ``Policies``."""
        for robot, seed in zip(robots.tolist(), seeds, strict=True):
            self._policies[robot].begin(seed)

    def act(self, observations: Any) -> Any:
        """See ``Policies``."""
        if isinstance(observations, dict):
            rows: Any = [dict(zip(observations, row)) for row in zip(*observations.values(), strict=True)]
        else:
            rows = observations
        return np.array([policy.act(row) for policy, row in zip(self._policies, rows, strict=True)])
