# SPDX-License-Identifier: BSD-3-Clause
"""Logged values that are calculated from the record: functions of the samples, a column at a time."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ...autopilot.estimation.status import POS_HORIZ_ABS
from ...core import elementary_arrays as arrays
from ...core.algebra import euler_of
from ...core.array_kernels import Kernel, Table
from ...core.border import BAROS_DIFFER
from ...core.geodesy import METRES_PER_DEGE7
from ...core.kernels import law
from ...core.vectors import Quat
from .samples import Array

DEG = 180.0 / math.pi
E, S, A = "autopilot.estimate.", "sensors.", "autopilot."
Column = Callable[[Any], Array]


def wrapped(angle: str | Column) -> Column:
    """An angle [rad], of the record or calculated, in degrees, 0 .. 360."""
    return lambda s: np.mod((s(angle) if isinstance(angle, str) else angle(s)) * DEG, 360.0)


@law
def euler_of_rows(rows: Table, angles: Table) -> None:
    """Roll, pitch and yaw [rad], shape (n, 3), of quaternions, shape (n, 4)."""
    for k in range(rows.shape[0]):
        found = euler_of(Quat(rows[k, 0], rows[k, 1], rows[k, 2], rows[k, 3]))
        angles[k, 0] = found.roll
        angles[k, 1] = found.pitch
        angles[k, 2] = found.yaw


_eulers = Kernel(euler_of_rows)


def euler(path: str, axis: int) -> Column:
    """Roll (0), pitch (1) or yaw (2) of a quaternion [rad], as the core has it to the last bit."""

    def column(s: Any) -> Array:
        rows = np.stack(_quaternion(s, path), axis=1)
        angles = np.empty((len(rows), 3))
        _eulers(rows, angles)
        found: Array = angles[:, axis]
        return found

    return column


def difference(a: str, b: str) -> Column:
    """One number minus another."""
    return lambda s: s(a) - s(b)


def total(a: str, b: str) -> Column:
    """One number plus another."""
    return lambda s: s(a) + s(b)


def length(*paths: str) -> Column:
    """Euclidean length of a vector."""
    return lambda s: np.sqrt(sum(np.square(s(path)) for path in paths))


def root(path: str) -> Column:
    """Square root of a number."""
    return lambda s: np.sqrt(s(path))


def _latitude(lat0: Array, north: Array) -> Array:
    return lat0 + north / METRES_PER_DEGE7


def _longitude(lat0: Array, lon0: Array, lat: Array, east: Array) -> Array:
    scale = np.maximum(arrays.cos(np.radians(0.5e-7 * (lat0 + lat))), 0.01)
    lon = lon0 + east / (METRES_PER_DEGE7 * scale)
    return np.mod(lon + 1.8e9, 3.6e9) - 1.8e9


def latitude(origin: str, position: str) -> Column:
    """Latitude [degE7] of a position NED [m] relative to ``origin`` (paths that end in ``lat`` and ``lon``)."""
    return lambda s: _latitude(s(origin + "lat"), s(position + "[0]"))


def longitude(origin: str, position: str) -> Column:
    """Longitude [degE7]; arguments as in ``latitude``."""

    def column(s: Any) -> Array:
        lat0, lon0 = s(origin + "lat"), s(origin + "lon")
        return _longitude(lat0, lon0, _latitude(lat0, s(position + "[0]")), s(position + "[1]"))

    return column


def _quaternion(s: Any, path: str) -> tuple[Array, Array, Array, Array]:
    return s(path + "[0]"), s(path + "[1]"), s(path + "[2]"), s(path + "[3]")


def roll(path: str) -> Column:
    """Roll of a quaternion, body to NED [deg]."""

    def column(s: Any) -> Array:
        w, x, y, z = _quaternion(s, path)
        return arrays.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)) * DEG

    return column


def pitch(path: str) -> Column:
    """Pitch of a quaternion, body to NED [deg]."""

    def column(s: Any) -> Array:
        w, x, y, z = _quaternion(s, path)
        return arrays.asin(np.clip(2.0 * (w * y - z * x), -1.0, 1.0)) * DEG

    return column


def yaw(path: str) -> Column:
    """Yaw of a quaternion, body to NED, 0 .. 360 [deg]."""

    def column(s: Any) -> Array:
        w, x, y, z = _quaternion(s, path)
        return np.mod(arrays.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)) * DEG, 360.0)

    return column


def gps_seconds(receiver: str) -> Column:
    """GPS time of the fix relative to boot [s], of a receiver whose numbers begin so."""
    return lambda s: s(receiver + "gps_time_us") * 1e-6


def course(receiver: str) -> Column:
    """Course over ground of a GPS receiver, 0 .. 360 [deg]."""
    return lambda s: np.mod(arrays.atan2(s(receiver + "gps_vel[1]"), s(receiver + "gps_vel[0]")) * DEG, 360.0)


def is_used(receiver: int) -> Column:
    """1 while a GPS receiver is the one in use."""
    return lambda s: s.raw(A + "gps.primary") == receiver


def pressure_altitude(path: str) -> Column:
    """Pressure altitude in the standard atmosphere [m] of a pressure [hPa]."""
    return lambda s: 44330.77 * (1.0 - arrays.pow(np.maximum(s(path), 0.0) / 1013.25, 0.1902632))


def baro_altitude(path: str) -> Column:
    """Barometric altitude above the ground where it was calibrated [m]."""
    above_sea = pressure_altitude(path)
    return lambda s: above_sea(s) - s(A + "ekf.baro_ground")


def baros_differ(s: Any) -> Array:
    """Whether a second barometer shows something of its own, shape (rows,)."""
    found: Array = s.raw(S + "baro_state") == BAROS_DIFFER
    return found


def resting_voltage(s: Any) -> Array:
    """Estimated battery voltage without the drop over its resistance [V]."""
    return s(A + "battery.voltage") + s(A + "battery.current") * s(A + "control.motors.resistance")


def is_seen(path: str) -> Column:
    """1 while a count has begun."""
    return lambda s: s.raw(path) > 0


def estimates(s: Any) -> Array:
    """Whether the filter runs and has an attitude, shape (rows,)."""
    return (s.raw(A + "ekf.use_external") == 0) & (s.raw(A + "ekf.tilt_aligned") != 0)


def second_lane_estimates(s: Any) -> Array:
    """The same of the second filter, shape (rows,)."""
    return estimates(s) & (s.raw(A + "second_lane.runs") != 0)


USES_GPS, GPS_IS_GOOD, INITIALISED = 1 << 13, 1 << 15, 1 << 16
"""Bits of ArduPilot's nav_filter_status that EKF_STATUS_REPORT does not have."""


def solution(e: str, k: str) -> Column:
    """Status of a filter's solution (XKF4.SS); ``e``, ``k``: as in ``common.estimator``."""

    def column(s: Any) -> Array:
        flags = s.raw(e + "status_flags").astype(np.int64)
        flags |= np.where(flags & POS_HORIZ_ABS, USES_GPS, 0) | np.where(s.raw(k + "gps_good_us") > 0, GPS_IS_GOOD, 0)
        return flags | INITIALISED

    return column


def angle_error(path: str) -> Column:
    """Largest of three errors of the filter [deg], from its covariance."""
    return lambda s: np.sqrt(np.maximum(s(f"{path}[0,0]"), np.maximum(s(f"{path}[1,1]"), 0.0))) * DEG


def proportional(loop: str, gain: str) -> Column:
    """P part of a PID."""
    return lambda s: s(loop + ".error") * s(A + "params." + gain)


def derivative(loop: str, gain: str) -> Column:
    """D part of a PID."""
    return lambda s: s(loop + ".derivative") * s(A + "params." + gain)


def ahead(loop: str, gain: str) -> Column:
    """Feed-forward part of a PID."""
    return lambda s: s(loop + ".target") * s(A + "params." + gain)
