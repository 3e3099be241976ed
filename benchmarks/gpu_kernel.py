# SPDX-License-Identifier: BSD-3-Clause
"""The kernel that a GPU runs: one thread a vehicle. Importing this module needs Numba."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba import cuda


def kernel(unit: Callable[..., None]) -> Callable[..., None]:
    """``kernel(fleet, ticks)`` that calls ``unit(fleet, index, ticks)`` for each vehicle."""

    def advance_each(fleet: Any, ticks: int) -> None:
        index = cuda.grid(1)
        if index < len(fleet):
            unit(fleet, index, ticks)

    return advance_each
