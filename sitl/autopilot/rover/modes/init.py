# SPDX-License-Identifier: BSD-3-Clause
"""What the modes need once, at boot, on a record of zeros with parameters set."""

from __future__ import annotations

from ....core.kernels import law
from .. import pilot
from .numbers import ACCEPTED, INITIALISING, REASON_INITIALISED, is_known
from .set_mode import enter


@law
def init(v):
    """Disarmed, in INITIAL_MODE; INITIALISING when that needs what is not known yet (a place, home, a mission)."""
    ap = v.autopilot
    number = int(ap.params.INITIAL_MODE)
    ap.modes.number = number if is_known(number) and enter(v, number) == ACCEPTED else INITIALISING
    ap.modes.previous = INITIALISING
    ap.modes.reason = REASON_INITIALISED
    ap.arming.landed = 1
    ap.battery.remaining_pct = -1.0
    pilot.init(v)
