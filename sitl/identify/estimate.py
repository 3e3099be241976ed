# SPDX-License-Identifier: BSD-3-Clause
"""One property that was looked for in logs: its value with an interval, or why the logs do not show it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

NORMAL_95 = 1.959964
"""Half of a 95 % interval by its standard error."""
Begins = Callable[[str], None]
"""Called with what is worked on from now on, in words."""


def silent(what: str) -> None:
    """A ``Begins`` that says nothing."""


@dataclass(frozen=True)
class Estimate:
    """A property, observed or not.

    Args:
        name: of the property.
        unit: "" for a number without one.
        meaning: what it is.
        value: the estimate; nan: not observable.
        low, high: ends of its 95 % interval.
        data: what it rests on ("212 s of RCOU and IMU in the air").
        reason: why it is not observable.
        least: of one that is not observable, what it is at least; nan: not known.
    """

    name: str
    unit: str
    meaning: str
    value: float = math.nan
    low: float = math.nan
    high: float = math.nan
    data: str = ""
    reason: str = ""
    least: float = math.nan

    @property
    def is_observed(self) -> bool:
        """Whether the logs show it."""
        return math.isfinite(self.value)

    @property
    def half(self) -> float:
        """Half of the interval."""
        return 0.5 * (self.high - self.low)

    @property
    def relative(self) -> float:
        """Half of the interval by the value."""
        return abs(self.half / self.value) if self.value else math.inf

    def __str__(self) -> str:
        unit = f" {self.unit}" if self.unit else ""
        if not self.is_observed:
            return f"{self.name}: not observable in this log: {self.reason}"
        return f"{self.name}: {self.value:.4g}{unit} (95 %: {self.low:.4g} .. {self.high:.4g}); {self.data}"


@dataclass(frozen=True)
class Sought:
    """A property by name, unit and meaning, before the logs were looked at."""

    name: str
    unit: str
    meaning: str

    def found(self, value: float, error: float, data: str) -> Estimate:
        """Observed, with its standard error."""
        half = NORMAL_95 * error
        return Estimate(
            self.name, self.unit, self.meaning, float(value), float(value - half), float(value + half), data
        )

    def between(self, value: float, low: float, high: float, data: str) -> Estimate:
        """Observed, with an interval."""
        return Estimate(self.name, self.unit, self.meaning, float(value), float(low), float(high), data)

    def hidden(self, reason: str, least: float = math.nan) -> Estimate:
        """Not observable, but at least so much."""
        return Estimate(self.name, self.unit, self.meaning, reason=reason, least=least)
