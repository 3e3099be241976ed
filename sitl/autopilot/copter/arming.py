# SPDX-License-Identifier: BSD-3-Clause
"""Arming and disarming: who may, when, and what follows."""

from __future__ import annotations

from ...core.kernels import inlined, law
from ...core.mavlink import MavSeverity
from .. import arming_checks, home, smart_rtl_path
from ..arming_checks import MODE, ArmingMethod, refuse
from ..events import emit
from ..fence.checks import switch_on_arming
from ..state import Arming
from .arming_checks import DOUBTFUL, MANDATORY, TEXTS, arm_checks, check, doubt_text, stick_checks
from .control.motors import ARMING_DELAY_US
from .control.spool import SpoolState
from .modes import ground, simple
from .modes.mode_list import TITLES, has_manual_throttle, idles_armed
from .modes.state import Modes
from .state import Vehicle

__all__ = ["arm", "check", "disarm", "texts", "try_arm"]

ARMED = arming_checks.ARMED.saying(MavSeverity.INFO, "Arming motors")


@law
def try_arm(v: Vehicle, method: int, force: bool) -> int:
    """Arm unless checks fail. Returns the bits of the failed ones, 0 when armed (or armed already)."""
    ap = v.autopilot
    arming = ap.arming
    if arming.armed:
        return 0
    failed = check(v)
    if failed == 0:
        failed = arm_checks(ap.modes, ap.rc, ap.params, method, ap.control.attitude.cos_lean)
    if failed == 0:
        failed = stick_checks(ap.rc, ap.params, method, ap.calibrated.state)
    if (not force and failed != 0) or (failed & MANDATORY) != 0:
        refuse(ap.events, v.time_us, failed, method)
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
    ap.modes.auto_yaw.armed = ap.estimate.yaw
    simple.begin(ap.modes.simple, ap.estimate.yaw)
    smart_rtl_path.begin(ap.modes.path, ap.estimate.pos, ap.estimate.position_ok, v.time_us, ap.params.SRTL)
    ap.modes.takeoff.user_active = False
    emit(ap.events, v.time_us, ARMED, float(method), 0.0)
    switch_on_arming(ap.fence, ap.params.FENCE, int(ap.params.FENCE.AUTOENABLE), ap.events, v.time_us)
    return 0


@law
def may_disarm(landed: bool, mode: int, method: int) -> bool:
    """Whether ``method`` may disarm now: in flight neither by command nor, but in STABILIZE, by stick."""
    if method == ArmingMethod.MAVLINK:
        return landed
    if method == ArmingMethod.RUDDER:
        return landed or has_manual_throttle(mode)
    return True


@law
def disarm(v: Vehicle, method: int, force: bool) -> bool:
    """Disarm, unless ``method`` may not; whether the vehicle is disarmed."""
    ap = v.autopilot
    if ap.arming.armed and (force or may_disarm(ap.arming.landed, ap.modes.number, method)):
        ground.disarm(v, method)
    return not ap.arming.armed


@inlined
def follow_throttle(arming: Arming, modes: Modes, time_us: int) -> None:
    """Every tick: end of the arming delay, and whether the vehicle was told to fly since arming."""
    if not arming.armed:
        arming.auto_armed = False
        return
    if modes.arming_delay and time_us - arming.armed_us >= ARMING_DELAY_US:
        modes.arming_delay = False
    throttle_zero = modes.pilot.throttle_zero
    if not arming.auto_armed:
        if not throttle_zero:
            arming.auto_armed = True
    elif has_manual_throttle(modes.number) and throttle_zero and not modes.failsafe.radio:
        arming.auto_armed = False


@law
def disarm_idle(v: Vehicle) -> None:
    """Disarm what was armed on the ground and left alone for DISARM_DELAY; called ten times a second."""
    ap = v.autopilot
    stands = ap.arming.landed and ap.control.motors.spool_state <= SpoolState.GROUND_IDLE
    idle = stands and ap.modes.pilot.throttle_zero and not idles_armed(ap.modes.number)
    if was_idle(ap.arming, idle, v.time_us, ap.params.DISARM_DELAY):
        ground.disarm(v, ArmingMethod.DELAY)


@law
def was_idle(arming: Arming, idle: bool, time_us: int, delay: float) -> bool:
    """Whether an armed vehicle has been ``idle`` for a delay [s], 0 for ever."""
    if not arming.armed or delay <= 0.0 or not idle:
        arming.idle_us = time_us
        return False
    return time_us - arming.idle_us >= delay * 1e6


def arm(v: Vehicle, method: int, force: bool) -> tuple[bool, list[str]]:
    """Arm from the shell: whether it worked, and the texts for the user when it did not."""
    failed = try_arm(v, method, force)
    if v.autopilot.arming.armed:
        return True, []
    first = failed & MANDATORY if force else 0
    return False, texts(v, first, "Arm: ") + texts(v, failed & ~first, "Arm: ")


def texts(v: Vehicle, failed: int, prefix: str) -> list[str]:
    """Status texts of failed checks, each after ``prefix``."""
    ap = v.autopilot
    now = {
        MODE: f"{TITLES.get(ap.modes.number)} mode not armable",
        DOUBTFUL: doubt_text(ap.estimate, ap.params.FS.EKF_THRESH),
    }
    own = {**TEXTS, **now, **arming_checks.receiver_texts(v.sensors, v.autopilot.params)}
    return arming_checks.texts(failed, v.autopilot.params, prefix, own)
