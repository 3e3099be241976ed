# SPDX-License-Identifier: BSD-3-Clause
"""Metrics of agreement of two flights: root mean square of the difference, and variance accounted for."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from .flight_log import FlightLog
from .streams import Quantity, Stream

Array = np.ndarray[Any, Any]
_NEAR_S = 1e-3


class Window(NamedTuple):
    """A stretch of a log's flight, since arming [s]."""

    begin: float
    end: float
    shift: float = 0.0
    """How much later the twin does the same [s]."""


@dataclass(frozen=True)
class Agreement:
    """How well one quantity of a flight agrees with the log."""

    quantity: Quantity
    time: Array
    """Of the log's samples that were compared, since arming, shape (n,) [s]."""
    logged: Array
    """(n, columns)"""
    flown: Array
    """The same of the twin, at the same times."""
    moved: float
    """Standard deviation of what was logged, within the windows where there are some."""
    rms: float
    """Of the difference, in the quantity's unit."""
    bias: float
    """Mean of twin minus log, over all columns."""
    worst: float
    """Largest difference."""
    worst_at: float
    """When it was, since arming [s]."""
    vaf: float
    """Variance accounted for [%]: 100 when the difference does not vary; NaN: what was logged hardly moved."""


def compare(
    quantity: Quantity, log: FlightLog, flown: FlightLog, windows: Sequence[Window], *, each: bool = False
) -> Agreement | None:
    """Agreement of one quantity within windows; None: one of the two does not have it.

    Args:
        quantity: what is compared.
        log, flown: the flights.
        windows: of time since arming; what is outside does not count.
        each: variances are those about the mean of each window.
    """
    then, now = quantity.of(log), quantity.of(flown)
    if then is None or now is None or len(now.time) < 2 or then.values.shape[1] != now.values.shape[1]:
        return None
    member = _members(then.time, windows, now)
    if (member >= 0).sum() < 3:
        return None
    inside = member >= 0
    time, logged, member = then.time[inside], then.values[inside], member[inside]
    moment = time + np.array([window.shift for window in windows])[member]
    if quantity.is_angle:
        here = _at(Stream(now.time, np.degrees(np.unwrap(np.radians(now.values), axis=0))), moment)
        difference = np.mod(here - logged + 180.0, 360.0) - 180.0
        logged = np.degrees(np.unwrap(np.radians(logged), axis=0))
        here = logged + difference
    else:
        here = _at(now, moment)
        difference = here - logged
    if each and quantity.adds_up:
        first = np.array([np.argmax(member == k) for k in range(len(windows))])
        difference = difference - difference[first[member]]
        here = logged + difference
    return _metrics(quantity, time, logged, here, difference, member if each else np.zeros(len(time), int))


def _members(time: Array, windows: Sequence[Window], now: Stream) -> Array:
    """Window of each sample; -1: of none."""
    member = np.full(len(time), -1)
    for k, window in enumerate(windows):  # both samples that a value is between are of the same window
        begin, end = window.begin - _NEAR_S, window.end + _NEAR_S
        first, last = np.searchsorted(time, (begin, end), "left")
        moment = time[first:last] + window.shift
        after = np.clip(np.searchsorted(now.time, moment, "left"), 1, len(now.time) - 1)
        inside = (now.time[after - 1] >= begin + window.shift) & (now.time[after] <= end + window.shift)
        member[first:last][inside] = k
    return member


def _at(stream: Stream, time: Array) -> Array:
    return np.stack([np.interp(time, stream.time, column) for column in stream.values.T], 1)


def _metrics(q: Quantity, time: Array, logged: Array, here: Array, difference: Array, member: Array) -> Agreement:
    squares = difference * difference
    size = np.sqrt(squares.sum(1)) if q.is_vector else np.abs(difference).max(1)
    rms = math.sqrt(float(squares.sum(1).mean() if q.is_vector else squares.mean()))
    left, was = _variance(difference, member), _variance(logged, member)
    moved = math.sqrt(was)
    vaf = 100.0 * (1.0 - left / was) if moved >= q.moves else math.nan
    k = int(np.argmax(size))
    return Agreement(
        q, time, logged, here, moved, rms, float(difference.mean()), float(size[k]), float(time[k]), float(vaf)
    )


def _variance(values: Array, member: Array) -> float:
    """About the mean of each window, over all columns."""
    _, index = np.unique(member, return_inverse=True)
    count = np.bincount(index).astype(float)
    total = 0.0
    for column in values.T:
        mean = np.bincount(index, column) / count
        total += float(np.square(column - mean[index]).mean())
    return total / values.shape[1]
