# SPDX-License-Identifier: BSD-3-Clause
"""The pilot's sticks."""

from __future__ import annotations

from ...params.parameter import INT8, Parameter

PARAMETERS = (
    Parameter(
        "PILOT_STEER_TYPE",
        0,
        0,
        3,
        "",
        "0, 2: steering turns round in reverse; 1: two paddles; 3: it does not turn round",
        INT8,
    ),
)
