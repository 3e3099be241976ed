# SPDX-License-Identifier: BSD-3-Clause
"""Arming and disarming: who may, when, and what follows. A driving rover may be disarmed."""

from __future__ import annotations

from typing import Any

from ...core.kernels import law
from ..arming_checks import BY_RUDDER, TEXTS, texts
from ..events import ARMED, ARMING_REFUSED, DISARMED, emit, emit_and_return
from . import smart_rtl_path
from .arming_checks import check, check_now
from .control.motors import is_moving
from .modes.simple import note_heading

__all__ = ["TEXTS", "arm", "check", "disarm", "texts", "try_arm"]


@law
def update(v):
    """Keep ``arming.prearm_ok`` up to date; called four times a second."""
    v.autopilot.arming.prearm_ok = 1 if v.autopilot.arming.armed != 0 or check(v) == 0 else 0


@law
def try_arm(v, method, force):
    """Arm unless checks fail. Returns the bits of the failed ones, 0 when armed (or armed already)."""
    ap = v.autopilot
    if ap.arming.armed != 0:
        return 0
    failed = 0 if force != 0 else check_now(v, method)
    if failed != 0:
        emit(ap.events, v.time_us, ARMING_REFUSED, float(failed), float(method))
        return failed
    ap.arming.armed = 1
    ap.arming.armed_us = v.time_us
    ap.arming.auto_armed = 1
    ap.arming.landed = 0
    ap.arming.crash_ticks = 0
    smart_rtl_path.set_home(v)
    note_heading(ap)
    emit(ap.events, v.time_us, ARMED, float(method), 0.0)
    return 0


@law
def disarm(v, method, force):
    """Disarm. Returns 1 when disarmed (or disarmed already), 0 when refused: by stick while the motors turn."""
    ap = v.autopilot
    if ap.arming.armed == 0:
        return 1
    if force == 0 and method == BY_RUDDER and is_moving(ap):
        return 0
    ap.arming.armed = 0
    ap.arming.auto_armed = 0
    ap.arming.landed = 1
    ap.arming.crash_ticks = 0
    emit_and_return(ap.events, v.time_us, DISARMED, float(method), 0.0)  # the mission goes back to its start
    return 1


def arm(v: Any, method: int, force: bool) -> tuple[bool, list[str]]:
    """Arm from the shell: whether it worked, and the texts for the user when it did not."""
    failed = try_arm(v, method, 1 if force else 0)
    return bool(v.autopilot.arming.armed), texts(failed, "Arm: ")
