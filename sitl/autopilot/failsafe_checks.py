# SPDX-License-Identifier: BSD-3-Clause
"""What failsafes watch: ground station, battery, estimator. What follows is each firmware's own.

FAILSAFE (which, 1 on or 0 off) tells the shell.
"""

from __future__ import annotations

from ..core.kernels import law
from ..core.scalars import TWO_PI
from .events import FAILSAFE, emit

RADIO = 1
GCS = 2
BATTERY_LOW = 3
BATTERY_CRITICAL = 4
EKF = 5

_ON = {
    RADIO: "Radio Failsafe",
    GCS: "GCS Failsafe",
    BATTERY_LOW: "Battery 1 is low",
    BATTERY_CRITICAL: "Battery 1 is critical",
    EKF: "EKF Failsafe",
}
_OFF = {RADIO: "Radio Failsafe Cleared", GCS: "GCS Failsafe Cleared", EKF: "EKF Failsafe Cleared"}


def text(which: int, on: bool) -> str | None:
    """Status text (MAV_SEVERITY_WARNING) of a FAILSAFE event, None when there is none."""
    return (_ON if on else _OFF).get(which)


@law
def tell(v, which, on):
    """Emit FAILSAFE."""
    emit(v.autopilot.events, v.time_us, FAILSAFE, float(which), float(on))


@law
def is_gcs_lost(v):
    """Whether the ground station's heartbeat (``failsafe.gcs_us``, written by the bridge) was there and is missing."""
    ap = v.autopilot
    heard = ap.modes.failsafe.gcs_us
    return ap.params.FS.GCS_ENABLE > 0.0 and heard > 0 and v.time_us - heard > ap.params.FS.GCS_TIMEOUT * 1e6


@law
def below(v, volt, mah):
    """(voltage under ``volt``, charge left under ``mah``), limits of zero being off."""
    battery = v.autopilot.battery
    left = v.autopilot.params.BATT.CAPACITY - battery.consumed_mah
    counts = v.autopilot.params.BATT.MONITOR >= 4.0
    return (volt > 0.0 and battery.voltage < volt, mah > 0.0 and counts and left < mah)


@law
def battery_fell_to(v):
    """Ten times a second, armed: 1 when the battery has become low, 2 when critical, else 0.

    Both stay (``failsafe.battery``) until the next start.
    """
    ap = v.autopilot
    fs = ap.modes.failsafe
    p = ap.params
    if p.BATT.MONITOR < 3.0 or ap.arming.armed == 0:
        fs.battery_low_us = 0
        fs.battery_critical_us = 0
        return 0
    wait = p.BATT.LOW_TIMER * 1e6
    found = 0
    volt, charge = below(v, p.BATT.CRT_VOLT, p.BATT.CRT_MAH)
    if not volt:
        fs.battery_critical_us = 0
    elif fs.battery_critical_us == 0:
        fs.battery_critical_us = v.time_us
    if fs.battery < 2 and (charge or (volt and v.time_us - fs.battery_critical_us >= wait)):
        fs.battery = 2
        found = 2
        tell(v, BATTERY_CRITICAL, 1)
    volt, charge = below(v, p.BATT.LOW_VOLT, p.BATT.LOW_MAH)
    if not volt:
        fs.battery_low_us = 0
    elif fs.battery_low_us == 0:
        fs.battery_low_us = v.time_us
    if fs.battery < 1 and (charge or (volt and v.time_us - fs.battery_low_us >= wait)):
        fs.battery = 1
        found = 1
        tell(v, BATTERY_LOW, 1)
    return found


_EKF_PERIOD_S = 0.1


@law
def follow(filtered, value, gain):
    """A low-pass; a value that is not a number (a filter about to restart) is passed over."""
    if value != value:
        return filtered
    return filtered + gain * (value - filtered)


@law
def is_estimate_bad(v, cutoff):
    """Whether two test ratios are over FS_EKF_THRESH, or there is no position; called ten times a second.

    Velocity counts double when it is twice over. ``cutoff`` [Hz] of a low-pass of the ratios, 0 none.
    """
    ap = v.autopilot
    fs = ap.modes.failsafe
    est = ap.estimate
    gain = 1.0
    if cutoff > 0.0:
        gain = _EKF_PERIOD_S / (_EKF_PERIOD_S + 1.0 / (TWO_PI * cutoff))
    fs.ekf_vel = follow(float(fs.ekf_vel), float(est.variance_vel), gain)
    fs.ekf_pos = follow(float(fs.ekf_pos), float(est.variance_pos), gain)
    fs.ekf_mag = follow(float(fs.ekf_mag), float(est.variance_mag), gain)
    limit = ap.params.FS.EKF_THRESH
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
