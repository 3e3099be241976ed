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
    steps = np.diff(time)[:, None]
    area = np.vstack([np.zeros((1, columns.shape[1])), np.cumsum(0.5 * steps * (columns[1:] + columns[:-1]), 0)])
    place = np.clip(np.searchsorted(time, edges, "right") - 1, 0, len(time) - 2)
    into = (edges - time[place])[:, None]
    slope = (columns[place + 1] - columns[place]) / np.maximum(time[place + 1] - time[place], 1e-9)[:, None]
    integral = area[place] + into * columns[place] + 0.5 * into * into * slope
    found = np.diff(integral, axis=0) / np.diff(edges)[:, None]
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
