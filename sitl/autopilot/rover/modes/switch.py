# SPDX-License-Identifier: BSD-3-Clause
"""What the pilot's transmitter commands: the mode switch, and arming with the steering stick."""

from __future__ import annotations

from ....core.kernels import law
from ...arming_checks import BY_RUDDER
from ...mode_switch import moved_to
from ...modes import REASON_RC
from .. import arming
from ..control.motors import is_moving
from ..state import Autopilot, Vehicle
from .set_mode import request
from .table import allows_arming_by_stick

HELD_US = 2_000_000
"""The steering stick arms (right) or disarms (left) when held for so long with the throttle at rest."""
FULL_STICK = 4000.0 / 4500.0


@law
def read_mode(v: Vehicle) -> None:
    """After each frame: a new position of the switch changes the mode."""
    ap = v.autopilot
    if ap.modes.failsafe.radio:
        return
    now = moved_to(ap.modes.pilot, ap.rc, int(ap.params.MODE_CH), v.time_us)
    if now >= 0:
        request(v, int(ap.params.MODE[now]), REASON_RC)


@law
def rudder_command(ap: Autopilot) -> int:
    """What the steering stick asks for: 1 to arm, -1 to disarm, 0 nothing (ARMING_RUDDER)."""
    pilot = ap.modes.pilot
    if ap.params.ARMING.RUDDER < 1.0 or not allows_arming_by_stick(ap.modes.number):
        return 0
    if pilot.throttle != 0.0 or not ap.rc.receiver_ok or ap.modes.failsafe.radio:
        return 0
    if pilot.steering > FULL_STICK and not ap.arming.armed:
        return 1
    if pilot.steering < -FULL_STICK and ap.arming.armed and ap.params.ARMING.RUDDER >= 2.0 and not is_moving(ap):
        return -1
    return 0


@law
def read_rudder(v: Vehicle) -> None:
    """After each frame: steering right arms, left disarms."""
    pilot = v.autopilot.modes.pilot
    wanted = rudder_command(v.autopilot)
    if wanted == 0:
        pilot.rudder_us = 0
    elif pilot.rudder_us == 0:
        pilot.rudder_us = v.time_us
    elif v.time_us - pilot.rudder_us >= HELD_US:
        pilot.rudder_us = 0
        if wanted > 0:
            arming.try_arm(v, BY_RUDDER, False)
        else:
            arming.disarm(v, BY_RUDDER, False)
