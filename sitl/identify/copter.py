# SPDX-License-Identifier: BSD-3-Clause
"""Figures of a copter from its logs. Each is a function of the logs; what a log cannot tell is said with the reason."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..core.constants import GRAVITY
from .figure import NORMAL_95, Figure, Sought
from .flight import FlightLog
from .rates import effectiveness
from .regression import Fit, least_squares
from .signals import means

Array = np.ndarray[Any, Any]

_WINDOW_S = 0.5
_GUSTS_S = 8.0
"""Residuals are correlated for so long."""
_SLOW, _LEVEL = 1.0, 0.3
"""What counts as a hover: speed over the ground, climb or descent [m/s]."""
_LEAST_S = 10.0
_ACCELEROMETER = 0.1
"""Error of the mean of an accelerometer: bias and scale (assumed) [m/s^2]."""
_MOST_RELATIVE = 0.3
"""A wider interval than this is as good as none."""

HOVER_OUTPUT = Sought("hover_output", "", "motor output (0 .. 1 of MOT_PWM_MIN .. MAX, mean) that carries the weight")
HOVER_VOLTAGE = Sought("hover_voltage", "V", "battery voltage at which hover_output was found")
HOVER_CURRENT = Sought("hover_current", "A", "battery current in the hover")
RESISTANCE = Sought("battery_resistance", "ohm", "inner resistance of the battery")
VIBRATION = Sought("vibration", "m/s^2", "vibration in the air (VIBE, greatest axis)")
AXES = (("roll", "R"), ("pitch", "P"), ("yaw", "Y"))


def figures(logs: Sequence[FlightLog]) -> list[Figure]:
    """All figures of a copter that these logs tell, and the others with the reason."""
    return [
        *hover(logs),
        *(effectiveness(logs, axis, letter) for axis, letter in AXES),
        resistance(logs),
        vibration(logs),
        *not_yet(),
    ]


def hover(logs: Sequence[FlightLog]) -> list[Figure]:
    """Output, voltage and current that carry the weight."""
    parts = [part for log in logs if log.has("RCOU", "IMU", "XKF1") for part in _hovers(log)]
    seconds = _WINDOW_S * sum(map(len, parts))
    if seconds < _LEAST_S:
        reason = f"{seconds:.0f} s of hover (below {_SLOW:g} m/s) with RCOU, IMU, XKF1; {_LEAST_S:.0f} s are needed"
        return [sought.hidden(reason) for sought in (HOVER_OUTPUT, HOVER_VOLTAGE, HOVER_CURRENT)]
    rows = np.vstack(parts)
    groups = np.concatenate([np.full(len(part), k) for k, part in enumerate(parts)])
    data = f"{seconds:.0f} s of hover: RCOU, IMU, XKF1"
    output, thrust = rows[:, 0], rows[:, 1]
    # Thrust rises by about 2 g with the output's share of itself, so that small differences of thrust are taken out.
    level = output * (1.0 + 0.5 * (1.0 - thrust / GRAVITY))
    found = _mean(level, groups)
    systematic = found.value[0] * 0.5 * _ACCELEROMETER / GRAVITY
    error = float(np.hypot(found.error[0], systematic / NORMAL_95))
    result = [HOVER_OUTPUT.found(found.value[0], error, data)]
    if not np.isfinite(rows[:, 2:]).all() or rows[:, 2].min() <= 0.0:
        reason = "no BAT, or no battery monitor (BATT_MONITOR)"
        return [*result, HOVER_VOLTAGE.hidden(reason), HOVER_CURRENT.hidden(reason)]
    voltage, current = (_mean(rows[:, k], groups) for k in (2, 3))
    result.append(HOVER_VOLTAGE.found(voltage.value[0], voltage.error[0], data))
    if current.value[0] <= 0.0:
        return [*result, HOVER_CURRENT.hidden("BAT.Curr is 0: the monitor measures no current")]
    return [*result, HOVER_CURRENT.found(current.value[0], current.error[0], data)]


def _hovers(log: FlightLog) -> list[Array]:
    """(output, specific thrust, voltage, current) of the windows of each span in which it hovered."""
    outputs, imu, estimate = log.stream("RCOU"), log.stream("IMU", 0), log.estimate()
    low = log.parameter("MOT_PWM_MIN", default=1000.0)
    high = log.parameter("MOT_PWM_MAX", default=2000.0)
    motors = motor_channels(log)
    if not motors or high <= low:
        return []
    controls = np.stack([(outputs[f"C{k}"] - low) / (high - low) for k in motors if f"C{k}" in outputs], -1)
    top = log.parameter("MOT_SPIN_MAX", default=0.95)
    battery = log.stream("BAT", 0) if log.has("BAT") else None
    velocity = np.stack([estimate["VN"], estimate["VE"], estimate["VD"]], -1)
    found = []
    for span in log.spans:
        edges = np.arange(span.begin, span.end, _WINDOW_S)
        if len(edges) < 3:
            continue
        speed = means(estimate.time, velocity, edges)
        output = means(outputs.time, controls, edges)
        thrust = -means(imu.time, imu["AccZ"], edges)
        power = np.full((len(thrust), 2), np.nan)
        if battery is not None and len(battery) > 2:
            power = means(battery.time, np.stack([battery["Volt"], battery["Curr"]], -1), edges)
        still = (np.hypot(speed[:, 0], speed[:, 1]) < _SLOW) & (np.abs(speed[:, 2]) < _LEVEL)
        still &= (output.max(1) < top - 0.01) & (np.abs(thrust - GRAVITY) < 1.0)
        if still.any():
            found.append(np.column_stack([output.mean(1), thrust, power])[still])
    return found


def motor_channels(log: FlightLog) -> list[int]:
    """Outputs of the motors, by SERVOn_FUNCTION 33 to 40."""
    named = [(log.parameter(f"SERVO{k}_FUNCTION", default=0.0), k) for k in range(1, 15)]
    return [k for function, k in sorted(named) if 33 <= function <= 40]


def _mean(values: Array, groups: Array) -> Fit:
    lag = int(_GUSTS_S / _WINDOW_S)
    return least_squares(lambda p: values - p[0], np.array([float(np.median(values))]), groups, lag)


def resistance(logs: Sequence[FlightLog]) -> Figure:
    """The battery's resistance, from how the voltage follows the current besides the charge that is used up."""
    volts, shapes, groups = [], [], []
    for k, log in enumerate(logs):
        if not log.has("BAT"):
            continue
        table = log.stream("BAT", 0)
        table = table.where(log.inside(table.time))
        if len(table) < 100 or "CurrTot" not in table:
            continue
        charge = table["CurrTot"] - table["CurrTot"][0]
        charge = charge / max(float(charge[-1]), 1e-9)
        volts.append(table["Volt"])
        # A cubic of the charge stands for the rest voltage of each log.
        shape = np.zeros((len(table), 1 + 4 * len(logs)))
        shape[:, 0] = -table["Curr"]
        shape[:, 1 + 4 * k : 5 + 4 * k] = charge[:, None] ** np.arange(4)
        shapes.append(shape)
        groups.append(np.full(len(table), k))
    if not volts:
        return RESISTANCE.hidden("no BAT with voltage and current for 10 s in the air")
    y, x = np.concatenate(volts), np.vstack(shapes)
    x = x[:, np.any(x != 0.0, axis=0)]
    if np.std(x[:, 0]) < 0.02 * abs(float(np.mean(x[:, 0]))) or np.std(y) == 0.0:
        return RESISTANCE.hidden("the current or the voltage did not change")
    start = np.linalg.lstsq(x, y, rcond=None)[0]
    fit = least_squares(lambda p: y - x @ p, start, np.concatenate(groups), int(10 * _GUSTS_S))
    value, error = float(fit.value[0]), float(fit.error[0])
    if value <= 0.0 or NORMAL_95 * error > _MOST_RELATIVE * value:
        return RESISTANCE.hidden(f"the current changed too little: {value:.4f} +- {NORMAL_95 * error:.4f} ohm")
    return RESISTANCE.found(value, error, f"{len(y)} rows of BAT in the air")


def vibration(logs: Sequence[FlightLog]) -> Figure:
    """Mean vibration in the air."""
    parts = []
    for log in logs:
        if log.has("VIBE"):
            table = log.stream("VIBE", 0)
            table = table.where(log.inside(table.time))
            parts.append(np.stack([table[f"Vibe{axis}"] for axis in "XYZ"], -1))
    rows = np.vstack(parts) if parts else np.zeros((0, 3))
    if len(rows) < 100:
        return VIBRATION.hidden("no VIBE for 10 s in the air")
    axis = int(np.argmax(rows.mean(0)))
    groups = np.concatenate([np.full(len(part), k) for k, part in enumerate(parts)])
    values = rows[:, axis]
    fit = least_squares(lambda p: values - p[0], np.array([float(values.mean())]), groups, int(10 * _GUSTS_S))
    return VIBRATION.found(fit.value[0], fit.error[0], f"{len(rows)} rows of VIBE in the air, axis {'XYZ'[axis]}")


def not_yet() -> list[Figure]:
    """Figures for which there is no method yet."""
    reason = "no method yet"
    tried = "no method yet: intervals of what was tried did not hold the truth of simulated flights"
    return [
        Sought("thrust_expo", "", "curve of thrust over output").hidden(tried),
        Sought("motor_lag", "s", "time constant of motors and their controllers").hidden(reason),
        Sought("drag", "1/s", "deceleration by air speed").hidden(tried),
        Sought("battery_capacity", "Ah", "charge of the full battery").hidden("a flight does not empty the battery"),
    ]
