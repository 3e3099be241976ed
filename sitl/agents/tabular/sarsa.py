# SPDX-License-Identifier: BSD-3-Clause
"""Sarsa (Rummery and Niranjan, 1994): a state is worth what the action is that the learner takes in it."""

from __future__ import annotations

from sitl.core.kernels import law
from sitl.core.records import Floats


@law
def value_taken(row: Floats, action: int) -> float:
    """Value of a state for Sarsa: that of the action taken."""
    return row[action]
