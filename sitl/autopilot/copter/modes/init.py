# SPDX-License-Identifier: BSD-3-Clause
"""What the modes need once, at boot, on a record of zeros with parameters set."""

from __future__ import annotations

from ....core.kernels import law
from .. import pilot
from .numbers import REASON_INITIALISED, STABILIZE, is_known


@law
def init(v):
    """On the ground, disarmed, in INITIAL_MODE."""
    ap = v.autopilot
    number = int(ap.params.INITIAL_MODE)
    ap.modes.number = number if is_known(number) else STABILIZE
    ap.modes.previous = ap.modes.number
    ap.modes.reason = REASON_INITIALISED
    ap.arming.landed = 1
    ap.arming.landed_maybe = 1
    ap.battery.remaining_pct = -1.0
    pilot.init(v)
