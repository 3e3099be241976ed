# SPDX-License-Identifier: BSD-3-Clause
"""What becomes of a set-point or a command to the mode under way."""

from __future__ import annotations

from enum import IntEnum


class CommandResult(IntEnum):
    """OK, or why it changed nothing. Commands are acknowledged by what the bridge makes of it, set-points are not."""

    OK = 0
    NOT_FINITE = 1
    """A number is NaN, infinite or so large that arithmetic with it would be."""
    WRONG_MODE = 2
    OUT_OF_RANGE = 3
    NOT_ARMED = 4
    ALREADY_FLYING = 5
    TOO_LOW = 6
    BEYOND_FENCE = 7
    NOT_ON_A_PATH = 8
    NO_GROUND = 9
    """Its height is above the ground, of which nothing is known."""
