# SPDX-License-Identifier: BSD-3-Clause
"""Estimates by instruments when some parameters are not linear and several series share them (generalised method of
moments, Hansen 1982): residuals must have nothing to do with the instruments.

The covariance is that of residuals that are correlated in time (``regression.long_run``); it grows when the moments
contradict each other by more than chance.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from scipy import optimize
from scipy.linalg import lapack

from .regression import long_run, widening

Array = np.ndarray[Any, Any]


WEAK = 60.0
"""F statistic below which instruments are weak: neighbours in time are alike, so that chance alone reaches 25."""

_WORK = 64
"""Columns of a block of LAPACK's."""


class Block:
    """One series: y = x b + e, where y and x depend on shared parameters.

    Args:
        columns: of the shared parameters -> y (n,), x (n, k).
        instruments: (n, m), m >= k; it is overwritten, which saves half of the memory.
        groups: (n,) stretches within which residuals are correlated.
        lag: over how many samples.
    """

    def __init__(self, columns: Callable[[Array], tuple[Array, Array]], instruments: Array, groups: Array, lag: int):
        self.columns, self.groups, self.lag = columns, groups, lag
        for column in instruments.T:
            column /= max(float(column.std()), 1e-300)
        self.q = _orthonormal(instruments)
        self.weight: Array = np.eye(self.q.shape[1])

    def at(self, shared: Array) -> Block:
        """The same series with nothing shared."""
        other = Block.__new__(Block)
        kept = self.columns(shared)
        other.columns, other.groups, other.lag = (lambda _: kept), self.groups, self.lag
        other.q, other.weight = self.q, self.weight
        return other

    def moments(self, shared: Array) -> tuple[Array, Array]:
        """Weighted moments of y (m,) and x (m, k)."""
        y, x = self.columns(shared)
        return self.weight @ (self.q.T @ y), self.weight @ (self.q.T @ x)

    def linear(self, shared: Array) -> tuple[Array, Array]:
        """The best b, and what is left of the moments."""
        y, x = self.moments(shared)
        b = np.linalg.lstsq(x, y, rcond=None)[0]
        return b, y - x @ b

    def reweight(self, shared: Array) -> None:
        """Weigh the moments by the inverse of their covariance."""
        b, _ = self.linear(shared)
        y, x = self.columns(shared)
        spread = long_run(self.q, y - x @ b, self.groups, self.lag)
        spread += 1e-9 * np.trace(spread) / len(spread) * np.eye(len(spread))
        self.weight = np.linalg.cholesky(np.linalg.inv(spread)).T

    def strength(self, column: int) -> float:
        """F statistic of the instruments for a column of x, with shared parameters of 0 (``WEAK``)."""
        values, seen = self._seen(column)
        noise = float((values - seen) @ (values - seen)) / max(len(values) - self.q.shape[1], 1)
        return float(seen @ seen) / self.q.shape[1] / max(noise, 1e-300)

    def moved(self, column: int) -> float:
        """Root mean square of what the instruments explain of a column."""
        _, seen = self._seen(column)
        return float(np.sqrt(np.mean(seen * seen)))

    def _seen(self, column: int) -> tuple[Array, Array]:
        values = self.columns(np.zeros(2))[1][:, column]
        return values, self.q @ (self.q.T @ values)


def _orthonormal(columns: Array) -> Array:
    """Q of the QR decomposition; in the same memory when the columns stand one behind the other."""
    reflected, tau, _, failed = lapack.dgeqrf(columns, lwork=_WORK * columns.shape[1], overwrite_a=1)
    q, _, also_failed = lapack.dorgqr(reflected, tau, lwork=_WORK * columns.shape[1], overwrite_a=1)
    assert not failed and not also_failed
    return np.asarray(q)


class JointFit(NamedTuple):
    """An estimate."""

    shared: Array
    shared_errors: Array
    values: list[Array]
    """b of each block."""
    errors: list[Array]
    """Standard errors, widened so that 1.96 of them are 95 %."""
    misfit: float
    """Moments' chi-square by its degrees of freedom: about 1 when the model is right."""


def fit(blocks: Iterable[Block], start: Array, scale: Array, known: JointFit | None = None) -> JointFit:
    """Shared parameters and each block's b, in two steps (weights of the second from the residuals of the first).

    Args:
        blocks: the series; with ``known`` one is held at a time.
        start: shared parameters to begin with.
        scale: their typical sizes.
        known: a fit that has already found the shared ones; they stay at ``start``, its errors count.
    """
    if known is not None:
        return _with_known(blocks, start, scale, known)
    blocks = list(blocks)
    shared = start
    for _ in range(2):
        shared = _search(blocks, shared, scale)
        for block in blocks:
            block.reweight(shared)
    shared = _search(blocks, shared, scale)
    values = [block.linear(shared)[0] for block in blocks]
    slopes = _slopes(blocks, values, shared, scale)
    covariance = np.linalg.pinv(slopes.T @ slopes)
    count = sum(len(block.groups) for block in blocks)
    freedom = max(slopes.shape[0] - slopes.shape[1], 1)
    left = _left(blocks, shared)
    misfit = float(left @ left) / freedom
    covariance *= widening(count, slopes.shape[1], blocks[0].lag) * max(misfit, 1.0)
    errors = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    ends = np.cumsum([len(shared), *map(len, values)])
    return JointFit(shared, errors[: ends[0]], values, [errors[a:b] for a, b in pairwise(ends)], misfit)


def _with_known(blocks: Iterable[Block], shared: Array, scale: Array, known: JointFit) -> JointFit:
    """Each block's b at given shared parameters, whose errors go over to it."""
    values, errors, misfit = [], [], 0.0
    for block in blocks:
        for _ in range(2):
            block.reweight(shared)
        found = fit([block.at(shared)], np.zeros(0), np.zeros(0))
        slopes = _slopes([block], found.values, shared, scale)
        gain = np.linalg.pinv(slopes[:, len(shared) :]) @ slopes[:, : len(shared)]
        values += found.values
        errors.append(np.hypot(found.errors[0], np.linalg.norm(gain * known.shared_errors, axis=1)))
        misfit = max(misfit, found.misfit)
        del block  # before the next one is made
    return JointFit(shared, known.shared_errors, values, errors, misfit)


def _left(blocks: list[Block], shared: Array) -> Array:
    """All weighted moments that are left at the best b."""
    return np.concatenate([block.linear(shared)[1] for block in blocks])


def _search(blocks: list[Block], shared: Array, scale: Array) -> Array:
    if not len(shared):
        return shared
    return optimize.least_squares(lambda p: _left(blocks, p), shared, x_scale=scale).x


def _slopes(blocks: list[Block], values: list[Array], shared: Array, scale: Array) -> Array:
    """Moments by shared parameters, then by b of each block."""
    rows = []
    width = len(shared) + sum(map(len, values))
    at = len(shared)
    for block, b in zip(blocks, values):
        row = np.zeros((len(block.weight), width))
        for k, step in enumerate(1e-3 * scale):
            ends = []
            for sign in (1.0, -1.0):
                p = shared.copy()
                p[k] += sign * step
                y, x = block.moments(p)
                ends.append(y - x @ b)
            row[:, k] = (ends[0] - ends[1]) / (2.0 * step)
        row[:, at : at + len(b)] = -block.moments(shared)[1]
        at += len(b)
        rows.append(row)
    return np.vstack(rows)
