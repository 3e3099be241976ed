# SPDX-License-Identifier: BSD-3-Clause
"""Metrics of a flight: when something was so, how far, how fast; ours beside ArduPilot's."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from sitl.core import elementary_arrays as arrays

from .recording import COLUMNS

X, Y, Z, VX, VY = (COLUMNS.index(c) for c in ("x", "y", "z", "vx", "vy"))
ROLL, PITCH, YAW = (COLUMNS.index(c) for c in ("roll", "pitch", "yaw"))


@dataclass
class Metric:
    """One metric of a flight, ours and ArduPilot's."""

    name: str
    unit: str
    ours: float
    theirs: float

    @property
    def percent(self) -> float:
        """Difference in percent of ArduPilot's."""
        return 100.0 * (self.ours - self.theirs) / abs(self.theirs) if self.theirs else float("nan")


def crossing(rows: np.ndarray, column: int, level: float) -> float:
    """Time [s] at which a column first crosses ``level``, in its unit (interpolated); NaN when it never does."""
    t, values = rows[:, 0], rows[:, column] - level
    beyond = np.nonzero(values * (np.sign(values[0]) or -1.0) <= 0)[0]
    if not len(beyond):
        return float("nan")
    k = max(int(beyond[0]), 1)
    step = values[k] - values[k - 1]
    return float(t[k] if step == 0 else t[k - 1] - values[k - 1] * (t[k] - t[k - 1]) / step)


def path_rms(ours: np.ndarray, theirs: np.ndarray, from_start: bool = False) -> float:
    """RMS distance [m] between the two positions at equal times since the phase's start.

    ``from_start``: positions count from where each was then, which is for phases without a place to go to.
    """
    t = theirs[theirs[:, 0] <= ours[-1, 0], 0]
    gaps = [np.interp(t, ours[:, 0], ours[:, c]) - theirs[: len(t), c] for c in (X, Y, Z)]
    if from_start:
        gaps = [gap - gap[0] for gap in gaps]
    return float(np.sqrt(np.mean(np.sum(np.square(gaps), axis=0))))


def with_distance(rows: np.ndarray, x: float, y: float) -> np.ndarray:
    """(time [s], horizontal distance to a point [m]) of rows."""
    return np.column_stack((rows[:, 0], arrays.hypot(rows[:, X] - x, rows[:, Y] - y)))


def speeds(rows: np.ndarray) -> np.ndarray:
    """Horizontal speeds [m/s] of rows."""
    return np.asarray(arrays.hypot(rows[:, VX], rows[:, VY]))


def stopped(rows: np.ndarray, level: float = 0.1) -> float:
    """Time [s] after which the horizontal speed stays below ``level`` [m/s]; NaN when it does not."""
    above = np.nonzero(speeds(rows) >= level)[0]
    last = int(above[-1]) if len(above) else -1
    return float(rows[last + 1, 0]) if last + 1 < len(rows) else float("nan")


def shown(value: float) -> str:
    """Two decimals of a value in its unit; a dash for what never was."""
    return "-" if math.isnan(value) else f"{value:.2f}"


def table(found: list[Metric]) -> str:
    """The metrics as Markdown."""
    lines = ["| metric | unit | ours | ArduPilot | difference |", "|---|---|---|---|---|"]
    for f in found:
        theirs, percent = "", ""
        if f.theirs:
            theirs = shown(f.theirs)
            percent = "-" if math.isnan(f.percent) else f"{f.percent:+.1f} %"
        lines.append(f"| {f.name} | {f.unit} | {shown(f.ours)} | {theirs} | {percent} |")
    return "\n".join(lines)
