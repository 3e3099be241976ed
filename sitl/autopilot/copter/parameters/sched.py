# SPDX-License-Identifier: BSD-3-Clause
"""The main loop."""

from __future__ import annotations

from ...params.parameter import INT16, Parameter

PARAMETERS = (
    Parameter(
        "SCHED_LOOP_RATE",
        400.0,
        400.0,
        400.0,
        "Hz",
        "Rate of the main loop; this firmware runs at 400 Hz only",
        INT16,
    ),
)
