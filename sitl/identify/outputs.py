# SPDX-License-Identifier: BSD-3-Clause
"""Motor outputs of a log."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..logs.dataflash import motors
from .log_streams import FlightLog
from .signals import Span

Array = np.ndarray[Any, Any]

_SETTLES_S = 0.3
"""Around an output at its limit."""


def controls(log: FlightLog) -> tuple[Array, Array]:
    """Times [s], and each motor's output as 0 .. 1 of MOT_PWM_MIN .. MAX (n, motors); empty when the log has none."""
    (low, high), channels = motors.pulses(log.parameters), motors.channels(log.columns)
    if not log.has("RCOU") or not channels:
        return np.zeros(0), np.zeros((0, 0))
    table = log.stream("RCOU")
    columns = [(table[f"C{k}"] - low) / (high - low) for k in channels if f"C{k}" in table]
    return table.time, np.stack(columns, -1)


def saturated(log: FlightLog) -> list[Span]:
    """When a motor's output was at an end of MOT_SPIN_MIN .. MAX."""
    time, outputs = controls(log)
    if not len(time):
        return []
    bottom, top = log.parameter("MOT_SPIN_MIN", default=0.15), log.parameter("MOT_SPIN_MAX", default=0.95)
    at_end = (outputs.max(1) > top - 0.005) | (outputs.min(1) < bottom + 0.005)
    return [Span(t - _SETTLES_S, t + _SETTLES_S) for t in time[at_end].tolist()]


def resolution(log: FlightLog) -> float:
    """What a microsecond of all motors' pulses is of a unit of roll, pitch or yaw output, about."""
    low, high = motors.pulses(log.parameters)
    used = log.parameter("MOT_SPIN_MAX", default=0.95) - log.parameter("MOT_SPIN_MIN", default=0.15)
    return 2.0 / max((high - low) * used, 1e-9)
