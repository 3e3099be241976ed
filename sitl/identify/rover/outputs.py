# SPDX-License-Identifier: BSD-3-Clause
"""Outputs of a rover's log: steering and throttle, or the left and right motors, on even times.

RCOU has them as they are ten times a second. What changes little in between is a straight line. A step, which has
happened at some time between two samples, is one at its *onset*, which the vehicle's answer tells (``fit``).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..log_streams import FlightLog

Array = np.ndarray[Any, Any]

STEERING, THROTTLE, LEFT, RIGHT = 26, 70, 73, 74
"""SERVOn_FUNCTION"""
_STEP = 0.2
"""Between two samples, more than this of the outputs' 2 is a step ..."""
_CALM = 0.06
"""... if it changed by less than this before and after."""
_NEIGHBOURS_S = 0.3
"""Samples farther apart are no neighbours."""


class Steps(NamedTuple):
    """The steps of an output."""

    begin: Array
    """Time of the sample before each [s] (n,)."""
    length: Array
    """Until the sample after it [s]."""
    onset: Array
    """When it happened, from 0 to 1 of that."""


class Output:
    """One output of a log.

    Args:
        time: of the samples [s].
        value: -1 .. 1.
        hold: for which the firmware holds each value [s]: on the average it is half of that old.
    """

    def __init__(self, time: Array, value: Array, hold: float) -> None:
        self.delay = 0.5 * hold
        self.time, self.value = time, value
        change, gap = abs(np.diff(value)), np.diff(time)
        before, after = (np.concatenate(parts) for parts in (([0.0], change[:-1]), (change[1:], [0.0])))
        is_step = (change > _STEP) & (before < _CALM) & (after < _CALM) & (gap < _NEIGHBOURS_S)
        self.indices = np.flatnonzero(is_step)
        self.steps = Steps(time[:-1][is_step], gap[is_step], np.full(int(is_step.sum()), 0.5))

    def at(self, time: Array, width: float) -> Array:
        """Its means around these times, over a width [s] that is less than a sample."""
        found = np.interp(time - self.delay, self.time, self.value)
        for index, begin, length, onset in zip(self.indices, *self.steps):
            inside = slice(*np.searchsorted(time, (begin, begin + length)))
            share = np.clip((time[inside] - begin - onset * length) / width + 0.5, 0.0, 1.0)
            found[inside] = self.value[index] + share * (self.value[index + 1] - self.value[index])
        return found

    def with_onset(self, onset: Array) -> Output:
        """The same with steps at other onsets."""
        other = Output.__new__(Output)
        other.time, other.value, other.indices, other.delay = self.time, self.value, self.indices, self.delay
        other.steps = self.steps._replace(onset=onset)
        return other


def is_skid(log: FlightLog) -> bool:
    """Whether it steers by its left and right motors."""
    return _channel(log, LEFT) is not None and _channel(log, RIGHT) is not None


def outputs(log: FlightLog) -> tuple[Output, Output] | None:
    """Steering and throttle, or left and right; None when the log has not both."""
    wanted = (LEFT, RIGHT) if is_skid(log) else (STEERING, THROTTLE)
    channels = [_channel(log, function) for function in wanted]
    if not log.has("RCOU") or None in channels:
        return None
    table = log.stream("RCOU")
    if any(f"C{channel}" not in table for channel in channels) or len(table) < 10:
        return None
    hold = 1.0 / max(log.parameter("SCHED_LOOP_RATE", default=50.0), 1.0)
    first, second = (Output(table.time, _share(log, channel, table), hold) for channel in channels)
    return first, second


def _channel(log: FlightLog, function: int) -> int | None:
    """The first output with a function."""
    return next((k for k in range(1, 15) if log.parameter(f"SERVO{k}_FUNCTION", default=0.0) == function), None)


def _share(log: FlightLog, channel: int | None, table: Any) -> Array:
    """Pulses as -1 .. 1 of what the firmware makes them of (SERVOn_MIN, _TRIM, _MAX, _REVERSED); none is 0."""
    pulse, name = table[f"C{channel}"], f"SERVO{channel}"
    low, middle, high = (
        log.parameter(f"{name}_{end}", default=width)
        for end, width in (("MIN", 1100.0), ("TRIM", 1500.0), ("MAX", 1900.0))
    )
    share = np.where(
        pulse >= middle, (pulse - middle) / max(high - middle, 1.0), (pulse - middle) / max(middle - low, 1.0)
    )
    share[pulse == 0.0] = 0.0
    return np.clip(-share if log.parameter(f"{name}_REVERSED", default=0.0) else share, -1.0, 1.0)
