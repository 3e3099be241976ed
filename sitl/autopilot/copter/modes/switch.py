# SPDX-License-Identifier: BSD-3-Clause
"""What the pilot's transmitter commands: switches, and arming with the yaw stick."""

from __future__ import annotations

from ....core.kernels import law
from ... import aux_switch
from ...arming_checks import ArmingMethod
from ...mode_switch import is_rudder_held, moved_to, rudder_command
from ...modes import ModeReason, ModeResult
from .. import arming
from ..state import Vehicle
from . import simple
from .set_mode import request


@law
def read_switches(v: Vehicle) -> None:
    """After each frame: a new position of the mode switch changes the mode, other switches are the shell's."""
    ap = v.autopilot
    if ap.modes.failsafe.radio:
        return
    now = moved_to(ap.modes.pilot, ap.rc, int(ap.params.FLTMODE_CH), v.time_us)
    if now >= 0 and request(v, int(ap.params.FLTMODE[now]), ModeReason.RC) == ModeResult.ACCEPTED:
        simple.follow_mode_switch(v, now)
    aux_switch.watch(ap.rc, ap.arming, ap.events, v.time_us, ap.params)


@law
def read_rudder(v: Vehicle) -> None:
    """After each frame: yaw right arms, yaw left disarms (ARMING_RUDDER), with the throttle closed."""
    ap = v.autopilot
    pilot = ap.modes.pilot
    if abs(pilot.yaw) < 0.5:
        pilot.rudder_done = False
    command = 0
    if pilot.throttle <= 0.0 and ap.rc.receiver_ok and not pilot.rudder_done:
        command = rudder_command(pilot.yaw, ap.arming.armed, ap.params.ARMING.RUDDER)
    if is_rudder_held(pilot, command, v.time_us):
        pilot.rudder_done = True
        if command > 0:
            arming.try_arm(v, ArmingMethod.RUDDER, False)
        else:
            arming.disarm(v, ArmingMethod.RUDDER, False)
