# SPDX-License-Identifier: BSD-3-Clause
"""Disarming by itself."""

from __future__ import annotations

from ...params.parameter import INT8, Parameter

PARAMETERS = (
    Parameter(
        "DISARM_DELAY",
        10,
        0,
        127,
        "s",
        "Armed on the ground with the throttle low for so long: disarms; 0 never",
        INT8,
    ),
)
