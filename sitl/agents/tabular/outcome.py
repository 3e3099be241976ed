# SPDX-License-Identifier: BSD-3-Clause
"""What came of an episode."""

from __future__ import annotations

from typing import NamedTuple


class Outcome(NamedTuple):
    """Result of one episode."""

    steps: int
    reward: float
    """Sum."""
    terminated: bool
    """The episode ended by itself (a crash, in the paper's environments), not by the limit of steps."""
