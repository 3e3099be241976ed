# SPDX-License-Identifier: BSD-3-Clause
"""Failsafes: radio, ground station, battery, estimator. FAILSAFE (which, 1 on or 0 off) tells the shell."""

from __future__ import annotations

from ..core.kernels import law
from ..core.rotations import TWO_PI
from . import arming, pilot
from .failsafe_actions import (
    BATTERY_CRITICAL,
    BATTERY_LOW,
    DO_BRAKE,
    DO_LAND,
    DO_RTL,
    DO_STOP,
    EKF,
    GCS,
    NOTHING,
    RADIO,
    act,
    battery_action,
    gcs_action,
    land_with_pause,
    radio_action,
    tell,
    text,
)
from .modes.copter import ground, set_mode
from .modes.copter.numbers import (
    ACCEPTED,
    ALT_HOLD,
    AUTO,
    GUIDED,
    LAND,
    REASON_BATTERY_FAILSAFE,
    REASON_EKF_FAILSAFE,
    REASON_GCS_FAILSAFE,
    REASON_RADIO_FAILSAFE,
    is_autopilot,
    requires_position,
)

__all__ = ["DO_BRAKE", "DO_LAND", "DO_RTL", "DO_STOP", "NOTHING", "act", "terminate", "text"]

# FS_OPTIONS bits
_RADIO_AUTO, _GCS_AUTO, _RADIO_GUIDED, _GCS_PILOT = 1, 2, 4, 16

RADIO_FRAMES = 3
"""Bad frames in a row that set the radio failsafe; as many good ones, not needing to be in a row, clear it."""
EKF_COUNT = 10
"""Tenths of a second of bad estimate that count."""
_EKF_PERIOD_S = 0.1


@law
def update_radio(v):
    """After each frame of the receiver."""
    ap = v.autopilot
    fs = ap.modes.failsafe
    enable = int(ap.params.FS_THR_ENABLE)
    pulse = ap.rc.channels[pilot.stick_channel(ap.params, 2) - 1]
    heard = fs.receiver_us > 0 or ap.modes.pilot.has_receiver != 0
    bad = enable > 0 and heard and (ap.rc.receiver_ok == 0 or pulse < ap.params.FS_THR_VALUE)
    if bad and fs.radio == 0:
        fs.radio_count += 1
        if fs.radio_count >= RADIO_FRAMES:
            fs.radio = 1
            tell(v, RADIO, 1)
            start_radio(v, radio_action(enable))
    elif not bad and fs.radio != 0:
        fs.radio_count -= 1
        if fs.radio_count <= 0:
            fs.radio = 0
            tell(v, RADIO, 0)
    elif not bad:
        fs.radio_count = 0


@law
def start_radio(v, action):
    """Act on the lost radio, unless FS_OPTIONS lets the mode go on."""
    ap = v.autopilot
    options = int(ap.params.FS_OPTIONS)
    mode = ap.modes.number
    if mode == AUTO and (options & _RADIO_AUTO) != 0 and ap.arming.landed == 0:
        return
    if mode == GUIDED and (options & _RADIO_GUIDED) != 0 and ap.arming.landed == 0:
        return
    act(v, action, REASON_RADIO_FAILSAFE, arming.BY_RADIO_FAILSAFE)


@law
def update_gcs(v):
    """Ten times a second: the ground station's heartbeat (``failsafe.gcs_us``, written by the bridge)."""
    ap = v.autopilot
    fs = ap.modes.failsafe
    enable = int(ap.params.FS_GCS_ENABLE)
    lost = enable > 0 and fs.gcs_us > 0 and v.time_us - fs.gcs_us > ap.params.FS_GCS_TIMEOUT * 1e6
    if lost and fs.gcs == 0:
        fs.gcs = 1
        tell(v, GCS, 1)
        options = int(ap.params.FS_OPTIONS)
        mode = int(ap.modes.number)
        goes_on = mode == AUTO and (options & _GCS_AUTO) != 0
        goes_on = goes_on or (not is_autopilot(mode) and (options & _GCS_PILOT) != 0)
        if not goes_on or ap.arming.landed != 0:
            act(v, gcs_action(enable), REASON_GCS_FAILSAFE, arming.BY_GCS_FAILSAFE)
    elif not lost and fs.gcs != 0:
        fs.gcs = 0
        tell(v, GCS, 0)


@law
def below(v, volt, mah):
    """(voltage under ``volt``, charge left under ``mah``), limits of zero being off."""
    battery = v.autopilot.battery
    left = v.autopilot.params.BATT_CAPACITY - battery.consumed_mah
    counts = v.autopilot.params.BATT_MONITOR >= 4.0
    return (volt > 0.0 and battery.voltage < volt, mah > 0.0 and counts and left < mah)


@law
def update_battery(v):
    """Ten times a second, armed: low, then critical; both stay until the next start."""
    ap = v.autopilot
    fs = ap.modes.failsafe
    p = ap.params
    if p.BATT_MONITOR < 3.0 or ap.arming.armed == 0:
        fs.battery_low_us = 0
        fs.battery_critical_us = 0
        return
    wait = p.BATT_LOW_TIMER * 1e6
    volt, charge = below(v, p.BATT_CRT_VOLT, p.BATT_CRT_MAH)
    if not volt:
        fs.battery_critical_us = 0
    elif fs.battery_critical_us == 0:
        fs.battery_critical_us = v.time_us
    if fs.battery < 2 and (charge or (volt and v.time_us - fs.battery_critical_us >= wait)):
        fs.battery = 2
        tell(v, BATTERY_CRITICAL, 1)
        act(v, battery_action(int(p.BATT_FS_CRT_ACT)), REASON_BATTERY_FAILSAFE, arming.BY_BATTERY_FAILSAFE)
    volt, charge = below(v, p.BATT_LOW_VOLT, p.BATT_LOW_MAH)
    if not volt:
        fs.battery_low_us = 0
    elif fs.battery_low_us == 0:
        fs.battery_low_us = v.time_us
    if fs.battery < 1 and (charge or (volt and v.time_us - fs.battery_low_us >= wait)):
        fs.battery = 1
        tell(v, BATTERY_LOW, 1)
        act(v, battery_action(int(p.BATT_FS_LOW_ACT)), REASON_BATTERY_FAILSAFE, arming.BY_BATTERY_FAILSAFE)


@law
def follow(filtered, value, gain):
    """A low-pass; a value that is not a number (a filter about to restart) is passed over."""
    if value != value:
        return filtered
    return filtered + gain * (value - filtered)


@law
def is_estimate_bad(v):
    """Whether two filtered test ratios are over FS_EKF_THRESH, or there is no position.

    Velocity counts double when it is twice over.
    """
    ap = v.autopilot
    fs = ap.modes.failsafe
    est = ap.estimate
    cutoff = ap.params.FS_EKF_FILT
    gain = 1.0
    if cutoff > 0.0:
        gain = _EKF_PERIOD_S / (_EKF_PERIOD_S + 1.0 / (TWO_PI * cutoff))
    fs.ekf_vel = follow(float(fs.ekf_vel), float(est.variance_vel), gain)
    fs.ekf_pos = follow(float(fs.ekf_pos), float(est.variance_pos), gain)
    fs.ekf_mag = follow(float(fs.ekf_mag), float(est.variance_mag), gain)
    limit = ap.params.FS_EKF_THRESH
    count = 0
    if fs.ekf_mag >= limit:
        count += 1
    if fs.ekf_vel >= 2.0 * limit:
        count += 2
    elif fs.ekf_vel >= limit:
        count += 1
    if fs.ekf_pos >= limit and count > 0:
        count += 1
    return count >= 2 or est.position_ok == 0


EKF_ACTED = 2
"""``failsafe.ekf``: the estimate is bad and the mode was ended for it (1: bad, but the mode needs no position)."""


@law
def update_ekf(v):
    """Ten times a second: a bad estimate for a second ends modes that need a position (FS_EKF_ACTION)."""
    ap = v.autopilot
    fs = ap.modes.failsafe
    bad = is_estimate_bad(v)
    if ap.params.FS_EKF_THRESH <= 0.0 or ap.arming.armed == 0 or ap.estimate.origin_set == 0:
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
                tell(v, EKF, 0)
            fs.ekf = 0


@law
def start_ekf(v):
    """Act on the bad estimate."""
    ap = v.autopilot
    action = int(ap.params.FS_EKF_ACTION)
    mode = int(ap.modes.number)
    if mode != LAND and (action == 0 or (not requires_position(mode) and action != 3)):
        return
    ap.modes.failsafe.ekf = EKF_ACTED
    tell(v, EKF, 1)
    if mode == LAND:
        ap.modes.land.with_position = 0
        return
    if action == 2 and set_mode.request(v, ALT_HOLD, REASON_EKF_FAILSAFE) == ACCEPTED:
        return
    land_with_pause(v, REASON_EKF_FAILSAFE)
    ap.modes.land.with_position = 0


@law
def terminate(v):
    """MAV_CMD_DO_FLIGHTTERMINATION: stop the motors."""
    arming.disarm(v, arming.BY_TERMINATION, 1)
    ground.set_landed(v, 1)
