# SPDX-License-Identifier: BSD-3-Clause
"""One tick of the simulated world: 400 Hz."""

from __future__ import annotations

from typing import NamedTuple


class Clock(NamedTuple):
    """When it is."""

    tick: int  # since boot
    time_us: int  # since boot
