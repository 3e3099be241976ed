# SPDX-License-Identifier: BSD-3-Clause
"""What carries a copter in a hover: output, voltage, current."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ..core.constants import GRAVITY
from .estimate import NORMAL_95, Estimate, Sought
from .log_streams import FlightLog
from .outputs import controls
from .regression import GUSTS_S, Fit, least_squares
from .signals import means

Array = np.ndarray[Any, Any]

_WINDOW_S = 0.5
_SLOW, _LEVEL = 1.0, 0.3
"""What counts as a hover: speed over the ground, climb or descent [m/s]."""
_LEAST_S = 10.0
_LEANS = 0.15
"""Relative half of the interval by the mean lean [rad]."""
_LOADS = 1.4
"""Thrust by output and voltage that a hover needs at most by what it needs at least, of 80 % of its windows: more is
another weight. Payloads are dropped and batteries changed while a log goes on."""
_ACCELEROMETER = 0.1
"""Error of the thrust that is left when the accelerometer's bias is taken off: its scale, the curve of thrust by
output, pulses in whole microseconds (assumed) [m/s^2]."""

HOVER_OUTPUT = Sought("hover_output", "", "motor output (0 .. 1 of MOT_PWM_MIN .. MAX, mean) that carries the weight")
HOVER_VOLTAGE = Sought("hover_voltage", "V", "battery voltage at which hover_output was found")
HOVER_CURRENT = Sought("hover_current", "A", "battery current in the hover")


def hover(logs: Sequence[FlightLog]) -> list[Estimate]:
    """Output, voltage and current that carry the weight."""
    found_in = [_without_bias(hovers(log)) for log in logs]
    parts = [part.rows for found in found_in for part in found]
    seconds = _WINDOW_S * sum(map(len, parts))
    if seconds < _LEAST_S:
        reason = (
            f"{seconds:.0f} s of hover (below {_SLOW:g} m/s) with RCOU, IMU, ATT, XKF1; {_LEAST_S:.0f} s are needed"
        )
        return [sought.hidden(reason) for sought in (HOVER_OUTPUT, HOVER_VOLTAGE, HOVER_CURRENT)]
    rows = np.vstack(parts)
    groups = np.concatenate([np.full(len(part), k) for k, part in enumerate(parts)])
    if reason := _weights(rows, logs[0]):
        return [sought.hidden(reason) for sought in (HOVER_OUTPUT, HOVER_VOLTAGE, HOVER_CURRENT)]
    data = f"{seconds:.0f} s of hover: RCOU, IMU, XKF1"
    output, thrust = rows[:, 0], rows[:, 1]
    # Thrust rises by about 2 g with the output's share of itself, so that small differences of thrust are taken out.
    level = output * (1.0 + 0.5 * (1.0 - thrust / GRAVITY))
    # In wind it leans, and air that comes through the rotors takes thrust.
    unsure = _LEANS * float(rows[:, 4].mean())
    found = mean(level, groups)
    systematic = found.value[0] * 0.5 * _ACCELEROMETER / GRAVITY
    error = float(np.linalg.norm([found.error[0], systematic / NORMAL_95, found.value[0] * unsure / NORMAL_95]))
    result = [HOVER_OUTPUT.found(found.value[0], error, data)]
    if not np.isfinite(rows[:, 2:4]).all() or rows[:, 2].min() <= 0.0:
        reason = "no BAT, or no battery monitor (BATT_MONITOR)"
        return [*result, HOVER_VOLTAGE.hidden(reason), HOVER_CURRENT.hidden(reason)]
    voltage, current = (mean(rows[:, k], groups) for k in (2, 3))
    result.append(HOVER_VOLTAGE.found(voltage.value[0], voltage.error[0], data))
    if current.value[0] <= 0.0:
        return [*result, HOVER_CURRENT.hidden("BAT.Curr is 0: the monitor measures no current")]
    return [*result, HOVER_CURRENT.found(current.value[0], current.error[0], data)]


def _weights(rows: Array, log: FlightLog) -> str:
    """Why it was not one weight that the outputs carried; "": it was one, as far as they tell."""
    bottom, top = log.parameter("MOT_SPIN_MIN", default=0.15), log.parameter("MOT_SPIN_MAX", default=0.95)
    command = np.clip((rows[:, 0] - bottom) / (top - bottom), 0.0, None)
    expo = log.parameter("MOT_THST_EXPO", default=0.65)
    load = command * (1.0 - expo + expo * command)
    if np.isfinite(rows[:, 2]).all() and rows[:, 2].min() > 0.0:
        load = load * (rows[:, 2] / rows[:, 2].mean()) ** 2
    low, high = np.percentile(load, (10.0, 90.0))
    if high <= _LOADS * low:
        return ""
    light, heavy = (
        float(np.median(rows[which, 0])) for which in (load <= (low * high) ** 0.5, load > (low * high) ** 0.5)
    )
    return (
        f"the hover needs {high / low:.1f} times the thrust at one time that it needs at another (outputs {light:.2f} "
        f"and {heavy:.2f}): the weight changed; take logs of one weight"
    )


def _without_bias(parts: list[Hover]) -> list[Hover]:
    """The thrust of a log's windows without the accelerometer's bias: on the mean it carries the weight, and what the
    estimated velocity gained."""
    if not parts:
        return parts
    rows, climb = np.vstack([part.rows for part in parts]), np.concatenate([part.climb for part in parts])
    bias = float((rows[:, 1] - (GRAVITY + climb) / np.cos(rows[:, 4])).mean())
    return [part._replace(rows=part.rows - bias * np.array([0.0, 1.0, 0.0, 0.0, 0.0])) for part in parts]


class Hover(NamedTuple):
    """Windows of a span in which it hovered."""

    rows: Array
    """Mean output, specific thrust, voltage, current, lean [rad]."""
    motors: Array
    """Each motor's output."""
    climb: Array
    """What the estimated velocity gained upward [m/s^2]."""

    @property
    def output(self) -> Array:
        """Mean of the motors."""
        return self.rows[:, 0]


def hovers(log: FlightLog) -> list[Hover]:
    """The windows of each span in which it hovered."""
    if not log.has("RCOU", "IMU", "XKF1", "ATT"):
        return []
    imu, estimate, attitude = log.stream("IMU", 0), log.estimate(), log.stream("ATT")
    angles = np.radians(np.stack([attitude["Roll"], attitude["Pitch"]], -1))
    time, outputs = controls(log)
    if not len(time):
        return []
    top = log.parameter("MOT_SPIN_MAX", default=0.95)
    battery = log.stream("BAT", 0) if log.has("BAT") else None
    velocity = np.stack([estimate["VN"], estimate["VE"], estimate["VD"]], -1)
    found = []
    for span in log.spans:
        edges = np.arange(span.begin, span.end, _WINDOW_S)
        if len(edges) < 3:
            continue
        speed = means(estimate.time, velocity, edges)
        output = means(time, outputs, edges)
        thrust = -means(imu.time, imu["AccZ"], edges)
        lean = np.hypot(*means(attitude.time, angles, edges).T)
        power = np.full((len(thrust), 2), np.nan)
        if battery is not None and len(battery) > 2:
            power = means(battery.time, np.stack([battery["Volt"], battery["Curr"]], -1), edges)
        climb = -np.diff(np.interp(edges, estimate.time, estimate["VD"])) / _WINDOW_S
        still = (np.hypot(speed[:, 0], speed[:, 1]) < _SLOW) & (np.abs(speed[:, 2]) < _LEVEL)
        still &= (output.max(1) < top - 0.01) & (np.abs(thrust - GRAVITY) < 1.0)
        if still.any():
            found.append(
                Hover(np.column_stack([output.mean(1), thrust, power, lean])[still], output[still], climb[still])
            )
    return found


def mean(values: Array, groups: Array) -> Fit:
    """Of windows, robust, with an error that counts how long gusts last."""
    lag = int(GUSTS_S / _WINDOW_S)
    return least_squares(lambda p: values - p[0], np.array([float(np.median(values))]), groups, lag)
