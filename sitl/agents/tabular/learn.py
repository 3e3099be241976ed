# SPDX-License-Identifier: BSD-3-Clause
"""One step of learning: what was seen goes into the table, and the next action comes out.

Source: Sutton and Barto, "Reinforcement Learning" (2nd ed.), sections 6.4 and 6.5.
"""

from __future__ import annotations

from typing import Any

from sitl.core.array_kernels import kernel
from sitl.core.kernels import law

from .exploration import choose
from .qlearn import best_value
from .sarsa import value_taken
from .slots import EMPTY, slot_of
from .state import SARSA, LearnerState


@law
def update(learner, keys, values, visits, key, action, target, reward):
    """Move the value of a pair of state and action towards a target; the state enters the table if it is new."""
    slot = slot_of(keys, key)
    if int(keys[slot]) == EMPTY:
        keys[slot] = key
        learner.states += 1
    if int(visits[slot, action]) == 0 and int(learner.first_visit) != 0:
        values[slot, action] = reward
    else:
        old = float(values[slot, action])
        values[slot, action] = old + float(learner.alpha) * (target - old)
    visits[slot, action] += 1


@law
def learn(learner, keys, values, visits, key, action, reward, after, terminated):
    """Learn from a step, choose the next action.

    Args:
        learner: record.
        keys, values, visits: the table; shapes (rows,), (rows, actions), (rows, actions).
        key, action, reward: state, what was done in it, what that gave.
        after: the state that followed.
        terminated: 1: the episode has ended there, and nothing will follow; running out of steps is no such end.
    """
    if int(learner.frozen) != 0:
        return choose(learner, values[slot_of(keys, after)])
    worth, following = 0.0, -1
    if terminated == 0 or int(learner.terminal_bootstrap) != 0:
        row = values[slot_of(keys, after)]
        if int(learner.rule) == SARSA:
            following = choose(learner, row)
            worth = value_taken(row, following)
        else:
            worth = best_value(row)
    update(learner, keys, values, visits, key, action, reward + float(learner.gamma) * worth, reward)
    if following < 0 or int(learner.redraw) != 0:
        following = choose(learner, values[slot_of(keys, after)])
    return following


@law
def learn_first(learners, keys, values, visits, key, action, reward, after, terminated):
    """``learn`` for the only learner of an array."""
    return learn(learners[0], keys, values, visits, key, action, reward, after, terminated)


@law
def choose_first(learners, keys, values, key):
    """The first action of an episode, for the only learner of an array."""
    return choose(learners[0], values[slot_of(keys, key)])


def learners_type() -> Any:
    """Numba's type of an array of learners."""
    from numba import types

    from sitl.core.numba_records import numba_type

    return types.Array(numba_type(LearnerState), 1, "C")


def _learn_signature() -> Any:
    from numba import types

    whole, keys, values = types.int64, types.int64[::1], types.float64[:, ::1]
    visits = types.int64[:, ::1]
    return whole(learners_type(), keys, values, visits, whole, whole, types.float64, whole, whole)


def _choose_signature() -> Any:
    from numba import types

    return types.int64(learners_type(), types.int64[::1], types.float64[:, ::1], types.int64)


learn_step = kernel(_learn_signature)(learn_first)
choose_action = kernel(_choose_signature)(choose_first)
