# SPDX-License-Identifier: BSD-3-Clause
"""Arming and disarming: who may, when, and what follows. A driving rover may be disarmed."""

from __future__ import annotations

from ...core.kernels import law
from ..arming_checks import BY_RUDDER, TEXTS, texts
from ..events import ARMED, ARMING_REFUSED, DISARMED, emit, emit_and_return
from . import smart_rtl_path
from .arming_checks import check, check_now
from .control.motors import is_moving
from .modes.simple import note_heading
from .state import Vehicle

__all__ = ["TEXTS", "arm", "check", "disarm", "texts", "try_arm"]


@law
def update(v: Vehicle) -> None:
    """Keep ``arming.prearm_ok`` up to date; called four times a second."""
    v.autopilot.arming.prearm_ok = v.autopilot.arming.armed or check(v) == 0


@law
def try_arm(v: Vehicle, method: int, force: bool) -> int:
    """Arm unless checks fail. Returns the bits of the failed ones, 0 when armed (or armed already)."""
    ap = v.autopilot
    if ap.arming.armed:
        return 0
    failed = 0 if force else check_now(v, method)
    if failed != 0:
        emit(ap.events, v.time_us, ARMING_REFUSED, float(failed), float(method))
        return failed
    ap.arming.armed = True
    ap.arming.armed_us = v.time_us
    ap.arming.auto_armed = True
    ap.arming.landed = False
    ap.arming.crash_ticks = 0
    smart_rtl_path.set_home(v)
    note_heading(ap.modes.simple, ap.estimate.euler.yaw)
    emit(ap.events, v.time_us, ARMED, float(method), 0.0)
    return 0


@law
def disarm(v: Vehicle, method: int, force: bool) -> bool:
    """Disarm. Whether it is disarmed (or was already); not by stick while the motors turn."""
    ap = v.autopilot
    if not ap.arming.armed:
        return True
    if not force and method == BY_RUDDER and is_moving(ap):
        return False
    ap.arming.armed = False
    ap.arming.auto_armed = False
    ap.arming.landed = True
    ap.arming.crash_ticks = 0
    emit_and_return(ap.events, v.time_us, DISARMED, float(method), 0.0)  # the mission goes back to its start
    return True


def arm(v: Vehicle, method: int, force: bool) -> tuple[bool, list[str]]:
    """Arm from the shell: whether it worked, and the texts for the user when it did not."""
    failed = try_arm(v, method, force)
    return v.autopilot.arming.armed, texts(failed, "Arm: ")
