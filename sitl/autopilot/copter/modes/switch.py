# SPDX-License-Identifier: BSD-3-Clause
"""What the pilot's transmitter commands: the mode switch, and arming with the yaw stick."""

from __future__ import annotations

from ....core.kernels import law
from ... import arming
from .numbers import REASON_RC
from .set_mode import request

DEBOUNCE_US = 200_000
RUDDER_US = 2_000_000
"""The yaw stick arms or disarms when held for so long with the throttle closed."""
_FULL_STICK = 4000.0 / 4500.0


@law
def position(pulse):
    """Position 0 .. 5 of the mode channel, -1 for a pulse that means nothing."""
    if pulse <= 900 or pulse >= 2200:
        return -1
    if pulse < 1231:
        return 0
    if pulse < 1361:
        return 1
    if pulse < 1491:
        return 2
    if pulse < 1621:
        return 3
    if pulse < 1750:
        return 4
    return 5


@law
def mode_at(p, k):
    """FLTMODE of position ``k``."""
    if k == 0:
        return int(p.FLTMODE1)
    if k == 1:
        return int(p.FLTMODE2)
    if k == 2:
        return int(p.FLTMODE3)
    if k == 3:
        return int(p.FLTMODE4)
    if k == 4:
        return int(p.FLTMODE5)
    return int(p.FLTMODE6)


@law
def read_mode(v):
    """After each frame: a new position that lasts changes the mode; an old one changes nothing."""
    ap = v.autopilot
    pilot = ap.modes.pilot
    channel = int(ap.params.FLTMODE_CH)
    if channel < 1 or ap.rc.receiver_ok == 0 or ap.modes.failsafe.radio != 0:
        return
    now = position(int(ap.rc.channels[channel - 1]))
    if now < 0:
        return
    if now != pilot.switch_candidate:
        pilot.switch_candidate = now
        pilot.switch_us = v.time_us
    elif now != pilot.switch_position and v.time_us - pilot.switch_us >= DEBOUNCE_US:
        pilot.switch_position = now
        request(v, mode_at(ap.params, now), REASON_RC)


@law
def read_rudder(v):
    """After each frame: yaw right arms, yaw left disarms (ARMING_RUDDER)."""
    ap = v.autopilot
    pilot = ap.modes.pilot
    wanted = 0
    if ap.params.ARMING_RUDDER >= 1.0 and pilot.throttle <= 0.0 and ap.rc.receiver_ok != 0:
        if pilot.yaw > _FULL_STICK and ap.arming.armed == 0:
            wanted = 1
        elif pilot.yaw < -_FULL_STICK and ap.arming.armed != 0 and ap.params.ARMING_RUDDER >= 2.0:
            wanted = -1
    if abs(pilot.yaw) < 0.5:
        pilot.rudder_done = 0
    if wanted == 0 or pilot.rudder_done != 0:
        pilot.rudder_us = 0
        return
    if pilot.rudder_us == 0:
        pilot.rudder_us = v.time_us
    elif v.time_us - pilot.rudder_us >= RUDDER_US:
        pilot.rudder_done = 1
        if wanted > 0:
            arming.try_arm(v, arming.BY_RUDDER, 0)
        else:
            arming.disarm(v, arming.BY_RUDDER, 0)
