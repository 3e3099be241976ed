# SPDX-License-Identifier: BSD-3-Clause
"""Where a state stands in a table: open addressing, rows that are a power of two, at most half of them taken.

States are whole numbers from 0 on. The layout never changes what a learner learns.
"""

from __future__ import annotations

from sitl.core.array_kernels import kernel
from sitl.core.kernels import law

EMPTY = -1
"""Key of a row that no state has taken."""


@law
def slot_of(keys, key):
    """The row of a state; an empty one, whose values are 0, when the table does not have it."""
    mask = keys.shape[0] - 1
    slot = (key ^ (key >> 9) ^ (key >> 19) ^ (key >> 33)) & mask
    while int(keys[slot]) != key and int(keys[slot]) != EMPTY:
        slot = (slot + 1) & mask
    return slot


@law
def key_of(digits, radix):
    """The number of a state that has these digits, the first the most significant; ``radix``: how many each can be."""
    key = 0
    for k in range(radix.shape[0]):
        key = key * int(radix[k]) + int(digits[k])
    return key


@law
def rehash(keys, values, visits, new_keys, new_values, new_visits):
    """Move all rows into larger arrays, which are empty."""
    for row in range(keys.shape[0]):
        if int(keys[row]) != EMPTY:
            slot = slot_of(new_keys, int(keys[row]))
            new_keys[slot] = keys[row]
            for a in range(values.shape[1]):
                new_values[slot, a] = values[row, a]
                new_visits[slot, a] = visits[row, a]


_TABLE = "i8[::1], f8[:,::1], i8[:,::1]"
move_rows = kernel(f"void({_TABLE}, {_TABLE})")(rehash)
