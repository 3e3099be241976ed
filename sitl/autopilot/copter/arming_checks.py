# SPDX-License-Identifier: BSD-3-Clause
"""Arming checks and their texts.

Bits of failed checks are this firmware's own; texts and their order are those that ArduPilot's users know.
ARMING_CHECK selects which optional checks count; forcing skips all but the estimate that the mode itself
cannot do without.
"""

from __future__ import annotations

import math

from ..core.kernels import law
from . import pilot
from .modes.copter.numbers import AUTO, BRAKE, GUIDED, LAND, RTL, has_manual_throttle, requires_position

# Who arms or disarms (ArduPilot's AP_Arming::Method)
BY_RUDDER = 0
BY_MAVLINK = 1

# Checks
NOT_INITIALISED = 1
BAROMETER = 2
COMPASS = 4
ACCELS = 8
GYROS = 16
ATTITUDE = 32
LEANING = 64
GPS_FIX = 128
WAITING_FOR_HOME = 256
NEED_POSITION = 512
NEED_ALTITUDE = 1024
RC_MISSING = 2048
THROTTLE_FAILSAFE = 4096
THROTTLE_HIGH = 8192
BATTERY_VOLTAGE = 16384
BATTERY_CAPACITY = 32768
BATTERY_FAILSAFE = 65536
FRAME = 131072
MODE = 262144
RUDDER_DISABLED = 524288

MANDATORY = NEED_POSITION | NEED_ALTITUDE
"""What forcing does not skip."""

TEXTS = {
    NOT_INITIALISED: "System not initialised",
    BAROMETER: "Barometer not healthy",
    COMPASS: "Compass not healthy",
    ACCELS: "Accels inconsistent",
    GYROS: "Gyros inconsistent",
    ATTITUDE: "EKF attitude is bad",
    LEANING: "Leaning",
    GPS_FIX: "GPS 1: Bad fix",
    WAITING_FOR_HOME: "AHRS: waiting for home",
    NEED_POSITION: "Need Position Estimate",
    NEED_ALTITUDE: "Need Alt Estimate",
    RC_MISSING: "RC not found",
    THROTTLE_FAILSAFE: "Throttle below failsafe",
    THROTTLE_HIGH: "Throttle too high",
    BATTERY_VOLTAGE: "Battery 1 below minimum arming voltage",
    BATTERY_CAPACITY: "Battery 1 below minimum arming capacity",
    BATTERY_FAILSAFE: "Battery 1 low voltage failsafe",
    FRAME: "Motors: Check frame class and type",
    MODE: "Mode not armable",
    RUDDER_DISABLED: "Rudder arming disabled",
}

# ARMING_CHECK bits
_ALL, _BARO, _COMPASS, _GPS, _INS, _RC, _BATTERY = 1, 2, 4, 8, 16, 64, 256

_READY_US = 2_450_000
_ACCELS_US = 13_400_000
_GYROS_US = 23_400_000
"""Inertial sensors count as consistent from here on: ten seconds of agreement each, as a real one boots."""
_ARM_ONLY = 1  # AUTO_OPTIONS and GUID_OPTIONS: arming in AUTO; arming by transmitter in GUIDED


@law
def mode_allows(v, method):
    """Whether the present mode may be armed by ``method``."""
    ap = v.autopilot
    mode = ap.modes.number
    if mode in (RTL, LAND, BRAKE):
        return False
    if mode == AUTO:
        return (int(ap.params.AUTO_OPTIONS) & _ARM_ONLY) != 0
    if mode == GUIDED:
        return method != BY_RUDDER or (int(ap.params.GUID_OPTIONS) & _ARM_ONLY) != 0
    return True


@law
def sensor_checks(v):
    """Failed checks of sensors and attitude."""
    ap = v.autopilot
    p = ap.params
    selected = int(p.ARMING_CHECK)
    every = (selected & _ALL) != 0
    failed = 0
    if v.time_us < _READY_US:
        failed |= NOT_INITIALISED
    if (every or (selected & _BARO) != 0) and v.sensors.baro_count == 0:
        failed |= BAROMETER
    if (every or (selected & _COMPASS) != 0) and v.sensors.mag_count == 0:
        failed |= COMPASS
    if every or (selected & _INS) != 0:
        if v.time_us < _ACCELS_US:
            failed |= ACCELS
        elif v.time_us < _GYROS_US:
            failed |= GYROS
        elif ap.estimate.attitude_ok == 0:
            failed |= ATTITUDE
    if ap.control.attitude.cos_lean < math.cos(math.radians(p.ANGLE_MAX * 0.01)):
        failed |= LEANING
    return failed


@law
def estimate_checks(v):
    """Failed checks of position, height and home, as far as the mode needs them."""
    ap = v.autopilot
    selected = int(ap.params.ARMING_CHECK)
    gps = (selected & (_ALL | _GPS)) != 0
    failed = 0
    mode = int(ap.modes.number)
    if requires_position(mode):
        if ap.home.is_set == 0 and gps:
            failed |= WAITING_FOR_HOME
        elif v.sensors.gps_fix < 3 and gps:
            failed |= GPS_FIX
        if ap.estimate.position_ok == 0:
            failed |= NEED_POSITION
    if not has_manual_throttle(mode) and ap.estimate.attitude_ok == 0:
        failed |= NEED_ALTITUDE
    return failed


@law
def equipment_checks(v):
    """Failed checks of radio, battery and frame."""
    ap = v.autopilot
    p = ap.params
    selected = int(p.ARMING_CHECK)
    every = (selected & _ALL) != 0
    failed = 0
    if (every or (selected & _RC) != 0) and p.FS_THR_ENABLE > 0.0:
        if ap.rc.receiver_ok == 0:
            failed |= RC_MISSING
        elif ap.rc.channels[pilot.stick_channel(p, 2) - 1] < p.FS_THR_VALUE:
            failed |= THROTTLE_FAILSAFE
    if (every or (selected & _BATTERY) != 0) and p.BATT_MONITOR > 0.0:
        if ap.battery.voltage < p.BATT_ARM_VOLT:
            failed |= BATTERY_VOLTAGE
        left = p.BATT_CAPACITY - ap.battery.consumed_mah
        if p.BATT_ARM_MAH > 0.0 and left < p.BATT_ARM_MAH:
            failed |= BATTERY_CAPACITY
        if ap.modes.failsafe.battery != 0:
            failed |= BATTERY_FAILSAFE
    if p.FRAME_CLASS != 1.0:
        failed |= FRAME
    return failed


@law
def check(v):
    """Failed checks before arming, 0 when the vehicle is ready (in its present mode)."""
    return sensor_checks(v) | estimate_checks(v) | equipment_checks(v)


@law
def arm_checks(v, method):
    """Failed checks that count only at the moment of arming."""
    ap = v.autopilot
    failed = 0
    mode = int(ap.modes.number)
    if not mode_allows(v, method):
        failed |= MODE
    if method == BY_RUDDER and ap.params.ARMING_RUDDER < 1.0:
        failed |= RUDDER_DISABLED
    if method != BY_MAVLINK or (mode != GUIDED and mode != AUTO):
        if has_manual_throttle(mode):
            if ap.modes.pilot.throttle > 0.0:
                failed |= THROTTLE_HIGH
        elif pilot.climb_rate(ap) > 0.0:
            failed |= THROTTLE_HIGH
    return failed


@law
def check_now(v, method):
    """All failed checks of arming at this moment by ``method``."""
    return check(v) | arm_checks(v, method)


def texts(failed: int, prefix: str = "") -> list[str]:
    """Status texts (MAV_SEVERITY_CRITICAL) of failed checks; ``prefix`` is "PreArm: " or "Arm: "."""
    shown = failed
    if shown & WAITING_FOR_HOME:
        shown &= ~NEED_POSITION  # said only when it is what is missing
    return [prefix + text for bit, text in TEXTS.items() if shown & bit]
