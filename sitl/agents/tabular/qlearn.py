# SPDX-License-Identifier: BSD-3-Clause
"""Q-learning (Watkins, 1989): a state is worth what its best action is."""

from __future__ import annotations

from sitl.core.kernels import law
from sitl.core.records import Floats


@law
def best_value(row: Floats) -> float:
    """Value of a state for Q-learning: the greatest value of its row."""
    best = row[0]
    for a in range(1, row.shape[0]):
        best = max(best, row[a])
    return best
