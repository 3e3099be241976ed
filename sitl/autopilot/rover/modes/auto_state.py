# SPDX-License-Identifier: BSD-3-Clause
"""What AUTO is doing (``modes.auto.submode``)."""

from __future__ import annotations

from ....core.kernels import law

STOP = 0
WAYPOINT = 1
HEADING_AND_SPEED = 2
RTL = 3
LOITER = 4
GUIDED = 5
CIRCLE = 6


@law
def is_guided(ap):
    """Whether AUTO drives what set-points say."""
    return ap.modes.auto.submode == GUIDED
