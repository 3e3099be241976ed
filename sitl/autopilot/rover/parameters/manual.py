# SPDX-License-Identifier: BSD-3-Clause
"""MANUAL."""

from __future__ import annotations

from ...params.parameter import INT32, Parameter

PARAMETERS = (
    Parameter("MANUAL_OPTIONS", 0, 0, 1, "", "1: steering shrinks with speed, as in the other modes", INT32),
    Parameter("MANUAL_STR_EXPO", 0.0, -0.5, 0.95, "", "Softness of the steering stick around its middle"),
)
