# SPDX-License-Identifier: BSD-3-Clause
"""Noise of the sensors, from a vehicle that stands with its motors off.

What drifts slowly is taken away by differences of neighbours: half their variance is that of the noise. Steps of what
the log stores are taken off. Densities of gyro and accelerometer follow from the band that is left of them: ArduPilot
logs what the low-pass of INS_GYRO_FILTER and INS_ACCEL_FILTER leaves, ours all of it. They are those of airframes: a
sample of a rate f has the density times the root of f.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from .estimate import NORMAL_95, Estimate, Sought
from .log_streams import FlightLog
from .signals import within

Array = np.ndarray[Any, Any]

GYRO = Sought("gyro_noise_density", "rad/s/sqrt(Hz)", "noise of the gyro")
ACC = Sought("acc_noise_density", "m/s^2/sqrt(Hz)", "noise of the accelerometer")
BIAS = Sought("gyro_bias", "rad/s", "what the gyro shows at rest, the greatest axis")
BARO = Sought("baro_noise", "Pa", "noise of a sample of the barometer")
MAG = Sought("mag_noise", "gauss", "noise of a sample of the compass, each axis")
SPEED = Sought("gps_velocity_noise_vertical", "m/s", "noise of the receiver's vertical velocity")
POSITION = Sought("gps_noise_horizontal", "m", "noise of a fix, without what drifts, each axis")
HEIGHT = Sought("gps_noise_vertical", "m", "the same, vertical")

_LEAST = 60
"""Samples."""
_BUTTERWORTH = 1.1107
"""Noise band of a second-order Butterworth filter by its cut-off."""
_M = 111319.5
"""A degree of latitude."""
_CORRELATED = 0.2
"""Of neighbours' changes: white noise has -0.5, and a filter between changes that."""


def sensors(logs: Sequence[FlightLog]) -> list[Estimate]:
    """Noise of all sensors that the logs have at rest."""
    ours = all("gym-sitl" in log.columns.firmware for log in logs)
    gyro, acc = _band(logs, "INS_GYRO_FILTER", ours), _band(logs, "INS_ACCEL_FILTER", ours)
    return [
        _noise(logs, GYRO, "IMU", lambda t: _axes(t, "Gyr"), np.sqrt(gyro)),
        _noise(logs, ACC, "IMU", lambda t: _axes(t, "Acc"), np.sqrt(acc)),
        _bias(logs),
        _noise(logs, BARO, "BARO", lambda t: t["Press"][:, None], 1.0),
        _noise(logs, MAG, "MAG", lambda t: 1e-3 * _axes(t, "Mag"), 1.0, 1e-3),
        _noise(logs, POSITION, "GPS", _positions, 1.0, 0.011),
        _noise(logs, HEIGHT, "GPS", lambda t: t["Alt"][:, None], 1.0, 0.01),
        _noise(logs, SPEED, "GPS", lambda t: t["VZ"][:, None], 1.0),
    ]


def _axes(table: Any, name: str) -> Array:
    return np.stack([table[f"{name}{axis}"] for axis in "XYZ"], -1)


def _positions(table: Any) -> Array:
    north, east = table["Lat"], table["Lng"]
    return _M * np.stack([north, east * np.cos(np.radians(north.mean()))], -1)


def _band(logs: Sequence[FlightLog], name: str, ours: bool) -> float:
    """Twice the noise band that is left of an inertial sensor [Hz]."""
    log = logs[0]
    rate = float(np.median(log.columns["IMU"]["GHz"])) if log.has("IMU") and "GHz" in log.columns["IMU"] else 1000.0
    cutoff = log.parameter(name, default=20.0)
    raw = max(rate, 1.0)
    return raw if ours or cutoff <= 0.0 else min(2.0 * _BUTTERWORTH * cutoff, raw)


def _at_rest(logs: Sequence[FlightLog], name: str, values: Callable[[Any], Array]) -> list[Array]:
    found = []
    for log in logs:
        if not log.has(name):
            continue
        table = log.stream(name, 0)
        for span in log.at_rest:
            part = table.where(within(table.time, [span]))
            if name == "GPS" and len(part):
                part = part.where(part["Status"] >= 3)
            if len(part) >= _LEAST:
                found.append(values(part))
    return found


def _noise(
    logs: Sequence[FlightLog], sought: Sought, name: str, values: Callable[[Any], Array], root: float, step: float = 0.0
) -> Estimate:
    parts = _at_rest(logs, name, values)
    if not parts:
        return sought.hidden(f"{_LEAST} samples of {name} at rest, disarmed, are needed (LOG_DISARMED 1)")
    changes = [np.diff(part, axis=0) for part in parts]
    squares = np.concatenate([(change * change).ravel() for change in changes])
    alike = sum(float((c[1:] * c[:-1]).sum()) for c in changes) / max(float(squares.sum()), 1e-300)
    variance = 0.5 * float(squares.mean()) - step * step / 12.0
    if variance <= (0.5 * step) ** 2 or squares.max() == 0.0:
        return sought.hidden("the noise is less than a step of what is stored")
    if abs(alike + 0.5) > _CORRELATED:
        return sought.hidden(f"neighbours of {name} are alike (correlation of changes {alike:.2f}): filtered, or moved")
    value = float(np.sqrt(variance)) / root
    # Neighbouring differences share a sample: the variance of their mean square is 1.5 times that of free ones.
    relative = float(np.sqrt(1.5 * 2.0 / len(squares)) / 2.0)
    half = value * float(np.hypot(NORMAL_95 * relative, 0.03))
    rows = sum(map(len, parts))
    return sought.between(value, value - half, value + half, f"{rows} rows of {name} at rest")


def _bias(logs: Sequence[FlightLog]) -> Estimate:
    parts = _at_rest(logs, "IMU", lambda t: _axes(t, "Gyr"))
    if not parts:
        return BIAS.hidden(f"{_LEAST} samples of IMU at rest, disarmed, are needed (LOG_DISARMED 1)")
    rows = np.concatenate(parts)
    axis = int(np.argmax(abs(rows.mean(0))))
    error = float(rows[:, axis].std() / np.sqrt(len(rows)))
    return BIAS.found(
        float(rows[:, axis].mean()),
        float(np.hypot(error, 1e-4)),
        f"{len(rows)} rows of IMU at rest, axis {'XYZ'[axis]}",
    )
