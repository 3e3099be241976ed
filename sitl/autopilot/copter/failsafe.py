# SPDX-License-Identifier: BSD-3-Clause
"""Failsafes: radio, ground station, battery, estimator. FAILSAFE (which, 1 on or 0 off) tells the shell."""

from __future__ import annotations

from ...core.kernels import law
from ..arming_checks import BY_BATTERY_FAILSAFE, BY_GCS_FAILSAFE, BY_RADIO_FAILSAFE, BY_TERMINATION
from ..failsafe_checks import (
    EKF,
    GCS,
    RADIO,
    battery_fell_to,
    is_estimate_bad,
    is_gcs_lost,
    report,
    report_battery,
    text,
)
from ..modes import (
    ACCEPTED,
    REASON_BATTERY_FAILSAFE,
    REASON_EKF_FAILSAFE,
    REASON_GCS_FAILSAFE,
    REASON_RADIO_FAILSAFE,
)
from ..radio import THROTTLE, stick_pulse
from .failsafe_actions import (
    DO_BRAKE,
    DO_LAND,
    DO_RTL,
    DO_STOP,
    NOTHING,
    act,
    battery_action,
    gcs_action,
    land_with_pause,
    radio_action,
)
from .modes import ground, set_mode
from .modes.alt_hold import ALT_HOLD
from .modes.auto import AUTO
from .modes.guided import GUIDED
from .modes.land import LAND
from .modes.table import is_autonomous, requires_position
from .state import Vehicle

__all__ = ["DO_BRAKE", "DO_LAND", "DO_RTL", "DO_STOP", "NOTHING", "act", "terminate", "text"]

# FS_OPTIONS bits
_RADIO_AUTO, _GCS_AUTO, _RADIO_GUIDED, _GCS_PILOT = 1, 2, 4, 16

RADIO_FRAMES = 3
"""Bad frames in a row that set the radio failsafe; as many good ones, not needing to be in a row, clear it."""
EKF_COUNT = 10
"""Tenths of a second of bad estimate that count."""


@law
def watch_radio(v: Vehicle) -> None:
    """After each frame of the receiver."""
    ap = v.autopilot
    fs = ap.modes.failsafe
    enable = int(ap.params.FS.THR_ENABLE)
    pulse = stick_pulse(ap.rc, ap.params.RCMAP, THROTTLE)
    fitted = ap.rc.receiver_us > 0 or ap.rc.has_receiver
    bad = enable > 0 and fitted and (not ap.rc.receiver_ok or pulse < ap.params.FS.THR_VALUE)
    if bad and not fs.radio:
        fs.radio_count += 1
        if fs.radio_count >= RADIO_FRAMES:
            fs.radio = True
            report(ap.events, v.time_us, RADIO, True)
            start_radio(v, radio_action(enable))
    elif not bad and fs.radio:
        fs.radio_count -= 1
        if fs.radio_count <= 0:
            fs.radio = False
            report(ap.events, v.time_us, RADIO, False)
    elif not bad:
        fs.radio_count = 0


@law
def start_radio(v: Vehicle, action: int) -> None:
    """Act on the lost radio, unless FS_OPTIONS lets the mode go on."""
    ap = v.autopilot
    options = int(ap.params.FS.OPTIONS)
    mode = ap.modes.number
    if mode == AUTO and (options & _RADIO_AUTO) != 0 and not ap.arming.landed:
        return
    if mode == GUIDED and (options & _RADIO_GUIDED) != 0 and not ap.arming.landed:
        return
    act(v, action, REASON_RADIO_FAILSAFE, BY_RADIO_FAILSAFE)


@law
def watch_gcs(v: Vehicle) -> None:
    """Ten times a second: the ground station's heartbeat (``failsafe.gcs_us``, written by the bridge)."""
    ap = v.autopilot
    fs = ap.modes.failsafe
    lost = is_gcs_lost(fs, v.time_us, ap.params.FS)
    if lost and not fs.gcs:
        fs.gcs = True
        report(ap.events, v.time_us, GCS, True)
        options = int(ap.params.FS.OPTIONS)
        mode = ap.modes.number
        goes_on = mode == AUTO and (options & _GCS_AUTO) != 0
        goes_on = goes_on or (not is_autonomous(mode) and (options & _GCS_PILOT) != 0)
        if not goes_on or ap.arming.landed:
            act(v, gcs_action(int(ap.params.FS.GCS_ENABLE)), REASON_GCS_FAILSAFE, BY_GCS_FAILSAFE)
    elif not lost and fs.gcs:
        fs.gcs = False
        report(ap.events, v.time_us, GCS, False)


@law
def watch_battery(v: Vehicle) -> None:
    """Ten times a second: act on a battery that has become low or critical."""
    ap, p = v.autopilot, v.autopilot.params
    level = battery_fell_to(ap.modes.failsafe, ap.battery, ap.arming.armed, v.time_us, p.BATT)
    if level != 0:
        report_battery(ap.events, v.time_us, level)
        choice = int(p.BATT.FS_CRT_ACT) if level == 2 else int(p.BATT.FS_LOW_ACT)
        act(v, battery_action(choice), REASON_BATTERY_FAILSAFE, BY_BATTERY_FAILSAFE)


EKF_ACTED = 2
"""``failsafe.ekf``: the estimate is bad and the mode was ended for it (1: bad, but the mode needs no position)."""


@law
def watch_estimate(v: Vehicle) -> None:
    """Ten times a second: a bad estimate for a second ends modes that need a position (FS_EKF_ACTION)."""
    ap = v.autopilot
    fs = ap.modes.failsafe
    bad = is_estimate_bad(fs, ap.estimate, ap.params.FS.EKF_THRESH, ap.params.FS.EKF_FILT)
    if ap.params.FS.EKF_THRESH <= 0.0 or not ap.arming.armed or not ap.estimate.origin_set:
        fs.ekf_count = 0
        fs.ekf = 0
        return
    if bad and fs.ekf_count < EKF_COUNT:
        fs.ekf_count += 1
        if fs.ekf_count >= EKF_COUNT and fs.ekf == 0:
            fs.ekf = 1
            start_ekf(v)
    elif not bad and fs.ekf_count > 0:
        fs.ekf_count -= 1
        if fs.ekf_count == 0 and fs.ekf != 0:
            if fs.ekf == EKF_ACTED:
                report(ap.events, v.time_us, EKF, False)
            fs.ekf = 0


@law
def start_ekf(v: Vehicle) -> None:
    """Act on the bad estimate."""
    ap = v.autopilot
    action = int(ap.params.FS.EKF_ACTION)
    mode = ap.modes.number
    if mode != LAND and (action == 0 or (not requires_position(mode) and action != 3)):
        return
    ap.modes.failsafe.ekf = EKF_ACTED
    report(ap.events, v.time_us, EKF, True)
    if mode == LAND:
        ap.modes.land.with_position = False
        return
    if action == 2 and set_mode.request(v, ALT_HOLD, REASON_EKF_FAILSAFE) == ACCEPTED:
        return
    land_with_pause(v, REASON_EKF_FAILSAFE)
    ap.modes.land.with_position = False


@law
def terminate(v: Vehicle) -> None:
    """MAV_CMD_DO_FLIGHTTERMINATION: stop the motors."""
    ground.disarm(v, BY_TERMINATION)
    ground.set_landed(v.autopilot.arming, True)
