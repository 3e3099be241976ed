# SPDX-License-Identifier: BSD-3-Clause
"""What the pilot's transmitter commands: the mode switch, and arming with the yaw stick."""

from __future__ import annotations

from ....core.kernels import law
from ...arming_checks import BY_RUDDER
from ...mode_switch import moved_to
from ...modes import REASON_RC
from .. import arming
from ..state import Vehicle
from .set_mode import request

RUDDER_US = 2_000_000
"""The yaw stick arms or disarms when held for so long with the throttle closed."""
_FULL_STICK = 4000.0 / 4500.0


@law
def read_mode(v: Vehicle) -> None:
    """After each frame: a new position of the switch changes the mode."""
    ap = v.autopilot
    if ap.modes.failsafe.radio:
        return
    now = moved_to(ap.modes.pilot, ap.rc, int(ap.params.FLTMODE_CH), v.time_us)
    if now >= 0:
        request(v, int(ap.params.FLTMODE[now]), REASON_RC)


@law
def read_rudder(v: Vehicle) -> None:
    """After each frame: yaw right arms, yaw left disarms (ARMING_RUDDER)."""
    ap = v.autopilot
    pilot = ap.modes.pilot
    wanted = 0
    if ap.params.ARMING.RUDDER >= 1.0 and pilot.throttle <= 0.0 and ap.rc.receiver_ok:
        if pilot.yaw > _FULL_STICK and not ap.arming.armed:
            wanted = 1
        elif pilot.yaw < -_FULL_STICK and ap.arming.armed and ap.params.ARMING.RUDDER >= 2.0:
            wanted = -1
    if abs(pilot.yaw) < 0.5:
        pilot.rudder_done = False
    if wanted == 0 or pilot.rudder_done:
        pilot.rudder_us = 0
        return
    if pilot.rudder_us == 0:
        pilot.rudder_us = v.time_us
    elif v.time_us - pilot.rudder_us >= RUDDER_US:
        pilot.rudder_done = True
        if wanted > 0:
            arming.try_arm(v, BY_RUDDER, False)
        else:
            arming.disarm(v, BY_RUDDER, False)
