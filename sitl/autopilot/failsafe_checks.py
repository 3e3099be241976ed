# SPDX-License-Identifier: BSD-3-Clause
"""What failsafes watch: ground station, battery, estimator. What follows is each firmware's own.

FAILSAFE (which, 1 on or 0 off) reports to the shell.
"""

from __future__ import annotations

from typing import Any

from ..core.kernels import law
from ..core.mavlink import MavSeverity
from ..core.scalars import TWO_PI
from .events import Event, Events, Row, emit, err
from .log_events import LogErrorSubsystem
from .params.radio import RcMap
from .params.system import Battery, Failsafes
from .radio import THROTTLE, stick_pulse
from .state import BatteryState, Estimate, Failsafe, Radio

RADIO = 1
GCS = 2
BATTERY_LOW = 3
BATTERY_CRITICAL = 4
EKF = 5
BATTERY_MISSING = 8
VIBRATION = 9
TERRAIN = 15
VARIANCE = 7
"""The estimate is bad (said in all modes)."""
GLITCH = 10
"""The receiver's fixes are not believed."""
SEVERE = (EKF, VARIANCE, VIBRATION, GLITCH)
"""Reported with MAV_SEVERITY_CRITICAL (a rover: the first two)."""

_ON = {
    RADIO: "Radio Failsafe",
    GCS: "GCS Failsafe",
    BATTERY_LOW: "Battery Failsafe",
    BATTERY_CRITICAL: "Battery Failsafe",
    EKF: "EKF Failsafe",
    VARIANCE: "EKF variance",
    GLITCH: "GPS Glitch or Compass error",
    BATTERY_MISSING: "Battery Failsafe",
    VIBRATION: "Vibration compensation ON",
}
_OFF = {
    RADIO: "Radio Failsafe Cleared",
    GCS: "GCS Failsafe Cleared",
    EKF: "EKF Failsafe Cleared",
    GLITCH: "Glitch cleared",
    VIBRATION: "Vibration compensation OFF",
}


def text(which: int, on: bool) -> str | None:
    """Status text of a FAILSAFE event, None when there is none."""
    return (_ON if on else _OFF).get(which)


_SUBSYSTEMS = {
    RADIO: LogErrorSubsystem.FAILSAFE_RADIO,
    BATTERY_LOW: LogErrorSubsystem.FAILSAFE_BATT,
    BATTERY_CRITICAL: LogErrorSubsystem.FAILSAFE_BATT,
    GCS: LogErrorSubsystem.FAILSAFE_GCS,
    EKF: LogErrorSubsystem.FAILSAFE_EKFINAV,
    TERRAIN: LogErrorSubsystem.FAILSAFE_TERRAIN,
}


def _logged(v: Any, which: float, on: float) -> list[Row]:
    return [err(_SUBSYSTEMS[int(which)], int(on != 0.0))] if int(which) in _SUBSYSTEMS else []


FAILSAFE = Event(18, log=_logged)  # a: which, b: 1 on (or what follows), 0 off

MISSING = 3
"""Of ``report_battery``, which emits these three by their order; a: voltage, b: charge used [mAh]."""
EVENT_BATTERY_LOW = Event(80, MavSeverity.WARNING, "Battery 1 is low {a:.2f}V used {b:.0f} mAh")
EVENT_BATTERY_CRITICAL = Event(81, MavSeverity.WARNING, "Battery 1 is critical {a:.2f}V used {b:.0f} mAh")
EVENT_BATTERY_MISSING = Event(82, MavSeverity.WARNING, "Battery 1 is missing, last: {a:.2f}V used {b:.0f} mAh")


@law
def report(events: Events, time_us: int, which: int, on: bool) -> None:
    """Emit FAILSAFE."""
    emit(events, time_us, FAILSAFE, float(which), 1.0 if on else 0.0)


@law
def is_radio_bad(rc: Radio, rcmap: RcMap, throttle_min: float) -> bool:
    """Whether a radio that is fitted is silent, or its throttle below ``throttle_min`` [us]."""
    fitted = rc.receiver_us > 0 or rc.has_receiver
    return fitted and (not rc.receiver_ok or stick_pulse(rc, rcmap, THROTTLE) < throttle_min)


@law
def is_gcs_lost(failsafe: Failsafe, time_us: int, params: Failsafes) -> bool:
    """Whether the ground station's heartbeat (``failsafe.gcs_us``, written by the bridge) was there and is missing."""
    last_us = failsafe.gcs_us
    return params.GCS_ENABLE != 0.0 and last_us > 0 and time_us - last_us > params.GCS_TIMEOUT * 1e6


@law
def is_low(voltage: float, limit: float) -> bool:
    """Whether a voltage is below a limit [V]; a limit of zero is off."""
    return limit > 0.0 and voltage < limit


@law
def is_used_up(consumed: float, limit: float, params: Battery) -> bool:
    """Whether less charge than a limit [mAh] is left; off with a limit of zero and without a current sensor."""
    return limit > 0.0 and params.MONITOR >= 4.0 and params.CAPACITY - consumed < limit


@law
def low_since(since_us: int, low: bool, time_us: int) -> int:
    """Since when a voltage has been low: ``since_us``, when it was low before; 0 when it is not low."""
    if not low:
        return 0
    return since_us if since_us != 0 else time_us


@law
def battery_fell_to(fs: Failsafe, battery: BatteryState, armed: bool, time_us: int, params: Battery) -> int:
    """Ten times a second: 1 when the battery has become low, 2 when critical, else 0.

    Both stay (``failsafe.battery``) until the next start.
    """
    if params.MONITOR < 3.0 or not armed:
        fs.battery_low_us = 0
        fs.battery_critical_us = 0
        return 0
    wait = params.LOW_TIMER * 1e6
    before = fs.battery
    low = is_low(battery.voltage, params.CRT_VOLT)
    fs.battery_critical_us = low_since(fs.battery_critical_us, low, time_us)
    lasts = low and time_us - fs.battery_critical_us >= wait
    if fs.battery < 2 and (lasts or is_used_up(battery.consumed_mah, params.CRT_MAH, params)):
        fs.battery = 2
    low = is_low(battery.voltage, params.LOW_VOLT)
    fs.battery_low_us = low_since(fs.battery_low_us, low, time_us)
    lasts = low and time_us - fs.battery_low_us >= wait
    if fs.battery < 1 and (lasts or is_used_up(battery.consumed_mah, params.LOW_MAH, params)):
        fs.battery = 1
    return fs.battery if fs.battery != before else 0


@law
def report_battery(events: Events, time_us: int, level: int, battery: BatteryState) -> None:
    """Report a battery that has become low (``level`` 1) or critical (2), or whose monitor fails (3); 0: nothing."""
    if level == 0:
        return
    emit(events, time_us, EVENT_BATTERY_LOW + level - 1, battery.voltage, battery.consumed_mah)
    report(events, time_us, BATTERY_MISSING if level == MISSING else BATTERY_LOW + level - 1, True)


UNHEALTHY_US = 5_000_000
"""A monitor that fails for longer than this in flight is missing."""


@law
def watch_monitor(fs: Failsafe, battery: BatteryState, armed: bool, events: Events, time_us: int) -> None:
    """Ten times a second: report once that the battery's monitor has failed, unless worse is known of the battery."""
    lasts = time_us - battery.healthy_us > UNHEALTHY_US
    if armed and lasts and battery.driver != 0 and fs.battery == 0 and not fs.battery_missing:
        fs.battery_missing = True
        report_battery(events, time_us, MISSING, battery)


_EKF_PERIOD_S = 0.1


@law
def low_pass(filtered: float, value: float, gain: float) -> float:
    """A low-pass; a value that is not a number (a filter about to restart) is passed over."""
    if value != value:
        return filtered
    return filtered + gain * (value - filtered)


@law
def is_estimate_bad(fs: Failsafe, est: Estimate, limit: float, cutoff: float) -> bool:
    """Whether two test ratios are over ``limit``, or there is no position; called ten times a second.

    Velocity counts double when it is twice over. ``cutoff`` [Hz] of a low-pass of the ratios, 0 none.
    """
    gain = 1.0
    if cutoff > 0.0:
        gain = _EKF_PERIOD_S / (_EKF_PERIOD_S + 1.0 / (TWO_PI * cutoff))
    fs.ekf_vel = low_pass(fs.ekf_vel, est.variance_vel, gain)
    fs.ekf_pos = low_pass(fs.ekf_pos, est.variance_pos, gain)
    fs.ekf_mag = low_pass(fs.ekf_mag, est.variance_mag, gain)
    count = 0
    if fs.ekf_mag >= limit:
        count += 1
    if fs.ekf_vel >= 2.0 * limit:
        count += 2
    elif fs.ekf_vel >= limit:
        count += 1
    if fs.ekf_pos >= limit and count > 0:
        count += 1
    return count >= 2 or not est.position_ok
