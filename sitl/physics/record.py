# SPDX-License-Identifier: BSD-3-Clause
"""Where a field of a vehicle's record is, for engines that write many at once."""

from __future__ import annotations

from typing import Any


def offset(dtype: Any, *path: str) -> int:
    """Of a field within a record [bytes]."""
    place = 0
    for name in path:
        dtype, more = dtype.fields[name][:2]
        place += more
    return place
