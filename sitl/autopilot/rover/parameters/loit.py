# SPDX-License-Identifier: BSD-3-Clause
"""LOITER."""

from __future__ import annotations

from ...params.parameter import INT8, Parameter

PARAMETERS = (
    Parameter(
        "LOIT_TYPE",
        0,
        0,
        2,
        "",
        "Returns to its place: 0 forwards or backwards, 1 always forwards, 2 always backwards",
        INT8,
    ),
    Parameter("LOIT_RADIUS", 2.0, 0.0, 20.0, "m", "Drifts so far from its place before it returns"),
    Parameter("LOIT_SPEED_GAIN", 0.5, 0.0, 5.0, "1/s", "Speed of the return for each metre beyond LOIT_RADIUS"),
)
