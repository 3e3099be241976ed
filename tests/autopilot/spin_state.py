# SPDX-License-Identifier: BSD-3-Clause
"""What the mode SPIN of another package remembers."""

from __future__ import annotations

from sitl.core.records import Record


class SpinState(Record):
    """SPIN."""

    turned: float  # so far [rad]
