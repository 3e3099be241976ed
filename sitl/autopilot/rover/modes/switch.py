# SPDX-License-Identifier: BSD-3-Clause
"""What the pilot's transmitter commands: the mode switch, and arming with the steering stick."""

from __future__ import annotations

from ....core.kernels import law
from ...arming_checks import BY_RUDDER
from ...mode_switch import moved_to
from .. import arming
from ..control.motors import is_moving
from .numbers import REASON_RC, allows_arming_by_stick
from .set_mode import request

HELD_US = 2_000_000
"""The steering stick arms (right) or disarms (left) when held for so long with the throttle at rest."""
_FULL_STICK = 4000.0 / 4500.0


@law
def read_mode(v):
    """After each frame: a new position of the switch changes the mode."""
    ap = v.autopilot
    if ap.modes.failsafe.radio:
        return
    now = moved_to(ap.modes.pilot, ap.rc, int(ap.params.MODE_CH), v.time_us)
    if now >= 0:
        request(v, int(ap.params.MODE[now]), REASON_RC)


@law
def read_rudder(v):
    """After each frame: steering right arms, left disarms (ARMING_RUDDER)."""
    ap = v.autopilot
    pilot = ap.modes.pilot
    wanted = 0
    allowed = ap.params.ARMING.RUDDER >= 1.0 and allows_arming_by_stick(int(ap.modes.number))
    if allowed and pilot.throttle == 0.0 and ap.rc.receiver_ok != 0 and ap.modes.failsafe.radio == 0:
        if pilot.steering > _FULL_STICK and ap.arming.armed == 0:
            wanted = 1
        elif pilot.steering < -_FULL_STICK and ap.arming.armed != 0 and ap.params.ARMING.RUDDER >= 2.0:
            wanted = 0 if is_moving(ap) else -1
    if wanted == 0:
        pilot.rudder_us = 0
    elif pilot.rudder_us == 0:
        pilot.rudder_us = v.time_us
    elif v.time_us - pilot.rudder_us >= HELD_US:
        pilot.rudder_us = 0
        if wanted > 0:
            arming.try_arm(v, BY_RUDDER, 0)
        else:
            arming.disarm(v, BY_RUDDER, 0)
