# SPDX-License-Identifier: BSD-3-Clause
"""Neighbouring fields of a vehicle's record, written by one call."""

from __future__ import annotations

import struct
from collections.abc import Callable
from functools import partial
from typing import Any

from ..engine import Seat


def writer(seat: Seat, path: str, count: int) -> Callable[..., None]:
    """A function of ``count`` numbers that writes them as f8 from the field at ``path`` on."""
    dtype: Any = seat.fleet.dtype
    offset = seat.index * dtype.itemsize
    for name in path.split("."):
        dtype, step = dtype.fields[name][:2]
        offset += step
    memory: Any = seat.fleet.view("u1").data
    return partial(struct.Struct(f"<{count}d").pack_into, memory, offset)
