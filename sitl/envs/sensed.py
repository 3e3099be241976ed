# SPDX-License-Identifier: BSD-3-Clause
"""Parts of observations as a sensor of one's own would give them: noisy, late, seldom, or not at all."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from .losses import rates_of
from .noise import standard_normal
from .options import EnvOptionError
from .parts import Narrow, Part, Surroundings, part_of
from .past import Film, Past
from .senses import reads_scan

Floats = npt.NDArray[np.float64]
MOST_LOST = 0.999
"""Greatest share of readings that may be lost."""


def _plain(part: str | Part) -> Part:
    if isinstance(part, Sensed):
        raise EnvOptionError(f"observation: {part.name!r} has errors of its own; give all of them to one Sensed")
    return part_of(part)


class Together:
    """Several parts as one: their numbers one after another.

    Args:
        parts: names (``parts.PARTS``), or parts.
    """

    def __init__(self, parts: Sequence[str | Part]) -> None:
        if not parts:
            raise EnvOptionError("observation: a list of parts that arrive together is empty")
        self._parts = [_plain(part) for part in parts]
        self.name = "+".join(part if isinstance(part, str) else type(part).__name__ for part in parts)
        self.reads_scan = any(reads_scan(part) for part in self._parts)

    def prepare(self, session: Surroundings) -> None:
        """See ``Part``."""
        for part in self._parts:
            part.prepare(session)
        self.columns = [column for part in self._parts for column in part.columns]
        self.low = [bound for part in self._parts for bound in part.low]
        self.high = [bound for part in self._parts for bound in part.high]

    def write(self, out: Narrow) -> None:
        """See ``Part``."""
        first = 0
        for part in self._parts:
            part.write(out[:, first : first + len(part.columns)])
            first += len(part.columns)


class Sensed:
    """A part with errors besides those of the vehicle's own sensors; the same seed draws the same ones.

    Args:
        part: its name (``parts.PARTS``), or a part; or a list of such, which arrive and are lost together.
        noise: standard deviation of each reading, in its unit: one number for all columns, or one for each.
        bias: standard deviation of an error that is drawn for each episode and stays: as ``noise``.
        latency: age of a reading when it is seen [s], whole steps; or (least, greatest), of which each episode draws
            one. At the beginning of an episode the first reading is seen.
        rate: readings a second [Hz], whole steps apart; None: one each step. Between them the last one stays.
        dropout: share of readings that are lost, within [0, 1); in their place the last one that arrived is seen, as it
            was. The first one of an episode arrives.
        burst: mean number of readings that are lost in a row, 1 or more; None: losses are independent of each other.
        mask: whether there is one more column: 1 if the last reading arrived, 0 if it was lost.

    Angles [rad] that are bounded by pi stay within it. What is beyond other bounds is clipped.

    Raises:
        EnvOptionError: no such part, or a number that cannot be.
    """

    def __init__(
        self, part: str | Part | Sequence[str | Part], noise: float | Sequence[float] = 0.0,
        bias: float | Sequence[float] = 0.0, latency: float | Sequence[float] = 0.0, rate: float | None = None,
        dropout: float = 0.0, burst: float | None = None, mask: bool = False,
    ) -> None:  # fmt: skip
        self._part: Part = Together(part) if isinstance(part, list | tuple) else _plain(part)  # type: ignore[arg-type]
        self.name = f"sensed_{part if isinstance(part, str) else getattr(self._part, 'name', type(part).__name__)}"
        self.reads_scan = reads_scan(self._part)
        ends = tuple(latency) if isinstance(latency, list | tuple) else (latency, latency)
        if len(ends) != 2 or (all(isinstance(end, int | float | np.number) for end in ends) and ends[0] > ends[1]):
            raise self._refused(f"latency = {latency!r}; it must be a time [s], or (least, greatest)")
        for what, value, low, high, unit in (
            *(("latency", end, 0.0, 60.0, " s") for end in ends),
            ("rate", 1.0 if rate is None else rate, 1e-3, 1e4, " Hz"),
            ("dropout", dropout, 0.0, MOST_LOST, ""), ("burst", 1.0 if burst is None else burst, 1.0, 1e6, " readings"),
        ):  # fmt: skip
            if not (isinstance(value, int | float | np.number) and low <= value <= high):
                raise self._refused(f"{what} = {value!r}; it must be {low:g} .. {high:g}{unit}")
        if burst is not None and dropout > burst / (burst + 1.0):
            raise self._refused(
                f"dropout = {dropout!r} with burst = {burst!r}: where {burst:g} readings in a row are lost and one "
                f"arrives, {burst / (burst + 1.0):g} of them are lost; a greater share needs a greater burst"
            )
        self._noise, self._bias = self._spread("noise", noise), self._spread("bias", bias)
        self._latency = float(ends[0]), float(ends[1])
        self._rate = None if rate is None else float(rate)
        self._losses = rates_of(float(dropout), None if burst is None else float(burst)) if dropout > 0.0 else None
        self._mask = bool(mask)

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
        more = int(self._mask)
        self.columns = (*columns, *(("the last reading arrived [0, 1]",) * more))
        self.low, self.high = (*self._part.low, *((0.0,) * more)), (*self._part.high, *((1.0,) * more))
        for what, spread in (("noise", self._noise), ("bias", self._bias)):
            if spread.ndim and len(spread) != len(columns):
                raise self._refused(f"{what} has {len(spread)} numbers; the part has {len(columns)}")
        self._wraps = np.flatnonzero(np.isclose(self._part.high, math.pi, rtol=1e-6))
        count = session.robot.count
        self._past = Past(self.name, count, len(columns), session.seconds, self._rate, self._latency, self._losses)
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
        out[:, : seen.shape[1]] = seen
        if self._mask:
            out[:, -1] = self._past.arrives
