# SPDX-License-Identifier: BSD-3-Clause
"""What the modes need once, at boot, on a record of zeros with parameters set."""

from __future__ import annotations

from ....core.kernels import law
from .. import pilot
from .numbers import INITIALISING, REASON_INITIALISED, is_known


@law
def init(v):
    """Disarmed, in INITIAL_MODE."""
    ap = v.autopilot
    number = int(ap.params.INITIAL_MODE)
    ap.modes.number = number if is_known(number) else INITIALISING
    ap.modes.previous = INITIALISING
    ap.modes.reason = REASON_INITIALISED
    ap.arming.landed = 1
    ap.battery.remaining_pct = -1.0
    pilot.init(v)
