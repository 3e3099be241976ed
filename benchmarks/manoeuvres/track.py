# SPDX-License-Identifier: BSD-3-Clause
"""What was flown in a manoeuvre: columns over time, and the metrics that are read off them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from sitl.core import elementary_arrays as arrays
from sitl.core.elementary import hypot

Column = np.ndarray[Any, Any]

_COLUMNS = {name: k for k, name in enumerate(("x", "y", "z", "vx", "vy", "vz", "roll", "pitch", "yaw", "p", "q", "r"))}
_ANGLES = ("roll", "pitch", "yaw")
_RATES = ("p", "q", "r")


class Track:
    """Rows (time [s], position [m], velocity [m/s], attitude [rad], body rates [rad/s]), NED, from ``start`` [s] on."""

    def __init__(self, rows: Column, start: float) -> None:
        self.t: Column = rows[:, 0] - start
        """Since the start [s]."""
        self._rows = rows[:, 1:]

    def __getattr__(self, name: str) -> Column:
        """A column; attitude and rates in degrees, yaw without jumps, counted from the heading at the start."""
        if name not in _COLUMNS:
            raise AttributeError(name)
        column: Column = self._rows[:, _COLUMNS[name]]
        if name == "yaw":
            column = np.unwrap(column)
            column = column - column[0]
        return np.degrees(column) if name in _ANGLES or name in _RATES else column

    @property
    def heading(self) -> float:
        """At the end, 0 .. 360 [deg]."""
        return float(np.degrees(self._rows[-1, _COLUMNS["yaw"]]) % 360.0)

    @property
    def height(self) -> Column:
        """Above the origin [m]."""
        return np.asarray(-self.z)

    @property
    def climb(self) -> Column:
        """Upward [m/s]."""
        return np.asarray(-self.vz)

    @property
    def speed(self) -> Column:
        """Along the ground [m/s]."""
        return np.asarray(arrays.hypot(self.vx, self.vy))

    @property
    def lean(self) -> Column:
        """Angle between thrust and the vertical [deg]."""
        roll, pitch = np.radians(self.roll), np.radians(self.pitch)
        return np.asarray(np.degrees(arrays.acos(np.clip(arrays.cos(roll) * arrays.cos(pitch), -1.0, 1.0))))

    def distance(self, north: float, east: float) -> Column:
        """To a point, along the ground [m]."""
        return np.asarray(arrays.hypot(self.x - north, self.y - east))

    @property
    def covered(self) -> float:
        """Along the ground, from start to end in a straight line [m]."""
        return float(hypot(self.x[-1] - self.x[0], self.y[-1] - self.y[0]))

    def crossing(self, column: Column, level: float) -> float:
        """Time of a column's first crossing of a level [s]; NaN when it never does."""
        values = column - level
        beyond = np.nonzero(values * (np.sign(values[0]) or -1.0) <= 0.0)[0]
        if not len(beyond):
            return math.nan
        k = max(int(beyond[0]), 1)
        step = values[k] - values[k - 1]
        return float(self.t[k] if step == 0.0 else self.t[k - 1] - values[k - 1] * (self.t[k] - self.t[k - 1]) / step)

    def below(self, column: Column, level: float) -> float:
        """Time after which a column stays below a level [s]; NaN when it does not."""
        above = np.nonzero(column >= level)[0]
        after = int(above[-1]) + 1 if len(above) else 0
        return float(self.t[after]) if after < len(self.t) else math.nan

    def at(self, column: Column, time: float) -> float:
        """A column's value at a time [s]."""
        return float(np.interp(time, self.t, column))

    def mean(self, column: Column, since: float) -> float:
        """Mean of a column from a time [s] on."""
        return float(column[self.t >= since].mean())
