# SPDX-License-Identifier: BSD-3-Clause
"""Failsafes: radio, ground station (FS_ACTION after FS_TIMEOUT), battery (BATT_FS_LOW_ACT, _CRT_ACT), estimator.

FAILSAFE (which, 1 on or 0 off) reports to the shell. The pilot's sticks count as centred as soon as the radio is lost.
"""

from __future__ import annotations

from typing import Any

from ...core.kernels import law
from ...core.mavlink import MavSeverity
from .. import failsafe_checks
from ..arming_checks import ArmingMethod
from ..estimation.state import Ekf
from ..failsafe_checks import EKF, GCS, RADIO, VARIANCE, is_estimate_bad, report
from ..modes import ModeReason, ModeResult
from ..notes import Text
from ..state import Estimate, Failsafe
from . import motor_test
from .arming import set_disarmed
from .control.state import MotorsState
from .modes import set_mode
from .modes.auto import AUTO
from .modes.hold import HOLD
from .modes.loiter import LOITER
from .modes.mode_list import requires_position
from .modes.rtl import RTL
from .modes.smart_rtl import SMART_RTL
from .modes.state import BIT_RADIO, LinksState, Modes
from .parameters.safety import Battery, Failsafes
from .state import Vehicle

CONTINUES = 6
"""One more kind of FAILSAFE: AUTO goes on."""

ENABLED_BUT_IN_AUTO = 2.0
"""FS_THR_ENABLE, FS_GCS_ENABLE: missions go on."""
ACTIVE_IN_HOLD = 1
"""FS_OPTIONS"""
EKF_COUNT, YAW_COUNT = 10, 8
"""Tenths of a second of bad estimate that count."""
EKF_NOTHING, EKF_HOLD, EKF_REPORT = 0, 1, 2
"""FS_EKF_ACTION"""
EKF_SAME, EKF_FAILS, EKF_RECOVERS = 0, 1, 2
"""What ``watch_estimate`` sees."""
NOTHING, DO_RTL, DO_HOLD, DO_SMART_RTL, DO_SMART_RTL_OR_HOLD, TERMINATE, DO_LOITER_OR_HOLD = 0, 1, 2, 3, 4, 5, 6
"""FS_ACTION, BATT_FS_LOW_ACT, BATT_FS_CRT_ACT; DO_SMART_RTL: else RTL, else HOLD."""

_TEXTS = {
    (CONTINUES, True): "Failsafe - Continuing Auto Mode",
    (EKF, True): "EKF failsafe",
    (EKF, False): "EKF failsafe cleared",
}


def text(which: int, on: int) -> str | None:
    """Status text of a FAILSAFE event, None when there is none."""
    return _TEXTS.get((which, on != 0)) or failsafe_checks.text(which, on != 0)


def _texts(v: Any, which: float, on: float) -> list[Text]:
    said, severity = text(int(which), int(on != 0.0)), MavSeverity.WARNING if on != 0.0 else MavSeverity.INFO
    return [Text(MavSeverity.CRITICAL if which in (EKF, VARIANCE) else severity, said)] if said else []


FAILSAFE = failsafe_checks.FAILSAFE.saying(says=_texts)


@law
def act(v: Vehicle, action: int, reason: int) -> None:
    """Change to what ``action`` asks for; what cannot be entered becomes the next best, HOLD at last."""
    if action == NOTHING:
        return
    if action == TERMINATE:
        set_disarmed(v.autopilot.arming, v.autopilot.events, v.time_us, ArmingMethod.BATTERY_FAILSAFE)
        return
    if action in (DO_SMART_RTL, DO_SMART_RTL_OR_HOLD):
        if set_mode.request(v, SMART_RTL, reason) == ModeResult.ACCEPTED:
            return
    if action in (DO_RTL, DO_SMART_RTL):
        if set_mode.request(v, RTL, reason) == ModeResult.ACCEPTED:
            return
    if action == DO_LOITER_OR_HOLD:
        if set_mode.request(v, LOITER, reason) == ModeResult.ACCEPTED:
            return
    set_mode.request(v, HOLD, reason)


@law
def kind_of(bit: int) -> int:
    """FAILSAFE's name of a link."""
    return RADIO if bit == BIT_RADIO else GCS


@law
def waits(mode: int, motors: MotorsState, params: Failsafes) -> bool:
    """Whether a lost link is not acted upon now: on the way home, in HOLD, in a motor test."""
    in_hold = mode == HOLD and (int(params.OPTIONS) & ACTIVE_IN_HOLD) == 0
    return mode == RTL or in_hold or motor_test.is_running(motors)


@law
def note_link(links: LinksState, bit: int, bad: bool, time_us: int) -> bool:
    """Note that a link is there or not; whether a failsafe that was acted upon is over."""
    before = links.bad
    links.bad = (before | bit) if bad else (before & ~bit)
    if before == 0 and links.bad != 0:
        links.since_us = time_us
    over = links.acted != 0 and links.bad == 0
    links.acted = links.acted & links.bad
    return over


@law
def goes_on(bit: int, mode: int, params: Failsafes) -> bool:
    """Whether the mission may go on without the link."""
    enabled = params.THR_ENABLE if bit == BIT_RADIO else params.GCS_ENABLE
    return mode == AUTO and enabled == ENABLED_BUT_IN_AUTO


@law
def watch(v: Vehicle, bit: int, bad: bool) -> None:
    """Watch a link: a loss that lasts is acted upon once (FS_ACTION), whichever link it is."""
    ap = v.autopilot
    links, p = ap.modes.links, ap.params.FS
    if note_link(links, bit, bad, v.time_us):
        report(ap.events, v.time_us, kind_of(bit), False)
    if links.acted != 0 or not bad or v.time_us - links.since_us <= p.TIMEOUT * 1e6:
        return
    if waits(ap.modes.number, ap.control.motors, p):
        return
    links.acted = links.bad
    report(ap.events, v.time_us, kind_of(bit), True)
    for k in range(18):
        ap.rc.override[k] = 0
    if goes_on(bit, ap.modes.number, p):
        report(ap.events, v.time_us, CONTINUES, True)
    else:
        act(v, int(p.ACTION), ModeReason.FAILSAFE)


@law
def battery_action(level: int, params: Battery) -> int:
    """What a battery that has become low (``level`` 1) or critical (2) asks for."""
    if level == 0:
        return NOTHING
    return int(params.FS_CRT_ACT) if level == 2 else int(params.FS_LOW_ACT)


GLITCH_US = 4_000_000
"""A rover's position is not trusted after so long a glitch of the receiver."""


@law
def is_glitch_long(ekf: Ekf) -> bool:
    """Whether fixes have not been believed for long."""
    return ekf.gps_glitch and ekf.now_us - ekf.pos_fused_us > GLITCH_US


@law
def watch_estimate(modes: Modes, estimate: Estimate, armed: bool, params: Failsafes, by_glitch: bool) -> int:
    """Ten times a second: EKF_FAILS, EKF_RECOVERS or EKF_SAME; a bad estimate counts when it lasts a second.

    Only once the estimate has been good: a rover may drive without a position. ``by_glitch``: its position is bad.
    """
    fs = modes.failsafe
    if not estimate.origin_set:
        return EKF_SAME
    bad = is_estimate_bad(fs, estimate, params.EKF_THRESH, 0.0) or by_glitch
    if params.EKF_THRESH <= 0.0 or not armed:
        fs.ekf_count = 0
        return clear_ekf(fs)
    if not bad:
        modes.ekf_was_good = True
    if not modes.ekf_was_good:
        return EKF_SAME
    if bad and fs.ekf_count < EKF_COUNT:
        fs.ekf_count += 1
        if fs.ekf_count >= EKF_COUNT and fs.ekf == 0:
            fs.ekf = 1
            return EKF_FAILS
    elif not bad and fs.ekf_count > 0:
        fs.ekf_count -= 1
        if fs.ekf_count == 0:
            return clear_ekf(fs)
    return EKF_SAME


@law
def clear_ekf(fs: Failsafe) -> int:
    """The estimate is good: EKF_RECOVERS when it was not."""
    before = fs.ekf
    fs.ekf = 0
    return EKF_RECOVERS if before != 0 else EKF_SAME


@law
def check_ekf(v: Vehicle) -> None:
    """Ten times a second: a bad estimate ends modes that need a good one (FS_EKF_ACTION)."""
    ap = v.autopilot
    change = watch_estimate(ap.modes, ap.estimate, ap.arming.armed, ap.params.FS, is_glitch_long(ap.ekf))
    if change == EKF_SAME and ap.modes.failsafe.ekf_count == YAW_COUNT:
        ap.yaw_bank.asked_us = v.time_us
    if change == EKF_RECOVERS:
        report(ap.events, v.time_us, EKF, False)
    elif change == EKF_FAILS:
        report(ap.events, v.time_us, VARIANCE, True)
        action = int(ap.params.FS.EKF_ACTION)
        if requires_position(ap.modes.number) and action != EKF_NOTHING:
            if action != EKF_REPORT:
                set_mode.request(v, HOLD, ModeReason.EKF_FAILSAFE)
            report(ap.events, v.time_us, EKF, True)
