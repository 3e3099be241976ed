# SPDX-License-Identifier: BSD-3-Clause
"""Parts of observations as a sensor of one's own would give them: noisy, late, seldom."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from .noise import standard_normal
from .options import EnvOptionError
from .parts import Narrow, Part, Surroundings, part_of
from .past import Film, Past
from .senses import reads_scan

Floats = npt.NDArray[np.float64]


class Sensed:
    """A part with errors besides those of the vehicle's own sensors; the same seed draws the same ones.

    Args:
        part: its name (``parts.PARTS``), or a part.
        noise: standard deviation of each reading, in its unit: one number for all columns, or one for each.
        bias: standard deviation of an error that is drawn for each episode and stays: as ``noise``.
        latency: age of a reading when it is seen [s], whole steps. At the beginning of an episode it is the first one.
        rate: readings a second [Hz], whole steps apart; None: one each step. Between them the last one stays.

    Angles [rad] that are bounded by pi stay within it. What is beyond other bounds is clipped.

    Raises:
        EnvOptionError: no such part, or a number that cannot be.
    """

    def __init__(
        self, part: str | Part, noise: float | Sequence[float] = 0.0, bias: float | Sequence[float] = 0.0,
        latency: float = 0.0, rate: float | None = None,
    ) -> None:  # fmt: skip
        self._part = part_of(part)
        self.name = f"sensed_{part if isinstance(part, str) else type(part).__name__}"
        self.reads_scan = reads_scan(self._part)
        for what, value, low, high, unit in (
            ("latency", latency, 0.0, 60.0, "s"), ("rate", 1.0 if rate is None else rate, 1e-3, 1e4, "Hz"),
        ):  # fmt: skip
            if not (isinstance(value, int | float | np.number) and low <= value <= high):
                raise self._refused(f"{what} = {value!r}; it must be {low:g} .. {high:g} {unit}")
        self._noise, self._bias = self._spread("noise", noise), self._spread("bias", bias)
        self._latency, self._rate = float(latency), None if rate is None else float(rate)

    def _refused(self, why: str) -> EnvOptionError:
        return EnvOptionError(f"observation {self.name!r}: {why}")

    def _spread(self, what: str, value: float | Sequence[float]) -> Floats:
        try:
            found = np.array(value, np.float64)
        except (TypeError, ValueError):
            found = np.array(-1.0)
        if found.ndim > 1 or not ((found >= 0.0) & (found <= 1e6)).all():
            raise self._refused(f"{what} = {value!r}; it must be 0 .. 1e6, or one such number for each column")
        return found

    def prepare(self, session: Surroundings) -> None:
        """See ``Part``."""
        self._part.prepare(session)
        columns = self._part.columns
        self.columns, self.low, self.high = columns, self._part.low, self._part.high
        for what, spread in (("noise", self._noise), ("bias", self._bias)):
            if spread.ndim and len(spread) != len(columns):
                raise self._refused(f"{what} has {len(spread)} numbers; the part has {len(columns)}")
        self._wraps = np.flatnonzero(np.isclose(self.high, math.pi, rtol=1e-6))
        count = session.robot.count
        self._past = Past(self.name, count, len(columns), session.seconds, self._rate, self._latency)
        self._now = np.zeros((count, len(columns)), np.float32)
        self._biases = np.zeros((count, len(columns)))

    # ------------------------------------------------------------------ episodes

    def start(self, index: int, seed: int) -> None:
        """See ``past.Remembering``."""
        self._past.start(index, seed)
        self._draw(index, seed)

    def _draw(self, index: int, seed: int) -> None:
        self._biases[index] = self._bias * standard_normal(
            np.random.default_rng((seed, 1 << 40)), self._biases.shape[1]
        )

    def begin(self, which: npt.NDArray[np.bool_] | None) -> None:
        """See ``past.Remembering``."""
        self._part.write(self._now)
        self._past.begin(self._now, which)

    def note(self, which: npt.NDArray[np.bool_] | None) -> None:
        """See ``past.Remembering``."""
        self._part.write(self._now)
        self._past.note(self._now, which)

    def memory(self, index: int) -> Film:
        """See ``past.Remembering``."""
        return self._past.memory(index)

    def recall(self, index: int, film: Film) -> None:
        """See ``past.Remembering``."""
        self._past.recall(index, film)
        self._draw(index, film.seed)

    def write(self, out: Narrow) -> None:
        """See ``Part``."""
        seen = self._past.seen() + self._biases
        if self._noise.any():
            for i, rng in enumerate(self._past.generators()):
                seen[i] += self._noise * standard_normal(rng, seen.shape[1])
        for column in self._wraps.tolist():
            seen[:, column] = np.remainder(seen[:, column] + math.pi, math.tau) - math.pi
        out[:] = seen
