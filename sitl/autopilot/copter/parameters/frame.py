# SPDX-License-Identifier: BSD-3-Clause
"""Arrangement of the motors."""

from __future__ import annotations

from ...params.parameter import INT8, Parameter

PARAMETERS = (
    Parameter("FRAME_TYPE", 1, 0, 18, "", "0: plus, 1: X", INT8),
    Parameter("FRAME_CLASS", 0, 0, 18, "", "1: quad; 0: not chosen yet", INT8),
)
