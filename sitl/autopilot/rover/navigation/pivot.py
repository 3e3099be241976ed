# SPDX-License-Identifier: BSD-3-Clause
"""Pivot turns: a skid-steered vehicle stops and turns on the spot before a leg in another direction.

WP_PIVOT_ANGLE, WP_PIVOT_RATE, WP_PIVOT_DELAY (https://ardupilot.org/rover/docs/rover-pivot-turns.html).
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.scalars import wrap_pi
from ..control.motors import is_skid
from ..parameters import Parameters
from .state import DriveState

ACCURACY = 5.0
"""The turn is over this near to the wanted heading [deg]; WP_PIVOT_ANGLE up to it means no pivot turns."""
DELAY_MAX = 60.0
"""[s]"""


@law
def is_possible(params: Parameters) -> bool:
    """Whether the vehicle turns on the spot at all."""
    return is_skid(params) and params.WP.PIVOT_ANGLE > ACCURACY


@law
def is_active(drive: DriveState, params: Parameters) -> bool:
    """Whether such a turn is under way."""
    return drive.pivoting and is_skid(params)


@law
def begin(drive: DriveState) -> None:
    """Turn from now on."""
    drive.pivoting = True
    drive.pivot_us = 0


@law
def end(drive: DriveState) -> None:
    """No turn is under way."""
    drive.pivoting = False
    drive.pivot_us = 0


@law
def would_turn(change: float, params: Parameters) -> bool:
    """Whether a change of direction [rad] is worth a pivot turn."""
    return is_possible(params) and abs(wrap_pi(change)) > math.radians(params.WP.PIVOT_ANGLE)


@law
def check(drive: DriveState, time_us: int, change: float, anyway: bool, params: Parameters) -> None:
    """Begin the turn when the heading must ``change`` [rad] much (or ``anyway``), end it when it points there."""
    if not is_possible(params):
        drive.pivoting = False
        return
    error = abs(wrap_pi(change))
    if anyway or would_turn(error, params):
        begin(drive)
        return
    if drive.pivoting and drive.pivot_us == 0 and error < math.radians(ACCURACY):
        drive.pivot_us = time_us
    delay = min(max(params.WP.PIVOT_DELAY, 0.0), DELAY_MAX)
    if drive.pivot_us > 0 and time_us - drive.pivot_us >= delay * 1e6:
        end(drive)
