# SPDX-License-Identifier: BSD-3-Clause
"""Sarsa (Rummery and Niranjan, 1994): a state is worth what the action is that the learner takes in it."""

from __future__ import annotations

from sitl.core.kernels import law


@law
def value_taken(row, action):
    """What the state of this row of values is worth to Sarsa when it takes the action in it."""
    return float(row[action])
