# SPDX-License-Identifier: BSD-3-Clause
"""Pivot turns: a skid-steered vehicle stops and turns on the spot before a leg in another direction.

WP_PIVOT_ANGLE, WP_PIVOT_RATE, WP_PIVOT_DELAY (https://ardupilot.org/rover/docs/rover-pivot-turns.html).
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.scalars import wrap_pi
from ..control.motors import is_skid
from ..control.steering import turn_rate_from_heading

ACCURACY = 5.0
"""The turn is over this near to the wanted heading [deg]; WP_PIVOT_ANGLE up to it means no pivot turns."""
LONGEST_DELAY = 60.0
"""[s]"""


@law
def is_possible(ap):
    """Whether the vehicle turns on the spot at all."""
    return is_skid(ap) and ap.params.WP.PIVOT_ANGLE > ACCURACY


@law
def is_active(ap):
    """Whether such a turn is under way."""
    return ap.modes.nav.drive.pivoting != 0 and is_skid(ap)


@law
def begin(ap):
    """Turn from now on."""
    ap.modes.nav.drive.pivoting = 1
    ap.modes.nav.drive.pivot_us = 0


@law
def end(ap):
    """No turn is under way."""
    ap.modes.nav.drive.pivoting = 0
    ap.modes.nav.drive.pivot_us = 0


@law
def would_turn(ap, change):
    """Whether a change of direction [rad] is worth a pivot turn."""
    return is_possible(ap) and abs(wrap_pi(change)) > math.radians(ap.params.WP.PIVOT_ANGLE)


@law
def check(ap, time_us, heading, anyway):
    """Begin the turn to ``heading`` [rad] when it is far away (or ``anyway``), end it when that is reached."""
    drive = ap.modes.nav.drive
    if not is_possible(ap):
        drive.pivoting = 0
        return
    error = abs(wrap_pi(heading - float(ap.estimate.euler[2])))
    if anyway or would_turn(ap, error):
        begin(ap)
        return
    if drive.pivoting != 0 and drive.pivot_us == 0 and error < math.radians(ACCURACY):
        drive.pivot_us = time_us
    delay = min(max(float(ap.params.WP.PIVOT_DELAY), 0.0), LONGEST_DELAY)
    if drive.pivot_us > 0 and time_us - drive.pivot_us >= delay * 1e6:
        end(ap)


@law
def turn_rate(ap, time_us, heading):
    """Turn rate [rad/s] of this period."""
    rate = turn_rate_from_heading(ap, heading, math.radians(float(ap.params.WP.PIVOT_RATE)))
    check(ap, time_us, heading, False)
    return rate
