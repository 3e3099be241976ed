# SPDX-License-Identifier: BSD-3-Clause
"""LAND."""

from __future__ import annotations

from ...params.parameter import INT8, INT16, Parameter

PARAMETERS = (
    Parameter("LAND_SPEED", 50, 10, 500, "cm/s", "Last part of the descent", INT16),
    Parameter("LAND_SPEED_HIGH", 0, 0, 1000, "cm/s", "Descent above LAND_ALT_LOW; 0 as WPNAV_SPEED_DN", INT16),
    Parameter("LAND_ALT_LOW", 1000, 100, 10000, "cm", "Height where the descent slows down to LAND_SPEED", INT16),
    Parameter("LAND_REPOSITION", 1, 0, 1, "", "The pilot may move the landing place", INT8),
)
