# SPDX-License-Identifier: BSD-3-Clause
"""Failsafes: radio, ground station (FS_ACTION after FS_TIMEOUT), battery (BATT_FS_LOW_ACT, _CRT_ACT), estimator.

FAILSAFE (which, 1 on or 0 off) tells the shell. The pilot's sticks count as centred as soon as the radio is lost.
"""

from __future__ import annotations

from ...core.kernels import law
from .. import failsafe_checks
from ..arming_checks import BY_BATTERY_FAILSAFE
from ..failsafe_checks import EKF, GCS, RADIO, battery_fell_to, is_estimate_bad, is_gcs_lost, report, report_battery
from ..modes import ACCEPTED, REASON_BATTERY_FAILSAFE, REASON_EKF_FAILSAFE, REASON_FAILSAFE
from ..radio import THROTTLE, stick_pulse
from . import arming, motor_test
from .modes import set_mode
from .modes.auto import AUTO
from .modes.hold import HOLD
from .modes.loiter import LOITER
from .modes.rtl import RTL
from .modes.smart_rtl import SMART_RTL
from .modes.table import requires_position
from .state import Autopilot, Vehicle

CONTINUES, VARIANCE = 6, 7
"""More kinds of FAILSAFE: AUTO goes on; the estimate is bad (said in all modes)."""

# Bits of ``modes.links``
BIT_RADIO, BIT_GCS = 1, 2

ENABLED_BUT_IN_AUTO = 2.0
"""FS_THR_ENABLE, FS_GCS_ENABLE: missions go on."""
ACTIVE_IN_HOLD = 1
"""FS_OPTIONS"""
EKF_COUNT = 10
"""Tenths of a second of bad estimate that count."""
EKF_NOTHING, EKF_HOLD, EKF_REPORT = 0, 1, 2
"""FS_EKF_ACTION"""
NOTHING, DO_RTL, DO_HOLD, DO_SMART_RTL, DO_SMART_RTL_OR_HOLD, TERMINATE, DO_LOITER_OR_HOLD = 0, 1, 2, 3, 4, 5, 6
"""FS_ACTION, BATT_FS_LOW_ACT, BATT_FS_CRT_ACT; DO_SMART_RTL: else RTL, else HOLD."""

_TEXTS = {
    (CONTINUES, True): "Failsafe - Continuing Auto Mode",
    (VARIANCE, True): "EKF variance",
    (EKF, True): "EKF failsafe",
    (EKF, False): "EKF failsafe cleared",
}


def text(which: int, on: bool) -> str | None:
    """Status text of a FAILSAFE event, None when there is none."""
    return _TEXTS.get((which, on)) or failsafe_checks.text(which, on)


@law
def act(v: Vehicle, action: int, reason: int) -> None:
    """Change to what ``action`` asks for; what cannot be entered becomes the next best, HOLD at last."""
    if action == NOTHING:
        return
    if action == TERMINATE:
        arming.disarm(v, BY_BATTERY_FAILSAFE, True)
        return
    if action in (DO_SMART_RTL, DO_SMART_RTL_OR_HOLD):
        if set_mode.request(v, SMART_RTL, reason) == ACCEPTED:
            return
    if action in (DO_RTL, DO_SMART_RTL):
        if set_mode.request(v, RTL, reason) == ACCEPTED:
            return
    if action == DO_LOITER_OR_HOLD:
        if set_mode.request(v, LOITER, reason) == ACCEPTED:
            return
    set_mode.request(v, HOLD, reason)


@law
def update_radio(v: Vehicle) -> None:
    """After each frame of the receiver."""
    ap = v.autopilot
    p = ap.params
    pulse = stick_pulse(ap.rc, p.RCMAP, THROTTLE)
    heard = ap.rc.receiver_us > 0 or ap.rc.has_receiver
    bad = p.FS.THR_ENABLE > 0.0 and heard and (not ap.rc.receiver_ok or pulse < p.FS.THR_VALUE)
    ap.modes.failsafe.radio = bad
    watch(v, BIT_RADIO, bad)


@law
def update_gcs(v: Vehicle) -> None:
    """Ten times a second: the ground station's heartbeat (``failsafe.gcs_us``, written by the bridge)."""
    fs = v.autopilot.modes.failsafe
    lost = is_gcs_lost(fs, v.time_us, v.autopilot.params.FS)
    fs.gcs = lost
    watch(v, BIT_GCS, lost)


@law
def kind_of(bit: int) -> int:
    """FAILSAFE's name of a link."""
    return RADIO if bit == BIT_RADIO else GCS


@law
def waits(ap: Autopilot) -> bool:
    """Whether a lost link is not acted upon now: on the way home, in HOLD, in a motor test."""
    mode = ap.modes.number
    in_hold = mode == HOLD and (int(ap.params.FS.OPTIONS) & ACTIVE_IN_HOLD) == 0
    return mode == RTL or in_hold or motor_test.is_running(ap.control.motors)


@law
def watch(v: Vehicle, bit: int, bad: bool) -> None:
    """Note that a link is there or not; a loss that lasts is acted upon once, whichever link it is."""
    ap = v.autopilot
    links = ap.modes.links
    before = links.bad
    links.bad = (before | bit) if bad else (before & ~bit)
    if before == 0 and links.bad != 0:
        links.since_us = v.time_us
    if links.acted != 0 and links.bad == 0:
        report(ap.events, v.time_us, kind_of(bit), False)
    links.acted = links.acted & links.bad
    if links.acted != 0 or not bad or v.time_us - links.since_us <= ap.params.FS.TIMEOUT * 1e6:
        return
    if not waits(ap):
        links.acted = links.bad
        begin(v, bit)


@law
def begin(v: Vehicle, bit: int) -> None:
    """FS_ACTION, unless the mission may go on."""
    ap = v.autopilot
    p = ap.params
    report(ap.events, v.time_us, kind_of(bit), True)
    for k in range(18):
        ap.rc.override[k] = 0
    enabled = p.FS.THR_ENABLE if bit == BIT_RADIO else p.FS.GCS_ENABLE
    if ap.modes.number == AUTO and enabled == ENABLED_BUT_IN_AUTO:
        report(ap.events, v.time_us, CONTINUES, True)
    else:
        act(v, int(p.FS.ACTION), REASON_FAILSAFE)


@law
def update_battery(v: Vehicle) -> None:
    """Ten times a second: act on a battery that has become low or critical."""
    ap, p = v.autopilot, v.autopilot.params
    level = battery_fell_to(ap.modes.failsafe, ap.battery, ap.arming.armed, v.time_us, p.BATT)
    if level != 0:
        report_battery(ap.events, v.time_us, level)
        act(v, int(p.BATT.FS_CRT_ACT) if level == 2 else int(p.BATT.FS_LOW_ACT), REASON_BATTERY_FAILSAFE)


@law
def update_ekf(v: Vehicle) -> None:
    """Ten times a second: a bad estimate for a second ends modes that need a position (FS_EKF_ACTION).

    Only once the estimate has been good: a rover may drive without a position.
    """
    ap = v.autopilot
    fs = ap.modes.failsafe
    if not ap.estimate.origin_set:
        return
    bad = is_estimate_bad(fs, ap.estimate, ap.params.FS.EKF_THRESH, 0.0)
    if ap.params.FS.EKF_THRESH <= 0.0 or not ap.arming.armed:
        fs.ekf_count = 0
        clear_ekf(v)
        return
    if not bad:
        ap.modes.ekf_was_good = True
    if not ap.modes.ekf_was_good:
        return
    if bad and fs.ekf_count < EKF_COUNT:
        fs.ekf_count += 1
        if fs.ekf_count >= EKF_COUNT and fs.ekf == 0:
            fs.ekf = 1
            report(ap.events, v.time_us, VARIANCE, True)
            begin_ekf(v)
    elif not bad and fs.ekf_count > 0:
        fs.ekf_count -= 1
        if fs.ekf_count == 0:
            clear_ekf(v)


@law
def clear_ekf(v: Vehicle) -> None:
    """The failsafe is over."""
    fs = v.autopilot.modes.failsafe
    if fs.ekf != 0:
        fs.ekf = 0
        report(v.autopilot.events, v.time_us, EKF, False)


@law
def begin_ekf(v: Vehicle) -> None:
    """Act on the bad estimate in a mode that needs a good one."""
    ap = v.autopilot
    action = int(ap.params.FS.EKF_ACTION)
    if not requires_position(ap.modes.number) or action == EKF_NOTHING:
        return
    if action != EKF_REPORT:
        set_mode.request(v, HOLD, REASON_EKF_FAILSAFE)
    report(ap.events, v.time_us, EKF, True)
