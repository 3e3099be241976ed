# SPDX-License-Identifier: BSD-3-Clause
"""The main loop."""

from __future__ import annotations

from ...params.parameter import INT16, Parameter

PARAMETERS = (
    Parameter("SCHED_LOOP_RATE", 50, 50, 50, "Hz", "Rate of the main loop; this firmware runs at 50 Hz only", INT16),
)
