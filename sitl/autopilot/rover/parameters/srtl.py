# SPDX-License-Identifier: BSD-3-Clause
"""SMART_RTL's path."""

from __future__ import annotations

from ...params.parameter import INT16, Parameter

PARAMETERS = (
    Parameter("SRTL_ACCURACY", 2.0, 0.0, 10.0, "m", "Least distance of two points on the path"),
    Parameter("SRTL_POINTS", 300, 0, 500, "", "Most points on the path; 0: no path is kept", INT16),
)
