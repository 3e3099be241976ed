# SPDX-License-Identifier: BSD-3-Clause
"""Where a state stands in a table: open addressing, rows that are a power of two, at most half of them taken.

States are whole numbers from 0 on. The layout never changes what a learner learns.
"""

from __future__ import annotations

from typing import NamedTuple

from sitl.core.array_kernels import IntLine, IntTable, Kernel, Table
from sitl.core.kernels import law
from sitl.core.records import Ints

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
