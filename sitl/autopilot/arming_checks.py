# SPDX-License-Identifier: BSD-3-Clause
"""Arming: who may ask, the checks that every firmware makes, and the texts of all.

Bits of failed checks are this autopilot's own; texts and their order are those that ArduPilot's users know.
ARMING_CHECK selects which optional checks count.
"""

from __future__ import annotations

from ..core.kernels import law
from . import radio
from .params.parameters import Parameters
from .params.radio import RcMap
from .params.system import Arming
from .state import BatteryState, Radio, Sensors

# Who arms or disarms (ArduPilot's AP_Arming::Method)
BY_RUDDER = 0
BY_MAVLINK = 1
BY_SWITCH = 2
BY_MOTOR_TEST = 3
BY_TERMINATION = 5
BY_BATTERY_FAILSAFE = 7
BY_CRASH = 12
BY_LANDING = 13
BY_MISSION_EXIT = 14
BY_RADIO_FAILSAFE = 16
BY_DELAY = 17
BY_GCS_FAILSAFE = 18

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
AHRS_TYPE = 1048576
EKF_FAILSAFE = 2097152
NO_OUTPUTS = 4194304
WAYPOINT_SPEED = 8388608
THROTTLE_OFF_CENTRE = 16777216
STEERING_OFF_CENTRE = 33554432
MODE_BY_RUDDER = 67108864
NO_MISSION = 536870912
EMERGENCY_STOP = 134217728
INTERLOCK = 268435456


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
    AHRS_TYPE: "AHRS: not using configured AHRS type",
    EKF_FAILSAFE: "EKF failsafe",
    NO_OUTPUTS: "no motor, sail or scripting outputs defined",
    WAYPOINT_SPEED: "WP_SPEED too low",
    THROTTLE_OFF_CENTRE: "Throttle (RC3) is not neutral",
    STEERING_OFF_CENTRE: "Roll (RC1) is not neutral",
    MODE_BY_RUDDER: "Mode not rudder-armable",
    NO_MISSION: "Mode requires mission",
    EMERGENCY_STOP: "Motors Emergency Stopped",
    INTERLOCK: "Motor Interlock Enabled",
}

# ARMING_CHECK
CHECK_ALL, CHECK_BARO, CHECK_COMPASS, CHECK_GPS, CHECK_INS, CHECK_RC, CHECK_BATTERY = 1, 2, 4, 8, 16, 64, 256

_READY_US = 2_450_000
_ACCELS_US = 13_400_000
_GYROS_US = 23_400_000
"""Inertial sensors count as consistent from here on: ten seconds of agreement each, as a real one boots."""


@law
def wants(params: Arming, check: int) -> bool:
    """Whether ARMING_CHECK asks for a check (CHECK_*)."""
    return int(params.CHECK) & (CHECK_ALL | check) != 0


@law
def sensor_checks(time_us: int, sensors: Sensors, attitude_ok: bool, params: Arming) -> int:
    """Failed checks of sensors and attitude."""
    failed = 0
    if time_us < _READY_US:
        failed |= NOT_INITIALISED
    if sensors.baro_count == 0 and wants(params, CHECK_BARO):
        failed |= BAROMETER
    if sensors.mag_count == 0 and wants(params, CHECK_COMPASS):
        failed |= COMPASS
    if wants(params, CHECK_INS):
        if time_us < _ACCELS_US:
            failed |= ACCELS
        elif time_us < _GYROS_US:
            failed |= GYROS
        elif not attitude_ok:
            failed |= ATTITUDE
    return failed


@law
def battery_checks(battery: BatteryState, level: int, params: Parameters) -> int:
    """Failed checks of the battery; ``level``: 0, or what the failsafe found (``failsafe.battery``)."""
    limits = params.BATT
    failed = 0
    if limits.MONITOR > 0.0 and wants(params.ARMING, CHECK_BATTERY):
        if battery.voltage < limits.ARM_VOLT:
            failed |= BATTERY_VOLTAGE
        if limits.ARM_MAH > 0.0 and limits.CAPACITY - battery.consumed_mah < limits.ARM_MAH:
            failed |= BATTERY_CAPACITY
        if level != 0:
            failed |= BATTERY_FAILSAFE
    return failed


@law
def radio_checks(rc: Radio, rcmap: RcMap, throttle_min: float) -> int:
    """Failed checks of the radio, which is lost when the throttle is below ``throttle_min`` [us]."""
    if not rc.receiver_ok:
        return RC_MISSING
    return THROTTLE_FAILSAFE if radio.stick_pulse(rc, rcmap, radio.THROTTLE) < throttle_min else 0


def texts(failed: int, prefix: str = "") -> list[str]:
    """Status texts (MAV_SEVERITY_CRITICAL) of failed checks; ``prefix`` is "PreArm: " or "Arm: "."""
    shown = failed
    if shown & WAITING_FOR_HOME:
        shown &= ~NEED_POSITION  # shown only when it is what is missing
    return [prefix + text for bit, text in TEXTS.items() if shown & bit]
