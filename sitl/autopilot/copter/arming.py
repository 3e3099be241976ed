# SPDX-License-Identifier: BSD-3-Clause
"""Arming and disarming: who may, when, and what follows."""

from __future__ import annotations

from ...core.kernels import law
from .. import home
from ..arming_checks import BY_DELAY, BY_MAVLINK, BY_RUDDER, TEXTS, texts
from ..events import ARMED, ARMING_REFUSED, emit
from .arming_checks import MANDATORY, check, check_now
from .control.motors import ARMING_DELAY_US
from .modes import ground
from .modes.table import has_manual_throttle
from .state import Autopilot, Vehicle

__all__ = ["TEXTS", "arm", "check", "disarm", "texts", "try_arm"]


@law
def run_prearm_checks(v: Vehicle) -> None:
    """Keep ``arming.prearm_ok`` up to date; called four times a second."""
    v.autopilot.arming.prearm_ok = check(v) == 0


@law
def try_arm(v: Vehicle, method: int, force: bool) -> int:
    """Arm unless checks fail. Returns the bits of the failed ones, 0 when armed (or armed already)."""
    ap = v.autopilot
    arming = ap.arming
    if arming.armed:
        return 0
    failed = check_now(v, method)
    if (not force and failed != 0) or (failed & MANDATORY) != 0:
        emit(ap.events, v.time_us, ARMING_REFUSED, float(failed), float(method))
        return failed
    if not ap.home.locked:
        home.set_here(ap.home, ap.estimate)
    arming.armed = True
    arming.armed_us = v.time_us
    arming.auto_armed = False
    ground.set_landed(arming, True)
    arming.idle_us = v.time_us
    arming.crash_ticks = 0
    ap.modes.arming_delay = True
    ap.modes.takeoff.user_active = False
    emit(ap.events, v.time_us, ARMED, float(method), 0.0)
    return 0


@law
def may_disarm(ap: Autopilot, method: int) -> bool:
    """Whether ``method`` may disarm now: in flight neither by command nor, but in STABILIZE, by stick."""
    if method == BY_MAVLINK:
        return ap.arming.landed
    if method == BY_RUDDER:
        return ap.arming.landed or has_manual_throttle(ap.modes.number)
    return True


@law
def disarm(v: Vehicle, method: int, force: bool) -> bool:
    """Disarm, unless ``method`` may not; whether the vehicle is disarmed."""
    ap = v.autopilot
    if ap.arming.armed and (force or may_disarm(ap, method)):
        ground.disarm(v, method)
    return not ap.arming.armed


@law
def follow_throttle(v: Vehicle) -> None:
    """Every tick: end of the arming delay, and whether the vehicle was told to fly since arming."""
    ap = v.autopilot
    arming = ap.arming
    if not arming.armed:
        arming.auto_armed = False
        return
    if ap.modes.arming_delay and v.time_us - arming.armed_us >= ARMING_DELAY_US:
        ap.modes.arming_delay = False
    throttle_zero = ap.modes.pilot.throttle_zero
    if not arming.auto_armed:
        if not throttle_zero:
            arming.auto_armed = True
    elif has_manual_throttle(ap.modes.number) and throttle_zero and not ap.modes.failsafe.radio:
        arming.auto_armed = False


@law
def disarm_idle(v: Vehicle) -> None:
    """Disarm what was armed on the ground and left alone for DISARM_DELAY; called ten times a second."""
    ap = v.autopilot
    delay = ap.params.DISARM_DELAY
    idle = ap.arming.landed and ap.modes.pilot.throttle_zero and ap.control.motors.spool_state <= ground.IS_GROUND_IDLE
    if not ap.arming.armed or delay <= 0.0 or not idle:
        ap.arming.idle_us = v.time_us
    elif v.time_us - ap.arming.idle_us >= delay * 1e6:
        ground.disarm(v, BY_DELAY)


def arm(v: Vehicle, method: int, force: bool) -> tuple[bool, list[str]]:
    """Arm from the shell: whether it worked, and the texts for the user when it did not."""
    failed = try_arm(v, method, force)
    if v.autopilot.arming.armed:
        return True, []
    first = failed & MANDATORY if force else 0
    return False, texts(first, "Arm: ") + texts(failed & ~first, "Arm: ")
