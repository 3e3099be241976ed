# SPDX-License-Identifier: BSD-3-Clause
"""Which channel is which stick."""

from __future__ import annotations

from ..parameter import INT8, Parameter

PARAMETERS = (
    Parameter("RCMAP_ROLL", 1, 1, 8, "", "Channel of the roll stick", INT8),
    Parameter("RCMAP_PITCH", 2, 1, 8, "", "Channel of the pitch stick", INT8),
    Parameter("RCMAP_THROTTLE", 3, 1, 8, "", "Channel of the throttle stick", INT8),
    Parameter("RCMAP_YAW", 4, 1, 8, "", "Channel of the yaw stick", INT8),
)
