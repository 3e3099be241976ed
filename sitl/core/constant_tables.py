# SPDX-License-Identifier: BSD-3-Clause
"""Numbers that laws look up: a function of the row, which Numba makes a load from constant memory
(``numba_constant_tables.py``). A tuple would become a jump for each row."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

Number = TypeVar("Number", int, float)
TABLES: dict[Callable[[int], int | float], tuple[int | float, ...]] = {}
"""The functions, and what each looks up."""


def constant_table(*numbers: Number) -> Callable[[int], Number]:
    """A function for laws: the number of row ``k``, from 0; the caller keeps ``k`` within the table."""

    def row(k: int) -> Number:
        return numbers[k]

    TABLES[row] = numbers
    return row
