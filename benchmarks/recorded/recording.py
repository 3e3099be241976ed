# SPDX-License-Identifier: BSD-3-Clause
"""Flights of a real ArduPilot SITL as columns at 8 Hz (``benchmarks/reference``), and ours in the same form.

The recordings are of ArduCopter and ArduRover 4.7-dev (July 2025), unmodified, default frames, with their default SITL
parameters.
"""

from __future__ import annotations

import csv
import gzip
from dataclasses import dataclass, field
from importlib import resources
from typing import Any

import numpy as np

from sitl.errors import SitlError

COLUMNS = ("t", "x", "y", "z", "vx", "vy", "vz", "roll", "pitch", "yaw")
"""Simulated seconds since boot, NED metres from the origin, m/s, radians; all the autopilot's own estimate."""


class RecordingError(SitlError, ValueError):
    """A recording that does not exist."""


@dataclass
class Recording:
    """A flight in columns, cut into named phases."""

    data: np.ndarray[Any, Any]
    phases: dict[str, float] = field(default_factory=dict)
    """Start time of each phase [s since boot]."""
    reached: list[tuple[float, int]] = field(default_factory=list)
    """(time [s since boot], mission item) of each MISSION_ITEM_REACHED."""
    texts: list[tuple[float, str]] = field(default_factory=list)
    """(time [s since boot], text) of status texts."""
    disarmed: float = float("nan")

    def text_time(self, phase: str, text: str) -> float:
        """Time from the phase's start until a text with these words; NaN when there is none."""
        start = self.phases[phase]
        return next((t - start for t, found in self.texts if t >= start and text in found), float("nan"))

    def arrival(self, phase: str, seq: int) -> float:
        """Time from the phase's start until mission item ``seq`` was reached; NaN when it was not."""
        start = self.phases[phase]
        return next((t - start for t, item in self.reached if t >= start and item == seq), float("nan"))

    def column(self, name: str) -> np.ndarray[Any, Any]:
        """One column over the whole flight, in its unit, shape (rows,)."""
        return self.data[:, COLUMNS.index(name)]

    def since(self, phase: str, duration: float) -> np.ndarray[Any, Any]:
        """Rows from the phase's start, for ``duration`` seconds, with time counted from that start."""
        start = self.phases[phase]
        t = self.data[:, 0]
        rows = self.data[(t >= start) & (t <= start + duration)].copy()
        rows[:, 0] -= start
        return rows


PHASES = {
    "copter_guided": {
        "takeoff": 48.762,
        "pos_step_20N": 73.762,
        "vel_3E_10s": 98.762,
        "vel_zero": 108.762,
        "yaw_0_abs_ccw": 114.762,
        "yaw_90_abs": 126.8,
        "yaw_rel_cw_45_30dps": 138.8,
        "RTL": 146.8,
    },
    "copter_auto": {"mission_start": 48.059},
    "rover": {
        "vel_2N_10s": 49.231,
        "vel_stop_sending": 59.232,
        "pos_step_20E": 67.232,
        "pos_home": 92.232,
        "HOLD0": 117.232,
        "AUTO": 121.392,
        "vel_2_before_hold": 161.072,
        "HOLD": 167.072,
        "RTL": 173.091,
    },
}
"""Time of each command since boot [s]."""
REACHED = {
    "copter_auto": [(57.299, 1), (65.98, 2), (72.02, 3), (78.059, 4), (86.139, 5)],
    "rover": [(131.512, 1), (136.691, 2), (141.851, 3), (151.072, 4)],
}
TEXTS = {"rover": [(62.191, "target not received last 3secs, stopping"), (188.232, "Reached destination")]}
DISARMED = {"copter_auto": 108.619, "copter_guided": 193.32, "rover": 198.152}


def recorded(name: str) -> Recording:
    """The recording of ArduPilot called ``name`` ("copter_guided", "copter_auto" or "rover").

    Raises:
        RecordingError: there is none of that name.
    """
    file = resources.files("benchmarks") / "reference" / f"ardupilot_{name}.csv.gz"
    if not file.is_file():
        raise RecordingError(f"no recording {name!r}; there are {', '.join(sorted(DISARMED))}")
    rows = list(csv.DictReader(gzip.decompress(file.read_bytes()).decode().splitlines()))
    data = np.array([[float(row[c]) for c in COLUMNS] for row in rows])
    return Recording(data, dict(PHASES[name]), REACHED.get(name, []), TEXTS.get(name, []), DISARMED[name])
