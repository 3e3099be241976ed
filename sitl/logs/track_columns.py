# SPDX-License-Identifier: BSD-3-Clause
"""What a track has of each moment, and how much it may have."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from .tlog import LogError

Array = np.ndarray[Any, Any]

STEP_US = 100_000
"""Time between two samples [us]."""
LONGEST_S = 48.0 * 3600.0
"""Of a track [s]: 1.7 million samples, 150 MB."""


class Column(NamedTuple):
    """One thing that is sampled."""

    name: str
    unit: str
    quantum: float
    """Step in which it is kept in bytes."""


COLUMNS = (
    Column("t", "s", 0.001),
    Column("north", "m", 0.01),
    Column("east", "m", 0.01),
    Column("down", "m", 0.01),
    Column("vn", "m/s", 0.01),
    Column("ve", "m/s", 0.01),
    Column("vd", "m/s", 0.01),
    Column("roll", "rad", np.radians(0.1)),
    Column("pitch", "rad", np.radians(0.1)),
    Column("yaw", "rad", np.radians(0.1)),
    Column("energy", "Wh", 0.01),
)
"""``t`` since the start of the simulation (a log of others: since its vehicle's boot), position from ``Track.home``,
all NED; yaw within +-pi; energy taken from the battery."""
NAMES = tuple(column.name for column in COLUMNS)
QUANTA = np.array([column.quantum for column in COLUMNS])


class TrackError(LogError):
    """A track that is none, or a log that holds no flight."""
