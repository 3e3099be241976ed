# SPDX-License-Identifier: BSD-3-Clause
"""Which action a learner takes, and how much it explores.

Source of ``noisy_greedy``: the Q-learning of the paper's code (erlerobot/gym-gazebo), where an exploring step disturbs
the values of all actions and takes the best of them, so that an epsilon of 0.9 is far from 90 % random moves once
values differ.
"""

from __future__ import annotations

from sitl.core.kernels import law
from sitl.core.records import Floats
from sitl.core.rng import Rng, uniform

from .state import NOISE, LearnerState


def epsilon_in(episode: int, start: float, decay: float, floor: float) -> float:
    """Probability of exploring in an episode, the first being 0: ``start * decay ** episode``, not below the floor."""
    return max(start * decay**episode, min(floor, start))


@law
def noisy_greedy(rng: Rng, row: Floats, width: float) -> int:
    """The best action of a row of values, each disturbed by up to half of ``width``; one of several best at random.

    With a width of 0 nothing is disturbed, and random numbers are drawn only to decide between equals.
    """
    best, equals, chosen = 0.0, 0, 0
    for a in range(row.shape[0]):
        value = row[a]
        if width > 0.0:
            value += (uniform(rng) - 0.5) * width
        if equals == 0 or value > best:
            best, equals, chosen = value, 1, a
        elif value == best:
            equals += 1
            if uniform(rng) * equals < 1.0:
                chosen = a
    return chosen


@law
def choose(learner: LearnerState, row: Floats) -> int:
    """The action that a learner takes, given its values of the actions."""
    if uniform(learner.rng) >= learner.epsilon:
        return noisy_greedy(learner.rng, row, 0.0)
    if learner.exploration != NOISE:
        return int(uniform(learner.rng) * row.shape[0])
    low, high = row[0], row[0]
    for a in range(1, row.shape[0]):
        low, high = min(low, row[a]), max(high, row[a])
    return noisy_greedy(learner.rng, row, max(abs(low), abs(high)))
