# SPDX-License-Identifier: BSD-3-Clause
"""Drag and wind, from the specific force along the body's axes.

Without wind a copter that flies forward feels its drag as deceleration along its x axis. As ArduPilot's estimator has
it (EK3_DRAG_MCOEF, EK3_DRAG_BCOEF_X, _Y), one part goes with the air speed (rotors; with the root of the thrust) and
one with its square (the body's area). Wind is a constant of each log, at heights that are alike.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..core.constants import GRAVITY
from ..physics.native.atmosphere import density
from .estimate import NORMAL_95, Estimate, Sought
from .estimated_motion import Motion, motion
from .log_streams import FlightLog
from .regression import GUSTS_S, Fit, least_squares
from .signals import means

Array = np.ndarray[Any, Any]

SPEED = 5.0
"""Air speed [m/s] of drag_along and drag_across."""
ALONG = Sought("drag_along", "m/s^2", f"deceleration by drag at {SPEED:g} m/s forward through the air")
ACROSS = Sought("drag_across", "m/s^2", "the same sideways")
MCOEF = Sought("drag_mcoef", "1/s", "drag of the rotors by air speed, by mass (EK3_DRAG_MCOEF)")
BCOEFS = (
    Sought("drag_bcoef_x", "kg/m^2", "mass by drag area, forward (EK3_DRAG_BCOEF_X)"),
    Sought("drag_bcoef_y", "kg/m^2", "mass by drag area, sideways (EK3_DRAG_BCOEF_Y)"),
)
WIND = Sought("wind_speed", "m/s", "wind at the heights that were flown most")
FROM = Sought("wind_from", "deg", "direction that it comes from")

_WINDOW_S = 0.5
_LAYER_M = 3.0
_LEAST_S = 30.0
_LEAST_SPREAD = 1.5
"""Speeds over the ground, north or east, spread by less than this [m/s]: wind and drag are not distinguished."""
_MOST_RELATIVE = 0.3
_BIAS, _BIAS_ROOT = 0.05, 0.4
"""Error of the accelerometer's mean [m/s^2] (assumed): with one heading it is not distinguished from wind. By residuals
of about 0.15 m/s^2, of which 8 in a row are alike, its weight is this root."""
SYSTEMATIC = 0.04
"""Relative half of the interval for what the model leaves out."""


_WIND = 0.3
"""Half of the interval [m/s] for what gusts leave on the mean, and the estimator's velocity."""


class _Rows:
    """Windows of all logs."""

    def __init__(self, logs: Sequence[FlightLog]) -> None:
        moves: list[Motion] = []
        forces, groups, numbers = [], [], []
        for k, log in enumerate(logs):
            if not log.has("IMU", "XKF1", "ATT"):
                continue
            imu = log.stream("IMU", 0)
            acc = np.stack([imu[f"Acc{axis}"] for axis in "XYZ"], -1)
            for j, span in enumerate(log.spans):
                edges = np.arange(span.begin, span.end, _WINDOW_S)
                if len(edges) < 3:
                    continue
                moves.append(motion(log, edges))
                forces.append(means(imu.time, acc, edges))
                groups.append(np.full(len(edges) - 1, 100 * k + j))
                numbers.append(np.full(len(edges) - 1, k))
        if not moves:
            moves, forces = [Motion(*(np.zeros(0),) * 3, np.zeros((0, 3)), np.zeros(0))], [np.zeros((0, 3))]
            groups = numbers = [np.zeros(0, int)]
        self.motion = Motion(*(np.concatenate(columns) for columns in zip(*moves)))
        self.force, self.groups, self.log = np.vstack(forces), np.concatenate(groups), np.concatenate(numbers)

    def at_one_height(self) -> None:
        """Only windows in the layer in which most of the fast flight was."""
        moved = np.hypot(*self.motion.velocity[:, :2].T) > 1.0
        if moved.any():
            self._keep(abs(self.motion.height - np.median(self.motion.height[moved])) < _LAYER_M)

    def _keep(self, rows: Array) -> None:
        self.motion = Motion(*(column[rows] for column in self.motion))
        self.force, self.groups, self.log = self.force[rows], self.groups[rows], self.log[rows]


def drag(logs: Sequence[FlightLog]) -> list[Estimate]:
    """Drag and wind; the wind only of a single log."""
    rows = _Rows(logs)
    rows.at_one_height()
    seconds = _WINDOW_S * len(rows.groups)
    spread = rows.motion.velocity[:, :2].std(0).min() if seconds else 0.0
    sought = (ALONG, ACROSS, MCOEF, *BCOEFS, WIND, FROM)
    if seconds < _LEAST_S or spread < _LEAST_SPREAD:
        reason = (
            f"{seconds:.0f} s with IMU, ATT, XKF1 at one height, speeds to north and east that spread by "
            f"{spread:.1f} m/s; "
            f"{_LEAST_S:.0f} s and {_LEAST_SPREAD:g} m/s are needed"
        )
        return [one.hidden(reason) for one in sought]
    fit = _fit(rows)
    data = f"{seconds:.0f} s of IMU, ATT, XKF1 within {_LAYER_M:g} m of a height"
    found = _drags(fit, rows, float(np.mean([log.altitude for log in logs])), data)
    if len(logs) > 1:
        return [*found, *(one.hidden("each log has its own wind: give one log") for one in (WIND, FROM))]
    return [*found, *_wind(fit, data)]


def _fit(rows: _Rows) -> Fit:
    """Parameters: two of the rotors' and the body's drag along, one across, two biases, two of the wind of each log.

    As far as the biases are by assumption and not by the data, their error is not in the residuals: what another
    bias, and one that drifts by as much from the middle of each log to its ends, would have made of all parameters is
    added to the covariance.
    """
    none = np.zeros(2)
    found = _fitted(rows, none, none)
    others = [_fitted(rows, *pair) for bias in _BIAS * np.eye(2) for pair in ((bias, none), (none, bias))]
    shifts = [other.value - found.value for other in others]
    return found._replace(covariance=found.covariance + sum(np.outer(shift, shift) for shift in shifts))


def _fitted(rows: _Rows, bias: Array, drift: Array) -> Fit:
    """With biases that are assumed to be these in the middle of each log, and to be so much more at its end."""
    force = rows.force.copy()
    for k in np.unique(rows.log):
        which = rows.log == k
        force[which, :2] -= np.linspace(-1.0, 1.0, which.sum())[:, None] * drift
    names, numbers = np.unique(rows.log, return_inverse=True)
    root = np.sqrt(np.clip(-rows.force[:, 2] / GRAVITY, 0.3, 3.0))

    def residuals(p: Array) -> Array:
        wind = np.zeros((len(numbers), 3))
        wind[:, :2] = p[5:].reshape(len(names), 2)[numbers]
        u, v, _ = rows.motion.along_body(rows.motion.velocity - wind).T
        along = force[:, 0] - p[3] + p[0] * root * u + p[1] * u * abs(u)
        across = force[:, 1] - p[4] + p[0] * root * v + p[2] * v * abs(v)
        return np.concatenate([along, across, _BIAS_ROOT * (p[3:5] - bias) / _BIAS])

    start = np.concatenate([[0.2, 0.005, 0.005, 0.0, 0.0], np.zeros(2 * len(names))])
    after = int(rows.groups.max()) + 1
    groups = np.concatenate([rows.groups, rows.groups + after, [2 * after, 2 * after + 1]])
    return least_squares(residuals, start, groups, int(GUSTS_S / _WINDOW_S))


def _drags(fit: Fit, rows: _Rows, altitude: float, data: str) -> list[Estimate]:
    found = []
    wind = np.zeros((len(rows.log), 3))
    wind[:, :2] = fit.value[5:].reshape(-1, 2)[np.unique(rows.log, return_inverse=True)[1]]
    air = rows.motion.along_body(rows.motion.velocity - wind)
    for k, one in enumerate((ALONG, ACROSS)):
        parts = np.zeros(len(fit.value))
        parts[0], parts[1 + k] = SPEED, SPEED * SPEED
        value, error = float(parts @ fit.value), float(np.sqrt(parts @ fit.covariance @ parts))
        half = float(np.hypot(NORMAL_95 * error, SYSTEMATIC * value))
        most = float(np.percentile(abs(air[:, k]), 90.0))
        if most < 0.4 * SPEED:
            found.append(one.hidden(f"nine tenths of the time it flew slower than {most:.1f} m/s that way"))
        elif value <= 0.0 or half > _MOST_RELATIVE * value:
            found.append(one.hidden(f"too uncertain: {value:.2f} +- {half:.2f} m/s^2"))
        else:
            found.append(one.between(value, value - half, value + half, data))
    value, error = float(fit.value[0]), float(fit.error[0])
    half = float(np.hypot(NORMAL_95 * error, SYSTEMATIC * (value + fit.value[1] * SPEED)))
    if value <= 0.0 or half > _MOST_RELATIVE * value:
        found.append(MCOEF.hidden(f"not told apart from the body's drag: {value:.3f} +- {half:.3f} 1/s"))
    else:
        found.append(MCOEF.between(value, value - half, value + half, data))
    air_density = density(altitude)
    for k, one in enumerate(BCOEFS):
        value, error = float(fit.value[1 + k]), float(fit.error[1 + k])
        half = float(np.hypot(NORMAL_95 * error, SYSTEMATIC * (value + fit.value[0] / SPEED)))
        if value <= 0.0 or half > _MOST_RELATIVE * value:
            found.append(one.hidden(f"not told apart from the rotors' drag: 1/({value:.4f} +- {half:.4f} 1/m)"))
        else:
            best, low, high = (0.5 * air_density / q for q in (value, value + half, value - half))
            found.append(one.between(best, low, high, data))
    return found


def _wind(fit: Fit, data: str) -> list[Estimate]:
    north, east = fit.value[5:7]
    spread = fit.covariance[5:7, 5:7]
    speed = float(np.hypot(north, east))
    if speed == 0.0:
        return [WIND.hidden("none"), FROM.hidden("there is no wind")]
    along = np.array([north, east]) / speed
    error = float(np.sqrt(along @ spread @ along))
    half = float(np.hypot(NORMAL_95 * error, _WIND))
    found = [WIND.between(speed, max(speed - half, 0.0), speed + half, data)]
    side = np.array([-east, north]) / speed
    angle = float(np.degrees(np.sqrt(side @ spread @ side) / speed))
    angle = float(np.hypot(NORMAL_95 * angle, np.degrees(_WIND / speed)))
    if angle > 30.0:
        return [*found, FROM.hidden(f"the wind is weak: {speed:.1f} +- {half:.1f} m/s")]
    at = float(np.degrees(np.arctan2(-east, -north)) % 360.0)
    return [*found, FROM.between(at, at - angle, at + angle, data)]
