# SPDX-License-Identifier: BSD-3-Clause
"""Arming and disarming: who may, when, and what follows."""

from __future__ import annotations

from typing import Any

from ...core.kernels import law
from .. import home
from ..arming_checks import BY_DELAY, BY_MAVLINK, BY_RUDDER, TEXTS, texts
from ..events import ARMED, ARMING_REFUSED, emit
from .arming_checks import MANDATORY, check, check_now
from .control.motors import ARMING_DELAY_US
from .modes import ground
from .modes.table import has_manual_throttle

__all__ = ["TEXTS", "arm", "check", "disarm", "texts", "try_arm"]


@law
def update(v):
    """Keep ``arming.prearm_ok`` up to date; called four times a second."""
    failed = check(v)
    v.autopilot.arming.prearm_ok = 1 if failed == 0 else 0


@law
def try_arm(v, method, force):
    """Arm unless checks fail. Returns the bits of the failed ones, 0 when armed (or armed already)."""
    ap = v.autopilot
    if ap.arming.armed != 0:
        return 0
    failed = check_now(v, method)
    if (force == 0 and failed != 0) or (failed & MANDATORY) != 0:
        emit(ap.events, v.time_us, ARMING_REFUSED, float(failed), float(method))
        return failed
    if ap.home.locked == 0:
        home.set_here(v.autopilot.home, v.autopilot.estimate)
    ap.arming.armed = 1
    ap.arming.armed_us = v.time_us
    ap.arming.auto_armed = 0
    ap.arming.landed = 1
    ap.arming.landed_maybe = 1
    ap.arming.landed_ticks = 0
    ap.arming.idle_us = v.time_us
    ap.arming.crash_ticks = 0
    ap.modes.arming_delay = 1
    ap.modes.takeoff.user_active = 0
    emit(ap.events, v.time_us, ARMED, float(method), 0.0)
    return 0


@law
def may_disarm(v, method):
    """Whether ``method`` may disarm now: in flight neither by command nor, but in STABILIZE, by stick."""
    ap = v.autopilot
    if method == BY_MAVLINK:
        return ap.arming.landed != 0
    if method == BY_RUDDER:
        return ap.arming.landed != 0 or has_manual_throttle(int(ap.modes.number))
    return True


@law
def disarm(v, method, force):
    """Disarm. Returns 1 when disarmed (or disarmed already), 0 when refused."""
    ap = v.autopilot
    if ap.arming.armed == 0:
        return 1
    if force == 0 and not may_disarm(v, method):
        return 0
    ground.disarm(v, method)
    return 1


@law
def update_armed(v):
    """Every tick: end of the arming delay, and whether the vehicle was told to fly since arming."""
    ap = v.autopilot
    arming = ap.arming
    if arming.armed == 0:
        arming.auto_armed = 0
        return
    if ap.modes.arming_delay != 0 and v.time_us - arming.armed_us >= ARMING_DELAY_US:
        ap.modes.arming_delay = 0
    throttle_zero = ap.modes.pilot.throttle_zero != 0
    if arming.auto_armed == 0:
        if not throttle_zero:
            arming.auto_armed = 1
    elif has_manual_throttle(int(ap.modes.number)) and throttle_zero and ap.modes.failsafe.radio == 0:
        arming.auto_armed = 0


@law
def update_delay(v):
    """Disarm what was armed on the ground and left alone for DISARM_DELAY; called ten times a second."""
    ap = v.autopilot
    delay = ap.params.DISARM_DELAY
    idle = ap.arming.landed != 0 and ap.modes.pilot.throttle_zero != 0 and ap.control.motors.spool_state <= 1
    if ap.arming.armed == 0 or delay <= 0.0 or not idle:
        ap.arming.idle_us = v.time_us
    elif v.time_us - ap.arming.idle_us >= delay * 1e6:
        disarm(v, BY_DELAY, 0)


def arm(v: Any, method: int, force: bool) -> tuple[bool, list[str]]:
    """Arm from the shell: whether it worked, and the texts for the user when it did not."""
    failed = try_arm(v, method, 1 if force else 0)
    if v.autopilot.arming.armed:
        return True, []
    first = failed & MANDATORY if force else 0
    return False, texts(first, "Arm: ") + texts(failed & ~first, "Arm: ")
