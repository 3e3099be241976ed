# SPDX-License-Identifier: BSD-3-Clause
"""One step of learning: what was seen goes into the table, and the next action comes out.

Source: Sutton and Barto, "Reinforcement Learning" (2nd ed.), sections 6.4 and 6.5.
"""

from __future__ import annotations

from typing import NamedTuple

from sitl.core.array_kernels import Kernel
from sitl.core.kernels import law
from sitl.core.records import Records

from .exploration import EMPTY, SARSA, LearnerState, Memory, best_value, choose, slot_of, value_taken


class Move(NamedTuple):
    """A step of the environment."""

    key: int
    """State that it began in."""
    action: int
    """That was taken."""
    reward: float
    after: int
    """State that followed."""
    terminated: bool
    """The episode has ended there, and nothing will follow; running out of steps is no such end."""


@law
def correct_value(learner: LearnerState, table: Memory, move: Move, target: float) -> None:
    """Move the value of a pair of state and action towards a target; the state enters the table if it is new."""
    slot = slot_of(table.keys, move.key)
    if table.keys[slot] == EMPTY:
        table.keys[slot] = move.key
        learner.states += 1
    if table.visits[slot, move.action] == 0 and learner.first_visit:
        table.values[slot, move.action] = move.reward
    else:
        old = table.values[slot, move.action]
        table.values[slot, move.action] = old + learner.alpha * (target - old)
    table.visits[slot, move.action] += 1


@law
def learn(learner: LearnerState, table: Memory, move: Move) -> int:
    """Learn from a step; returns the next action."""
    row = table.values[slot_of(table.keys, move.after)]
    if learner.frozen:
        return choose(learner, row)
    worth, following = 0.0, -1
    if not move.terminated or learner.terminal_bootstrap:
        if learner.rule == SARSA:
            following = choose(learner, row)
            worth = value_taken(row, following)
        else:
            worth = best_value(row)
    correct_value(learner, table, move, move.reward + learner.gamma * worth)
    if following < 0 or learner.redraw:
        following = choose(learner, table.values[slot_of(table.keys, move.after)])
    return following


@law
def learn_first(learners: Records[LearnerState], table: Memory, move: Move) -> int:
    """``learn`` for the only learner of an array."""
    return learn(learners[0], table, move)


@law
def choose_first(learners: Records[LearnerState], table: Memory, key: int) -> int:
    """The first action of an episode, for the only learner of an array."""
    return choose(learners[0], table.values[slot_of(table.keys, key)])


learn_step = Kernel(learn_first)
choose_action = Kernel(choose_first)
