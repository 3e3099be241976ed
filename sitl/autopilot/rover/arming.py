# SPDX-License-Identifier: BSD-3-Clause
"""Arming and disarming: who may, when, and what follows. A driving rover may be disarmed."""

from __future__ import annotations

from ...core.algebra import horizontal, with_down
from ...core.kernels import law
from ...core.mavlink import MavSeverity
from .. import arming_checks, smart_rtl_path
from ..arming_checks import ArmingMethod, refuse
from ..events import Events, emit, emit_and_return
from ..mode_switch import rudder_command
from ..state import Arming
from .arming_checks import TEXTS, check, method_checks
from .control.motors import is_moving
from .modes.mode_list import allows_arming_by_stick
from .modes.simple import note_heading
from .modes.state import PilotState
from .state import Vehicle

__all__ = ["arm", "check", "disarm", "texts", "try_arm"]

ARMED = arming_checks.ARMED.saying(MavSeverity.INFO, "Throttle armed")
DISARMED = arming_checks.DISARMED.saying(MavSeverity.INFO, "Throttle disarmed")


@law
def try_arm(v: Vehicle, method: int, force: bool) -> int:
    """Arm unless checks fail. Returns the bits of the failed ones, 0 when armed (or armed already)."""
    ap = v.autopilot
    if ap.arming.armed:
        return 0
    failed = 0
    if not force:
        failed = check(v) | method_checks(ap.modes, ap.rc, method, ap.params, ap.calibrated.state)
    if failed != 0:
        refuse(ap.events, v.time_us, failed, method)
        return failed
    ap.arming.armed = True
    ap.arming.armed_us = v.time_us
    ap.arming.auto_armed = True
    ap.arming.landed = False
    ap.arming.crash_ticks = 0
    pos = with_down(horizontal(ap.estimate.pos), 0.0)
    smart_rtl_path.begin(ap.modes.path, pos, ap.estimate.position_ok, v.time_us, ap.params.SRTL)
    note_heading(ap.modes.simple, ap.estimate.yaw)
    emit(ap.events, v.time_us, ARMED, float(method), 0.0)
    return 0


@law
def set_disarmed(arming: Arming, events: Events, time_us: int, method: int) -> None:
    """Disarm, unless it is disarmed."""
    if arming.armed:
        arming.armed = False
        arming.auto_armed = False
        arming.landed = True
        arming.crash_ticks = 0
        emit_and_return(events, time_us, DISARMED, float(method), 0.0)  # the mission goes back to its start


def disarm(v: Vehicle, method: int, force: bool) -> bool:
    """Disarm from the shell. Whether it is disarmed (or was already); not by stick while the motors turn."""
    ap = v.autopilot
    if not force and method == ArmingMethod.RUDDER and is_moving(ap.control.motors, ap.arming.armed, ap.params):
        return False
    set_disarmed(ap.arming, ap.events, v.time_us, method)
    return True


@law
def stick_command(pilot: PilotState, mode: int, armed: bool, moving: bool, permission: float) -> int:
    """What the steering stick asks for: 1 to arm, -1 to disarm, 0 nothing; with the throttle at rest.

    ``moving``: the motors turn; ``permission``: ARMING_RUDDER.
    """
    if pilot.throttle != 0.0 or pilot.lost or not allows_arming_by_stick(mode):
        return 0
    command = rudder_command(pilot.steering, armed, permission)
    return 0 if command < 0 and moving else command


def arm(v: Vehicle, method: int, force: bool) -> tuple[bool, list[str]]:
    """Arm from the shell: whether it worked, and the texts for the user when it did not."""
    failed = try_arm(v, method, force)
    return v.autopilot.arming.armed, texts(v, failed, "Arm: ")


def texts(v: Vehicle, failed: int, prefix: str) -> list[str]:
    """Status texts of failed checks, each after ``prefix``."""
    own = {**TEXTS, **arming_checks.receiver_texts(v.sensors, v.autopilot.params)}
    return arming_checks.texts(failed, v.autopilot.params, prefix, own)
