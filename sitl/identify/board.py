# SPDX-License-Identifier: BSD-3-Clause
"""Properties that copters and rovers have alike: the battery's resistance, and vibration."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .estimate import NORMAL_95, Estimate, Sought
from .log_streams import FlightLog
from .regression import GUSTS_S, least_squares

_SHAPE = 0.03
"""Relative half of the interval of the resistance: the rest voltage is no cubic."""
_MOST_RELATIVE = 0.3
"""A wider interval than this is as good as none."""

_OF_FIRMWARE = 0.3
"""Relative half of the interval of the firmware's own estimate, assumed. Of a real copter of ArduCopter 4.0.2 it was
15 % above what voltage and current told (and 4 % above in its other log), of simulated ones up to 7 % off."""

RESISTANCE = Sought("battery_resistance", "ohm", "inner resistance of the battery")
CAPACITY = Sought("battery_capacity", "Ah", "charge of the full battery")
VIBRATION = Sought("vibration", "m/s^2", "vibration while it moves (VIBE, greatest axis)")


def resistance(logs: Sequence[FlightLog]) -> Estimate:
    """The battery's resistance, from how the voltage follows the current besides the charge that is used up; where the
    current changes too little, the firmware's own estimate at the end of the last flight, which knows the take-off."""
    found = _by_current(logs)
    if found.is_observed:
        return found
    for log in reversed(logs):
        for name, field in (("BAT", "Res"), ("MOTB", "BatRes")):
            if not log.has(name) or field not in log.columns[name]:
                continue
            table = log.stream(name, 0)
            values = table[field][log.inside(table.time)]
            if len(values) and values[-1] > 0.0:
                value, half = float(values[-1]), _OF_FIRMWARE * float(values[-1])
                return RESISTANCE.between(value, value - half, value + half, f"{name}.{field}, the firmware's estimate")
    return found


def _by_current(logs: Sequence[FlightLog]) -> Estimate:
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
        return RESISTANCE.hidden("no BAT with voltage and current for 10 s while it moved")
    y, x = np.concatenate(volts), np.vstack(shapes)
    x = x[:, np.any(x != 0.0, axis=0)]
    if np.std(x[:, 0]) < 0.02 * abs(float(np.mean(x[:, 0]))) or np.std(y) == 0.0:
        return RESISTANCE.hidden("the current or the voltage did not change")
    start = np.linalg.lstsq(x, y, rcond=None)[0]
    fit = least_squares(lambda p: y - x @ p, start, np.concatenate(groups), int(10 * GUSTS_S))
    value = float(fit.value[0])
    error = float(np.hypot(fit.error[0], _SHAPE * value / NORMAL_95))
    if value <= 0.0 or NORMAL_95 * error > _MOST_RELATIVE * value:
        return RESISTANCE.hidden(f"the current changed too little: {value:.4f} +- {NORMAL_95 * error:.4f} ohm")
    return RESISTANCE.found(value, error, f"{len(y)} rows of BAT")


def vibration(logs: Sequence[FlightLog]) -> Estimate:
    """Mean vibration while it moved."""
    parts = []
    for log in logs:
        if log.has("VIBE"):
            table = log.stream("VIBE", 0)
            table = table.where(log.inside(table.time))
            parts.append(np.stack([table[f"Vibe{axis}"] for axis in "XYZ"], -1))
    rows = np.vstack(parts) if parts else np.zeros((0, 3))
    if len(rows) < 100:
        return VIBRATION.hidden("no VIBE for 10 s while it moved")
    axis = int(np.argmax(rows.mean(0)))
    groups = np.concatenate([np.full(len(part), k) for k, part in enumerate(parts)])
    values = rows[:, axis]
    fit = least_squares(lambda p: values - p[0], np.array([float(values.mean())]), groups, int(10 * GUSTS_S))
    return VIBRATION.found(fit.value[0], fit.error[0], f"{len(rows)} rows of VIBE, axis {'XYZ'[axis]}")
