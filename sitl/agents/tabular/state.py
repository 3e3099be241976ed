# SPDX-License-Identifier: BSD-3-Clause
"""Record of a tabular learner: figures it learns by, and its random numbers. Its table stands beside it."""

from __future__ import annotations

from sitl.core.records import Record
from sitl.core.rng import Rng

QLEARN, SARSA = 0, 1
UNIFORM, NOISE = 0, 1


class LearnerState(Record):
    """A learner."""

    rule: int  # QLEARN or SARSA
    exploration: int  # UNIFORM or NOISE
    first_visit: bool  # the first update of a pair stores its reward
    terminal_bootstrap: bool  # the value of a state counts though the episode has ended there
    redraw: bool  # Sarsa draws the action that it takes anew after learning from another
    frozen: bool  # it plays and does not learn
    alpha: float  # step size
    gamma: float  # discount
    epsilon: float  # probability of exploring, in this episode
    states: int  # how many the table holds
    rng: Rng
