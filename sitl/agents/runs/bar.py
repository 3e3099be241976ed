# SPDX-License-Identifier: BSD-3-Clause
"""The progress bar of training."""

from __future__ import annotations

import math
import sys
import time
from collections import deque
from collections.abc import Sequence
from types import TracebackType

from tqdm import tqdm

from .episodes import Episode
from .folder import RunFolder

_RECENT = 100
"""Number of episodes in the mean reward that is shown."""


class Bar:
    """Progress bar over the episodes (or steps) of all runs, with reward, epsilon, steps per second and real-time
    factor.

    Args:
        runs: runs that are trained, with what they have done already.
    """

    def __init__(self, runs: Sequence[RunFolder]) -> None:
        self._by_steps = any(run.config.episodes is None for run in runs)
        total = sum((run.config.steps if self._by_steps else run.config.episodes) or 0 for run in runs)
        done = [run.episodes.rows() for run in runs]
        first = sum(sum(row.steps for row in rows) if self._by_steps else len(rows) for rows in done)
        unit = "step" if self._by_steps else "episode"
        self._bar = tqdm(total=total, initial=first, unit=unit, file=sys.stderr, disable=None, smoothing=0.1)
        self._recent: deque[float] = deque(maxlen=_RECENT)
        self.steps, self.simulated_s = 0, 0.0
        self._start = time.perf_counter()

    def __call__(self, index: int, rows: Sequence[Episode]) -> None:
        """Count finished episodes of a run."""
        for row in rows:
            self._recent.append(row.reward)
            self.steps += row.steps
            self.simulated_s += row.simulated_s
        self._bar.set_postfix_str(self._values(rows[-1]), refresh=False)
        self._bar.update(sum(row.steps for row in rows) if self._by_steps else len(rows))

    def _values(self, last: Episode) -> str:
        reward = sum(self._recent) / len(self._recent)
        parts = [f"reward {reward:.0f}"]
        if not math.isnan(last.epsilon):
            parts.append(f"epsilon {last.epsilon:.3f}")
        return ", ".join([*parts, self.speed()])

    def speed(self) -> str:
        """Speed of all runs together, as text."""
        wall = max(time.perf_counter() - self._start, 1e-9)
        out = f"{self.steps / wall:,.0f} steps/s"
        return out if math.isnan(self.simulated_s) else f"{out}, {self.simulated_s / wall:,.0f} x real time"

    @property
    def wall_s(self) -> float:
        """Wall time so far [s]."""
        return time.perf_counter() - self._start

    def __enter__(self) -> Bar:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None):
        self._bar.close()
