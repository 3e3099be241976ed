# SPDX-License-Identifier: BSD-3-Clause
"""Failsafes: radio, ground station, battery, estimator. FAILSAFE (which; 0 off, else what follows) reports to the
shell."""

from __future__ import annotations

from typing import Any

from ...core.kernels import law
from ...core.mavlink import MavSeverity
from .. import failsafe_checks
from ..arming_checks import ArmingMethod
from ..estimation.status import GPS_GLITCHING
from ..events import emit
from ..failsafe_checks import (
    EKF,
    GCS,
    GLITCH,
    RADIO,
    SEVERE,
    TERRAIN,
    VARIANCE,
    VIBRATION,
    battery_fell_to,
    is_estimate_bad,
    is_gcs_lost,
    is_radio_bad,
    report,
    report_battery,
    watch_monitor,
)
from ..modes import ModeReason, ModeResult
from ..notes import Text
from ..state import Arming, Failsafe
from ..terrain.ground import is_long_missing
from ..terrain.state import FAILSAFE as GROUND_MISSING
from ..terrain.state import RTL_BEGINS_ANEW, TERRAIN_DID
from .control import vibration_compensation
from .failsafe_actions import (
    CONTINUE_LANDING,
    DO_BRAKE,
    DO_LAND,
    DO_RTL,
    DO_SMART_RTL,
    DO_SMART_RTL_OR_LAND,
    DO_STOP,
    NOTHING,
    act,
    battery_action,
    gcs_action,
    is_idle,
    land_with_pause,
    radio_action,
)
from .modes import ground, rtl, set_mode
from .modes.alt_hold import ALT_HOLD
from .modes.auto import AUTO
from .modes.guided import GUIDED
from .modes.land import LAND
from .modes.mode_list import is_autonomous, is_landing, requires_position
from .modes.rtl import RTL
from .modes.state import Modes
from .parameters.safety import Battery
from .state import Vehicle

__all__ = [
    "DO_BRAKE",
    "DO_LAND",
    "DO_RTL",
    "DO_SMART_RTL",
    "DO_SMART_RTL_OR_LAND",
    "DO_STOP",
    "NOTHING",
    "act",
    "terminate",
    "text",
]

# FS_OPTIONS bits
_RADIO_AUTO, _GCS_AUTO, _RADIO_GUIDED, _GCS_PILOT = 1, 2, 4, 16

ACTS, DISARMS, LANDING_GOES_ON, AUTO_GOES_ON, GUIDED_GOES_ON, PILOT_GOES_ON, BATTERY_LANDS = 1, 2, 3, 4, 5, 6, 7
"""What follows the loss of a link: second number of its FAILSAFE."""
_ENDINGS = {
    DISARMS: "Disarming",
    LANDING_GOES_ON: "Continuing Landing",
    AUTO_GOES_ON: "Continuing Auto Mode",
    GUIDED_GOES_ON: "Continuing Guided Mode",
    PILOT_GOES_ON: "Continuing Pilot Control",
}

EKF_LANDS, EKF_HOLDS = 2, 3
"""What follows a bad estimate, besides 1: nothing."""
_BY_ESTIMATE = {EKF_LANDS: "LAND", EKF_HOLDS: "ALT_HOLD"}

RADIO_FRAMES = 3
"""Bad frames in a row that set the radio failsafe; as many good ones, not needing to be in a row, clear it."""
EKF_COUNT, YAW_COUNT = 10, 8
"""Tenths of a second of bad estimate that count."""


def text(which: int, how: int) -> str | None:
    """Status text of a FAILSAFE event, None when there is none."""
    if which == EKF and how in _BY_ESTIMATE:
        return f"EKF Failsafe: changed to {_BY_ESTIMATE[how]} Mode"
    if how == BATTERY_LANDS:
        return "Radio + Battery Failsafe - Continuing Landing"
    said = failsafe_checks.text(which, how != 0)
    if which == RADIO and how == AUTO_GOES_ON:
        return f"{said} - Continuing Auto"
    return f"{said} - {_ENDINGS[how]}" if said and how in _ENDINGS else said


def _texts(v: Any, which: float, how: float) -> list[Text]:
    said = text(int(which), int(how))
    return [Text(MavSeverity.CRITICAL if int(which) in SEVERE else MavSeverity.WARNING, said)] if said else []


FAILSAFE = failsafe_checks.FAILSAFE.saying(says=_texts)


@law
def watch_radio(v: Vehicle) -> None:
    """After each frame of the receiver."""
    ap = v.autopilot
    modes, p = ap.modes, ap.params
    fs, enabled, options = modes.failsafe, int(p.FS.THR_ENABLE), int(p.FS.OPTIONS)
    if not count_radio(fs, enabled != 0 and is_radio_bad(ap.rc, p.RCMAP, p.FS.THR_VALUE)):
        return
    if fs.radio:
        how = follows(modes, ap.arming, without_radio(modes.number, options), options, battery_lands(fs, p.BATT))
        lose(v, RADIO, how, radio_action(enabled), ModeReason.RADIO_FAILSAFE, ArmingMethod.RADIO_FAILSAFE)
    else:
        report(ap.events, v.time_us, RADIO, False)


@law
def count_radio(fs: Failsafe, bad: bool) -> bool:
    """Count a frame that is ``bad`` or good; whether the radio (``fs.radio``) is lost or back with it."""
    before = fs.radio
    if bad and not fs.radio:
        fs.radio_count += 1
        fs.radio = fs.radio_count >= RADIO_FRAMES
    elif not bad and fs.radio:
        fs.radio_count -= 1
        fs.radio = fs.radio_count > 0
    elif not bad:
        fs.radio_count = 0
    return fs.radio != before


@law
def without_radio(mode: int, options: int) -> int:
    """What FS_OPTIONS lets fly on without a radio in this mode, else ACTS."""
    if mode == AUTO and (options & _RADIO_AUTO) != 0:
        return AUTO_GOES_ON
    return GUIDED_GOES_ON if mode == GUIDED and (options & _RADIO_GUIDED) != 0 else ACTS


@law
def without_gcs(mode: int, options: int) -> int:
    """What FS_OPTIONS lets fly on without a ground station in this mode, else ACTS."""
    if mode == AUTO and (options & _GCS_AUTO) != 0:
        return AUTO_GOES_ON
    return PILOT_GOES_ON if not is_autonomous(mode) and (options & _GCS_PILOT) != 0 else ACTS


@law
def battery_lands(fs: Failsafe, params: Battery) -> bool:
    """Whether the battery is why the vehicle comes down: that must go on."""
    choice = int(params.FS_CRT_ACT) if fs.battery == 2 else int(params.FS_LOW_ACT)
    return fs.battery != 0 and battery_action(choice) in (DO_LAND, DO_STOP)


@law
def follows(modes: Modes, arming: Arming, otherwise: int, options: int, for_battery: bool) -> int:
    """What follows the loss of a link in this state.

    ``otherwise``: when nothing else does; ``for_battery``: a landing is the battery's.
    """
    if not arming.armed:
        return ACTS
    if is_idle(modes, arming.landed):
        return DISARMS
    if is_landing(modes.number, modes):
        if for_battery:
            return BATTERY_LANDS
        if (options & CONTINUE_LANDING) != 0:
            return LANDING_GOES_ON
    return otherwise


@law
def lose(v: Vehicle, which: int, how: int, action: int, reason: int, method: int) -> None:
    """Report a link that is lost, and do what follows."""
    emit(v.autopilot.events, v.time_us, FAILSAFE, float(which), float(how))
    if how in (ACTS, DISARMS):
        act(v, action, reason, method)
    elif how in (LANDING_GOES_ON, BATTERY_LANDS):
        act(v, DO_LAND, reason, method)


@law
def watch_gcs(v: Vehicle) -> None:
    """Ten times a second: the ground station's heartbeat (``failsafe.gcs_us``, written by the bridge)."""
    ap = v.autopilot
    modes, p = ap.modes, ap.params.FS
    fs, options = modes.failsafe, int(p.OPTIONS)
    lost = is_gcs_lost(fs, v.time_us, p)
    if lost == fs.gcs:
        return
    fs.gcs = lost
    if lost:
        how = follows(modes, ap.arming, without_gcs(modes.number, options), options, False)
        lose(v, GCS, how, gcs_action(int(p.GCS_ENABLE)), ModeReason.GCS_FAILSAFE, ArmingMethod.GCS_FAILSAFE)
    else:
        report(ap.events, v.time_us, GCS, False)


@law
def watch_battery(v: Vehicle) -> None:
    """Ten times a second: act on a battery that has become low or critical."""
    ap, p = v.autopilot, v.autopilot.params
    level = battery_fell_to(ap.modes.failsafe, ap.battery, ap.arming.armed, v.time_us, p.BATT)
    report_battery(ap.events, v.time_us, level, ap.battery)
    watch_monitor(ap.modes.failsafe, ap.battery, ap.arming.armed, ap.events, v.time_us)
    if level != 0:
        choice = int(p.BATT.FS_CRT_ACT) if level == 2 else int(p.BATT.FS_LOW_ACT)
        act(v, battery_action(choice), ModeReason.BATTERY_FAILSAFE, ArmingMethod.BATTERY_FAILSAFE)


@law
def watch_estimate(v: Vehicle) -> None:
    """Ten times a second: a bad estimate for a second ends modes that need a position (FS_EKF_ACTION)."""
    watch_glitch(v)
    ap = v.autopilot
    fs, p = ap.modes.failsafe, ap.params.FS
    before = fs.ekf
    bad = is_estimate_bad(fs, ap.estimate, p.EKF_THRESH, p.EKF_FILT)
    if p.EKF_THRESH <= 0.0 or not ap.arming.armed or not ap.estimate.origin_set:
        fs.ekf_count = 0
        fs.ekf = 0
        return
    count_estimate(fs, bad)
    if bad and fs.ekf_count == YAW_COUNT:
        ap.yaw_bank.asked_us = v.time_us
    if before == 0 and fs.ekf != 0:
        report(ap.events, v.time_us, VARIANCE, True)
        emit(ap.events, v.time_us, FAILSAFE, float(EKF), float(act_on_estimate(v)))
    elif before != 0 and fs.ekf == 0:
        report(ap.events, v.time_us, EKF, False)


@law
def watch_glitch(v: Vehicle) -> None:
    """Report fixes that are not believed."""
    ap = v.autopilot
    glitch = ap.estimate.status_flags & GPS_GLITCHING != 0
    if glitch != ap.modes.failsafe.glitch:
        ap.modes.failsafe.glitch = glitch
        report(ap.events, v.time_us, GLITCH, glitch)


@law
def count_estimate(fs: Failsafe, bad: bool) -> None:
    """Count a tenth of a second of a ``bad`` or good estimate; the failsafe begins after ten, and ends at zero."""
    if bad and fs.ekf_count < EKF_COUNT:
        fs.ekf_count += 1
        if fs.ekf_count >= EKF_COUNT and fs.ekf == 0:
            fs.ekf = 1
    elif not bad and fs.ekf_count > 0:
        fs.ekf_count -= 1
        if fs.ekf_count == 0:
            fs.ekf = 0


@law
def ends_for_estimate(mode: int, action: int) -> bool:
    """Whether a bad estimate ends the mode, or lets LAND go on without a position; ``action``: FS_EKF_ACTION."""
    return mode == LAND or (action != 0 and (requires_position(mode) or action == 3))


@law
def act_on_estimate(v: Vehicle) -> int:
    """End the mode for the bad estimate, if it needs a good one; EKF_LANDS, EKF_HOLDS or 1."""
    ap = v.autopilot
    action = int(ap.params.FS.EKF_ACTION)
    if not ends_for_estimate(ap.modes.number, action):
        return 1
    follows = 1
    if ap.modes.number != LAND:
        if (
            action == 2
            and not ap.modes.failsafe.radio
            and set_mode.request(v, ALT_HOLD, ModeReason.EKF_FAILSAFE) == ModeResult.ACCEPTED
        ):
            return EKF_HOLDS
        land_with_pause(v, ModeReason.EKF_FAILSAFE)
        follows = EKF_LANDS
    ap.modes.land.with_position = False
    return follows


@law
def watch_vibration(v: Vehicle) -> None:
    """Ten times a second: vertical control without the measured acceleration, when that runs away (FS_VIBE_ENABLE)."""
    ap = v.autopilot
    watched = ap.arming.armed and ap.params.FS.VIBE_ENABLE > 0.0
    change = vibration_compensation.watch(ap.control.vibration, ap.estimate, watched, v.time_us)
    if change != vibration_compensation.NOTHING:
        report(ap.events, v.time_us, VIBRATION, change == vibration_compensation.BEGINS)


@law
def watch_terrain(v: Vehicle) -> None:
    """Ten times a second: the height of the ground is needed and has been missing for too long."""
    ap = v.autopilot
    t, modes = ap.terrain, ap.modes
    if t.missed_us == 0 or not is_long_missing(t, v.time_us):
        return
    t.missed_us = 0
    emit(ap.events, v.time_us, TERRAIN_DID, float(GROUND_MISSING), 0.0)
    report(ap.events, v.time_us, TERRAIN, True)
    if is_idle(modes, ap.arming.landed):
        ground.disarm(v, ArmingMethod.TERRAIN_FAILSAFE)
    elif modes.number == RTL:
        emit(ap.events, v.time_us, TERRAIN_DID, float(RTL_BEGINS_ANEW), 0.0)
        rtl.prepare(v, False)
    elif set_mode.request(v, RTL, ModeReason.TERRAIN_FAILSAFE) != ModeResult.ACCEPTED:
        land_with_pause(v, ModeReason.TERRAIN_FAILSAFE)


def terminate(v: Vehicle) -> None:
    """MAV_CMD_DO_FLIGHTTERMINATION: stop the motors."""
    ground.disarm(v, ArmingMethod.TERMINATION)
    ground.set_landed(v.autopilot.arming, True)
