# SPDX-License-Identifier: BSD-3-Clause
"""A log's streams, each at times of its own, on common times."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

Array = np.ndarray[Any, Any]


class Span(NamedTuple):
    """A stretch of time [s] of a log."""

    begin: float
    end: float

    @property
    def length(self) -> float:
        """[s]"""
        return self.end - self.begin


def means(time: Array, values: Array, edges: Array) -> Array:
    """Mean of a stream in each window between two edges: the integral of the straight lines between its samples.

    Args:
        time: of the samples [s], rising.
        values: (n,) or (n, m).
        edges: of the windows [s].
    """
    values = np.asarray(values, float)
    columns = values.reshape(len(values), -1)
    steps, widths = np.diff(time), np.diff(edges)
    index = np.clip(np.searchsorted(time, edges, "right") - 1, 0, len(time) - 2)
    into, step = edges - time[index], np.maximum(time[index + 1] - time[index], 1e-9)
    found = np.empty((len(widths), columns.shape[1]))
    for k, column in enumerate(columns.T):  # one at a time: logs are long
        area = np.zeros(len(column))
        np.cumsum(0.5 * steps * (column[1:] + column[:-1]), out=area[1:])
        slope = (column[index + 1] - column[index]) / step
        found[:, k] = np.diff(area[index] + into * column[index] + 0.5 * into * into * slope) / widths
    return found.reshape(-1, *values.shape[1:])


def increasing(time: Array) -> Array:
    """Which samples come after all before them."""
    if not len(time):
        return np.zeros(0, bool)
    before = np.concatenate([[-np.inf], np.maximum.accumulate(time)[:-1]])
    return time > before


def within(time: Array, spans: Sequence[Span]) -> Array:
    """Which times are in one of these spans."""
    found = np.zeros(len(time), bool)
    for span in spans:
        found |= (time >= span.begin) & (time <= span.end)
    return found


def spectrum(x: Array) -> Array:
    """Of a stretch, after the straight line between its ends is taken away."""
    return np.fft.rfft(x - np.linspace(x[0], x[-1], len(x)))
