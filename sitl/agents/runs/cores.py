# SPDX-License-Identifier: BSD-3-Clause
"""How many cores of this machine a run may use: those that there are, shared with the runs beside it."""

from __future__ import annotations

import os

_sharing = 1


def share_among(runs: int) -> None:
    """From now on, this process is one of so many that work side by side."""
    global _sharing
    _sharing = runs


def mine() -> int:
    """Number of cores for this process, at least 1."""
    return max(count() // _sharing, 1)


def count() -> int:
    """Number of cores that this process may run on."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
