# SPDX-License-Identifier: BSD-3-Clause
"""Where vehicles are drawn that have a world each: the worlds side by side, or all vehicles in one."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from .frame import Points

GRID, ONE = "grid", "one world"
LAYOUTS = (GRID, ONE)
BETWEEN = 1.0
"""From one world of the grid to the next [m]."""


def side_by_side(count: int, low: Sequence[float], high: Sequence[float]) -> Points:
    """Positions of the worlds' origins, in the scene's axes [m], shape (count, 3).

    Args:
        count: of worlds.
        low, high: corners of a world, seen from above [m].
    """
    number = np.arange(count)
    columns = math.ceil(math.sqrt(count))
    across, along = number % columns, number // columns
    long, wide = high[0] - low[0] + BETWEEN, high[1] - low[1] + BETWEEN
    return np.column_stack([-along * long, -across * wide, np.zeros(count)])
