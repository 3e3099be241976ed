# SPDX-License-Identifier: BSD-3-Clause
"""Neighbouring fields of a vehicle's record, written by one call."""

from __future__ import annotations

import struct
from collections.abc import Callable
from functools import partial

from ..engine import Seat
from ..record import offset


def writer(seat: Seat, path: str, count: int) -> Callable[..., None]:
    """A function of ``count`` numbers that writes them as f8 from the field at ``path`` on."""
    dtype, memory = seat.fleet.dtype, seat.fleet.view("u1").data
    place = seat.index * dtype.itemsize + offset(dtype, *path.split("."))
    return partial(struct.Struct(f"<{count}d").pack_into, memory, place)
