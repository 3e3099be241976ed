# SPDX-License-Identifier: BSD-3-Clause
"""Estimates from time series, with intervals that hold when residuals are correlated in time.

Residuals of a flight are not independent: gusts last for seconds, and models leave things out. The covariance is that
of Newey and West (1987); because it is itself an estimate, intervals widen with its share of the series as Kiefer and
Vogelsang (2005, "fixed-b", Bartlett kernel) say.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from scipy import optimize

from .estimate import NORMAL_95

Array = np.ndarray[Any, Any]

GUSTS_S = 8.0
"""Residuals of flights are correlated for so long."""
_WINDOWS = 1 << 14
"""Sums that are held at once."""


class Fit(NamedTuple):
    """An estimate."""

    value: Array
    covariance: Array
    """With the widening for its own uncertainty, so that 1.96 standard errors are 95 %."""
    residual: Array

    @property
    def error(self) -> Array:
        """Standard errors."""
        return np.sqrt(np.maximum(np.diag(self.covariance), 0.0))


def long_run(factors: Array, errors: Array, groups: Array, lag: int) -> Array:
    """Sum of the covariances of scores over all pairs up to a lag of each other, within the same group.

    Scores are factors (n, k), each row times its error (n,).

    A pair j apart has the weight 1 - j / (lag + 1): it is in that share of all windows of lag + 1 samples. So sums over
    such windows, multiplied once, are the same as a product for each lag.
    """
    width = lag + 1
    total = np.zeros((factors.shape[1], factors.shape[1]))
    for group in np.unique(groups):
        rows = np.flatnonzero(groups == group)
        for first in range(0, len(rows) + lag, _WINDOWS):  # the window k ends with row k
            last = min(first + _WINDOWS, len(rows) + lag)
            begin, end = max(first - lag, 0), min(last, len(rows))
            part = rows[begin:end]
            sums = np.zeros((len(part) + 1, factors.shape[1]))
            np.cumsum(factors[part] * errors[part, None], axis=0, out=sums[1:])
            ends = np.arange(first, last)
            windows = sums[np.minimum(ends + 1, end) - begin] - sums[np.maximum(ends - lag, begin) - begin]
            total += windows.T @ windows / width
    return total


def widening(count: int, used: int, lag: int) -> float:
    """Factor on a covariance: degrees of freedom that are used up, and fixed-b critical values."""
    b = min((lag + 1) / count, 1.0)
    critical = NORMAL_95 + 2.9694 * b + 0.4160 * b * b - 0.5324 * b**3
    return float(count / max(count - used, 1) * (critical / NORMAL_95) ** 2)


def least_squares(
    residuals: Callable[[Array], Array],
    start: Array,
    groups: Array,
    lag: int,
    scale: Array | None = None,
    limits: tuple[Array, Array] = (np.array(-np.inf), np.array(np.inf)),
    slopes: Callable[[Array], Array] | None = None,
) -> Fit:
    """Parameters that make residuals small (robust to outliers by Huber's loss).

    Args:
        residuals: of parameters (k,) -> (n,).
        start: parameters to begin with.
        groups: (n,) stretches within which residuals are correlated.
        lag: over how many samples.
        scale: typical size of each parameter.
        limits: least and greatest that each parameter may be.
        slopes: of the residuals by the parameters (n, k), where not all need be worked out one by one.
    """
    options: Any = {"x_scale": scale if scale is not None else 1.0, "bounds": limits, "jac": slopes or "2-point"}
    if slopes is not None:  # each evaluation is long
        options["ftol"] = 1e-6
    first = optimize.least_squares(residuals, start, **options)
    spread = 1.4826 * float(np.median(np.abs(first.fun - np.median(first.fun)))) or 1.0
    found = optimize.least_squares(residuals, first.x, loss="huber", f_scale=3.0 * spread, **options)
    error = residuals(found.x)
    by = slopes(found.x) if slopes is not None else _slopes(residuals, found.x, scale)
    weight = np.minimum(1.0, 3.0 * spread / np.maximum(np.abs(error), 1e-300))
    bread = np.linalg.pinv((by * weight[:, None]).T @ by)
    meat = long_run(by, weight * error, groups, lag)
    covariance = bread @ meat @ bread * widening(len(error), len(start), lag)
    return Fit(found.x, covariance, error)


def _slopes(function: Callable[[Array], Array], at: Array, scale: Array | None) -> Array:
    steps = 1e-5 * (np.abs(at) + (scale if scale is not None else 1.0))
    columns = []
    for k, step in enumerate(steps):
        there, back = at.copy(), at.copy()
        there[k] += step
        back[k] -= step
        columns.append((function(there) - function(back)) / (2.0 * step))
    return np.stack(columns, -1)
