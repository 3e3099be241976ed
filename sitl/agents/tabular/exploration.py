# SPDX-License-Identifier: BSD-3-Clause
"""The laws of tabular learning: a learner's record, the value of a state, exploration, slots of the table.

Which action a learner takes, and how much it explores.

Source of ``noisy_greedy``: the Q-learning of the paper's code (erlerobot/gym-gazebo), where an exploring step disturbs
the values of all actions and takes the best of them, so that an epsilon of 0.9 is far from 90 % random moves once
values differ.

Where a state stands in a table: open addressing, rows that are a power of two, at most half of them taken.

States are whole numbers from 0 on. The layout never changes what a learner learns.
"""

from __future__ import annotations

from typing import NamedTuple

from sitl.core.array_kernels import IntLine, IntTable, Kernel, Table
from sitl.core.elementary import pow
from sitl.core.kernels import law
from sitl.core.records import Floats, Ints, Record
from sitl.core.rng import Rng, uniform

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


def epsilon_in(episode: int, start: float, decay: float, floor: float) -> float:
    """Probability of exploring in an episode, the first being 0: ``start * decay ** episode``, not below the floor."""
    return max(start * pow(decay, float(episode)), min(floor, start))


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


@law
def best_value(row: Floats) -> float:
    """Value of a state for Q-learning: the greatest value of its row."""
    best = row[0]
    for a in range(1, row.shape[0]):
        best = max(best, row[a])
    return best


@law
def value_taken(row: Floats, action: int) -> float:
    """Value of a state for Sarsa: that of the action taken."""
    return row[action]


EMPTY = -1
"""Key of a row that no state has taken."""


class Memory(NamedTuple):
    """The arrays of a table."""

    keys: IntLine
    """Of the states, shape (rows,)."""
    values: Table
    """Shape (rows, actions)."""
    visits: IntTable
    """How often each value was updated, shape (rows, actions)."""


@law
def slot_of(keys: IntLine, key: int) -> int:
    """The row of a state; an empty one, whose values are 0, when the table does not have it."""
    mask = keys.shape[0] - 1
    slot = (key ^ (key >> 9) ^ (key >> 19) ^ (key >> 33)) & mask
    while keys[slot] != key and keys[slot] != EMPTY:
        slot = (slot + 1) & mask
    return slot


@law
def key_of(digits: Ints, radix: IntLine) -> int:
    """The number of a state that has these digits, the first the most significant; ``radix``: how many each can be."""
    key = 0
    for k in range(radix.shape[0]):
        key = key * radix[k] + digits[k]
    return key


@law
def rehash(table: Memory, larger: Memory) -> None:
    """Move all rows into larger arrays, which are empty."""
    for row in range(table.keys.shape[0]):
        if table.keys[row] != EMPTY:
            slot = slot_of(larger.keys, table.keys[row])
            larger.keys[slot] = table.keys[row]
            for a in range(table.values.shape[1]):
                larger.values[slot, a] = table.values[row, a]
                larger.visits[slot, a] = table.visits[row, a]


move_rows = Kernel(rehash)
