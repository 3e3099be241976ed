# SPDX-License-Identifier: BSD-3-Clause
"""Limits of a twin's metrics: ``height.rms=0.5``, ``segments.roll_rate.vaf=80``."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

from sitl.errors import OptionError, did_you_mean

AT_LEAST = "vaf"
"""Of this metric a limit is the least value, of the others the greatest size."""
_KINDS = ("rms", "max", "bias", AT_LEAST)


class Verdict(NamedTuple):
    """A metric and its limit."""

    name: str
    value: float
    """NaN: the flight does not tell it."""
    limit: float

    @property
    def ok(self) -> bool:
        """Whether it is kept."""
        if not math.isfinite(self.value):
            return False
        return self.value >= self.limit if self.name.endswith(AT_LEAST) else abs(self.value) <= self.limit

    @property
    def words(self) -> str:
        """In a line."""
        allowed = f"{'at least' if self.name.endswith(AT_LEAST) else 'at most'} {self.limit:g}"
        if not math.isfinite(self.value):
            return f"{self.name} cannot be told: what was logged of it hardly moved; {allowed} is asked for"
        return f"{self.name} is {self.value:.4g}, {allowed} is asked for"


def parse(text: str) -> tuple[str, float]:
    """``NAME=VALUE``; a quantity alone means its root mean square.

    Raises:
        OptionError: it is none.
    """
    name, _, value = text.partition("=")
    name = name.strip()
    try:
        limit = float(value)
    except ValueError:
        limit = math.nan
    if not name or not math.isfinite(limit):
        raise OptionError(f"limit {text!r} is not NAME=VALUE, as in height.rms=0.5 or roll_rate.vaf=80")
    return (name if name.rpartition(".")[2] in _KINDS else f"{name}.rms"), limit


def judge(metrics: Mapping[str, float], limits: Mapping[str, float]) -> list[Verdict]:
    """Each limit with its metric.

    Raises:
        OptionError: a limit of something that is no metric of this flight.
    """
    found = []
    for given, limit in limits.items():
        name = given if given.rpartition(".")[2] in _KINDS else f"{given}.rms"
        if name not in metrics:
            known = sorted({metric.rpartition(".")[0] for metric in metrics})
            hint = did_you_mean(name, metrics)
            raise OptionError(
                f"limit {given!r} is of no metric of this flight{hint}; they are .rms, .max, .bias and .vaf of "
                + ", ".join(known)
            )
        found.append(Verdict(name, metrics[name], float(limit)))
    return found
