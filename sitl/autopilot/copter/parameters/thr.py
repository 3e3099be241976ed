# SPDX-License-Identifier: BSD-3-Clause
"""Throttle stick."""

from __future__ import annotations

from ...params.parameter import INT16, Parameter

PARAMETERS = (
    Parameter(
        "THR_DZ",
        100,
        0,
        300,
        "us",
        "Half of the dead zone around the middle, in thousandths of the stick, in modes that hold height",
        INT16,
    ),
)
