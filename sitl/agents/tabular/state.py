# SPDX-License-Identifier: BSD-3-Clause
"""Record of a tabular learner: figures it learns by, and its random numbers. Its table stands beside it."""

from __future__ import annotations

from sitl.core.records import record
from sitl.core.rng import RNG_DTYPE

QLEARN, SARSA = 0, 1
UNIFORM, NOISE = 0, 1

LEARNER_DTYPE = record(
    ("rule", "i8"),  # QLEARN or SARSA
    ("exploration", "i8"),  # UNIFORM or NOISE
    ("first_visit", "i8"),  # 1: the first update of a pair stores its reward
    ("terminal_bootstrap", "i8"),  # 1: the value of a state counts though the episode has ended there
    ("redraw", "i8"),  # 1: Sarsa draws the action that it takes anew after learning from another
    ("frozen", "i8"),  # 1: it plays and does not learn
    ("alpha", "f8"),  # step size
    ("gamma", "f8"),  # discount
    ("epsilon", "f8"),  # probability of exploring, in this episode
    ("states", "i8"),  # how many the table holds
    ("rng", RNG_DTYPE),
)
