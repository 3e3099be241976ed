# SPDX-License-Identifier: BSD-3-Clause
"""Rewards and steps of the episodes of robots that learn together."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import numpy.typing as npt

from ..runs.episodes import Episode


class Tally:
    """Counts rewards and steps of the episodes of several robots.

    Args:
        count: number of robots.
        step_time: simulated time of a step [s].
    """

    def __init__(self, count: int, step_time: float) -> None:
        self.done = 0
        """Episodes."""
        self.done_steps = 0
        """Steps of the finished episodes."""
        self.solved_checks = 0
        """Checks in a row, up to the last one, in which every episode solved the task."""
        self.epsilon = float("nan")
        """Probability of exploring now."""
        self._steps = np.zeros(count, np.int64)
        self._rewards = np.zeros(count)
        self._step_time = step_time
        self._since = time.perf_counter()
        self._new: list[Episode] = []

    def count(
        self, rewards: npt.NDArray[np.float64], terminated: npt.NDArray[np.bool_], ended: npt.NDArray[np.bool_]
    ) -> list[tuple[float, int]]:
        """A step was made, ``ended`` says whose episodes end by it; returns reward and steps of those."""
        self._steps += 1
        self._rewards += rewards
        out = []
        for index in np.flatnonzero(ended).tolist():
            now = time.perf_counter()
            steps, reward = int(self._steps[index]), float(self._rewards[index])
            simulated = round(steps * self._step_time, 6)
            self._new.append(
                Episode(self.done, steps, reward, self.epsilon, int(terminated[index]), simulated, now - self._since)
            )
            out.append((reward, steps))
            self.done, self.done_steps, self._since = self.done + 1, self.done_steps + steps, now
            self._steps[index], self._rewards[index] = 0, 0.0
        return out

    def take(self) -> list[Episode]:
        """Rows since the last call. The wall time of an episode is that since the one before it ended."""
        rows, self._new = self._new, []
        return rows

    def memory(self) -> dict[str, Any]:
        """State for ``recall``."""
        return {
            "done": self.done, "done_steps": self.done_steps, "steps": self._steps, "rewards": self._rewards,
            "solved_checks": self.solved_checks,
        }  # fmt: skip

    def recall(self, memory: dict[str, Any]) -> None:
        """Restore the state that ``memory`` returned."""
        self.done, self.done_steps = memory["done"], memory["done_steps"]
        self.solved_checks = memory.get("solved_checks", 0)  # models of earlier versions do not have it
        self._steps, self._rewards = memory["steps"].copy(), memory["rewards"].copy()
