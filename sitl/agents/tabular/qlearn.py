# SPDX-License-Identifier: BSD-3-Clause
"""Q-learning (Watkins, 1989): a state is worth what its best action is."""

from __future__ import annotations

from sitl.core.kernels import law


@law
def best_value(row):
    """Value of a state for Q-learning: the greatest value of its row."""
    best = float(row[0])
    for a in range(1, row.shape[0]):
        best = max(best, float(row[a]))
    return best
