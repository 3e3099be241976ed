# SPDX-License-Identifier: BSD-3-Clause
"""Arming: who may ask, the checks that every firmware makes, and the texts of all.

Bits of failed checks are this autopilot's own; texts and their order are those that ArduPilot's users know.
ARMING_CHECK selects which optional checks count.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from enum import IntEnum
from typing import Any

from ..core import border
from ..core.algebra import dot, norm
from ..core.kernels import law
from . import gps_receivers, radio_checks, sensor_calibration
from .avoidance.proximity import SECTORS, Proximity, has_data, sees
from .battery import is_healthy
from .events import Event, Events, Row, emit, ev
from .failsafe_checks import is_low, is_used_up
from .fence import arming as fence_arming
from .log_events import LogEvent
from .notes import ChecksFailed
from .params.firmware_parameters import Parameters
from .params.system import Arming, Compass
from .radio_checks import RC_MISSING, THROTTLE_FAILSAFE
from .sensor_calibration import differs, is_received, shown_field
from .state import Arming as ArmingState
from .state import BatteryState, Sensors, Vehicle


class ArmingMethod(IntEnum):
    """Who arms or disarms: ArduPilot's AP_Arming::Method, which its logs carry."""

    RUDDER = 0
    MAVLINK = 1
    SWITCH = 2
    MOTOR_TEST = 3
    TERMINATION = 5
    BATTERY_FAILSAFE = 7
    CRASH = 12
    LANDING = 13
    MISSION_EXIT = 14
    FENCE = 15
    RADIO_FAILSAFE = 16
    DELAY = 17
    GCS_FAILSAFE = 18
    TERRAIN_FAILSAFE = 19
    PARACHUTE = 34


# Checks (those of the radio: radio_checks.py)
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
RECEIVERS = 8388608
MODE_BY_RUDDER = 67108864
NO_MISSION = 536870912
EMERGENCY_STOP = 134217728
INTERLOCK = 268435456
BATTERY_UNHEALTHY = 1 << 30
BATTERY_CAPACITY_FAILSAFE = 1 << 31
BATTERY_CRITICAL_VOLTAGE = 1 << 32
BATTERY_CRITICAL_CAPACITY = 1 << 33
RADIO_FAILSAFE = 1 << 34
GCS_FAILSAFE = 1 << 35
COMPASSES = 1 << 36
FENCE_POSITION = 1 << 37
FENCE_SHIFT = 38
"""Five bits from here on are a number: why the fence refuses (``fence.arming``)."""
NOTHING_SEEN = 1 << 43
OBSTACLE_SHIFT = 44
"""Nine bits from here on: an obstacle is too near; its sector, and its distance [cm] in the upper six."""
CALIBRATING_COMPASS, REBOOT_FOR_COMPASS, REBOOT_FOR_ACCELS = 1 << 53, 1 << 54, 1 << 55
PARACHUTE_RELEASED = 1 << 60
ACCELS_SILENT, GYROS_SILENT = 1 << 61, 1 << 62

TEXTS = {
    NOT_INITIALISED: "System not initialised",
    BAROMETER: "Baro: not healthy",
    COMPASS: "Compass 1 not healthy",
    COMPASSES: "Compasses inconsistent",
    FENCE_POSITION: "Fence enabled, need position estimate",
    CALIBRATING_COMPASS: "Compass calibration running",
    REBOOT_FOR_COMPASS: "Compass calibrated requires reboot",
    REBOOT_FOR_ACCELS: "Accels calibrated requires reboot",
    ACCELS_SILENT: "Accels not healthy",
    GYROS_SILENT: "Gyros not healthy",
    PARACHUTE_RELEASED: "Chute is released",
    ACCELS: "Accels inconsistent",
    GYROS: "Gyros inconsistent",
    ATTITUDE: "EKF attitude is bad",
    LEANING: "Leaning",
    GPS_FIX: "GPS 1: Bad fix",
    RECEIVERS: "GPS 2: Bad fix",
    WAITING_FOR_HOME: "AHRS: waiting for home",
    NEED_POSITION: "Need Position Estimate",
    NEED_ALTITUDE: "Need Alt Estimate",
    RC_MISSING: "RC not found",
    THROTTLE_FAILSAFE: "Throttle below failsafe",
    THROTTLE_HIGH: "Throttle too high",
    BATTERY_VOLTAGE: "Battery 1 below minimum arming voltage",
    BATTERY_CAPACITY: "Battery 1 below minimum arming capacity",
    BATTERY_FAILSAFE: "Battery 1 low voltage failsafe",
    BATTERY_UNHEALTHY: "Battery 1 unhealthy",
    BATTERY_CAPACITY_FAILSAFE: "Battery 1 low capacity failsafe",
    BATTERY_CRITICAL_VOLTAGE: "Battery 1 critical voltage failsafe",
    BATTERY_CRITICAL_CAPACITY: "Battery 1 critical capacity failsafe",
    RADIO_FAILSAFE: "Radio failsafe on",
    GCS_FAILSAFE: "GCS failsafe on",
    FRAME: "Motors: Check frame class and type",
    MODE: "Mode not armable",
    RUDDER_DISABLED: "Rudder arming disabled",
    AHRS_TYPE: "AHRS: not using configured AHRS type",
    EKF_FAILSAFE: "EKF failsafe",
    NO_OUTPUTS: "no motor, sail or scripting outputs defined",
    MODE_BY_RUDDER: "Mode not rudder-armable",
    NO_MISSION: "Mode requires mission",
    EMERGENCY_STOP: "Motors Emergency Stopped",
    INTERLOCK: "Motor Interlock Enabled",
    NOTHING_SEEN: "PRX1: No Data",
}

# ARMING_CHECK
CHECK_ALL, CHECK_BARO, CHECK_COMPASS, CHECK_GPS, CHECK_INS, CHECK_RC, CHECK_BATTERY = 1, 2, 4, 8, 16, 64, 256
CHECK_PARAMETERS, CHECK_MISSION, CHECK_RANGEFINDER, CHECK_CAMERA = 32, 1 << 14, 1 << 15, 1 << 16

_LOW_BITS, _METHOD_BITS = 48, 5
"""Of failed checks in the first number of ARMING_REFUSED, and of the method in the second, below the others."""

OBSTACLE_CLEARANCE = 0.6
"""Clearance that a copter with a proximity sensor needs around it [m]."""
ACC_DIFFERENCE, GYRO_DIFFERENCE = 0.75, math.radians(5.0)
"""Greatest differences of what two IMUs show [m/s^2], [rad/s]."""
_BARO_US = 500_000
"""A barometer that is silent for longer is not healthy."""
_READY_US = 2_450_000
_AGREE_US = 10_000_000
_ACCELS_US = 13_400_000
_GYROS_US = 23_400_000
"""Inertial sensors count as consistent from here on: ten seconds of agreement each, as a real one boots."""


@law
def refuse(events: Events, time_us: int, failed: int, method: int) -> None:
    """Tell that arming by ``method`` was refused, and why: more bits than one number of an event can hold."""
    low = failed & ((1 << _LOW_BITS) - 1)
    emit(events, time_us, ARMING_REFUSED, float(low), float(failed >> _LOW_BITS << _METHOD_BITS | method))


def refusal(a: float, b: float) -> tuple[int, int]:
    """The bits of failed checks and the method of an event ARMING_REFUSED with these two numbers."""
    return int(b) >> _METHOD_BITS << _LOW_BITS | int(a), int(b) & ((1 << _METHOD_BITS) - 1)


def _refusal_notes(v: Any, a: float, b: float) -> list[ChecksFailed]:
    failed, method = refusal(a, b)
    return [] if method == ArmingMethod.MAVLINK else [ChecksFailed(failed)]  # a command reports its own


def _arm(v: Any, is_armed: bool, method: float) -> Row:
    return "ARM", (int(is_armed), int(v.autopilot.params.ARMING.CHECK) & 0xFFFFFFFF, 0, int(method) & 255)


ARMED = Event(1, log=lambda v, a, b: [_arm(v, True, a), ev(LogEvent.ARMED)])  # a: method
DISARMED = Event(2, log=lambda v, a, b: [_arm(v, False, a), ev(LogEvent.DISARMED)])  # a: method
ARMING_REFUSED = Event(20, says=_refusal_notes)  # a and b: see ``refusal``


@law
def wants(params: Arming, check: int) -> bool:
    """Whether ARMING_CHECK asks for a check (CHECK_*)."""
    return int(params.CHECK) & (CHECK_ALL | check) != 0


@law
def compass_checks(sensors: Sensors, params: Compass) -> int:
    """Failed checks of the compasses against each other; those that are missing or not in use do not count."""
    first, second, third = shown_field(0, sensors, params), sensors.mag2, sensors.mag3
    if params.USE2 > 0.0 and dot(second, second) > 0.0 and differs(first, shown_field(1, sensors, params)):
        return COMPASSES
    if params.USE3 > 0.0 and dot(third, third) > 0.0 and differs(first, shown_field(2, sensors, params)):
        return COMPASSES
    return 0


@law
def calibration_checks(state: int, params: Arming) -> int:
    """Failed checks of the sensors' calibration (``Calibrated.state``)."""
    failed = 0
    if wants(params, CHECK_COMPASS):
        if state & sensor_calibration.COMPASS_RUNNING:
            failed |= CALIBRATING_COMPASS
        elif state & sensor_calibration.COMPASS_DONE:
            failed |= REBOOT_FOR_COMPASS
    if wants(params, CHECK_INS) and state & sensor_calibration.ACCELS_DONE:
        failed |= REBOOT_FOR_ACCELS
    return failed


@law
def parameter_checks(state: int) -> int:
    """Failed checks of parameters, which Python has made (``Calibrated.state``)."""
    return radio_checks.PARAMETERS if state & sensor_calibration.PARAMETERS_BAD else 0


@law
def switch_checks(state: int, receiver_ok: bool) -> int:
    """The same of switches on channels, at the moment of arming."""
    return radio_checks.PARAMETERS if receiver_ok and state & sensor_calibration.SWITCHES_BAD else 0


@law
def imu_checks(arming: ArmingState, sensors: Sensors, time_us: int) -> int:
    """Failed checks of two IMUs that show different things, or did ten seconds ago, or of which one is silent."""
    state = sensors.imu_state
    if state & 3 * border.ACC_SILENT:
        return ACCELS_SILENT
    if state != 0 and norm(sensors.acc2 - sensors.acc) > ACC_DIFFERENCE:
        arming.accels_apart_us = time_us
    if arming.accels_apart_us > 0 and time_us - arming.accels_apart_us < _AGREE_US:
        return ACCELS
    if state & 3 * border.GYRO_SILENT:
        return GYROS_SILENT
    if state != 0 and norm(sensors.gyro2 - sensors.gyro) > GYRO_DIFFERENCE:
        arming.gyros_apart_us = time_us
    return GYROS if arming.gyros_apart_us > 0 and time_us - arming.gyros_apart_us < _AGREE_US else 0


@law
def sensor_checks(v: Vehicle) -> int:
    """Failed checks of sensors and attitude."""
    ap, sensors, time_us = v.autopilot, v.sensors, v.time_us
    failed, p = 0, ap.params
    params = p.ARMING
    if time_us < _READY_US:
        failed |= NOT_INITIALISED
    received_us = ap.ekf.baro_us  # by the filter; 0 never
    silent = received_us > 0 and time_us - received_us > _BARO_US
    if (sensors.baro_count == 0 or silent) and wants(params, CHECK_BARO):
        failed |= BAROMETER
    if not is_received(0, sensors, time_us) and wants(params, CHECK_COMPASS):
        failed |= COMPASS
    elif wants(params, CHECK_COMPASS):
        failed |= compass_checks(sensors, p.COMPASS)
    if wants(params, CHECK_INS):
        if time_us < _ACCELS_US:
            failed |= ACCELS
        elif time_us < _GYROS_US:
            failed |= GYROS
        else:
            apart = imu_checks(ap.arming, sensors, time_us)
            failed |= apart if apart != 0 or ap.estimate.attitude_ok or sensors.imu_state != 0 else ATTITUDE
    return failed


@law
def receiver_checks(sensors: Sensors, params: Parameters) -> int:
    """``RECEIVERS`` when two GPS receivers cannot be used together; there is no blending of their fixes."""
    if params.GPS2_TYPE == 0.0:
        return 0
    fits = params.GPS_AUTO_SWITCH != gps_receivers.BLEND and gps_receivers.has_fix(1, sensors)
    apart = gps_receivers.has_fix(0, sensors) and gps_receivers.distance(sensors) >= gps_receivers.DIFFERENCE
    return RECEIVERS if apart or not fits else 0


def receiver_texts(sensors: Sensors, params: Parameters) -> dict[int, str]:
    """What is wrong with two receivers: the text of ``RECEIVERS``."""
    if params.GPS_AUTO_SWITCH == gps_receivers.BLEND:
        text = "GPS blending unhealthy"
    elif not gps_receivers.has_fix(1, sensors):
        text = "GPS 2: Bad fix"
    else:
        text = f"GPS positions differ by {gps_receivers.distance(sensors):4.1f}m"
    return {RECEIVERS: text}


@law
def battery_checks(battery: BatteryState, level: int, params: Parameters) -> int:
    """The first failed check of the battery; ``level``: 0, or what the failsafe found (``failsafe.battery``)."""
    limits = params.BATT
    if not wants(params.ARMING, CHECK_BATTERY):
        return 0
    if not is_healthy(battery.driver, limits):
        return BATTERY_UNHEALTHY
    if battery.driver == 0:
        return 0
    voltage, used = battery.voltage, battery.consumed_mah
    if is_low(voltage, limits.ARM_VOLT):
        return BATTERY_VOLTAGE
    if is_used_up(used, limits.ARM_MAH, limits):
        return BATTERY_CAPACITY
    if level != 0 or is_low(voltage, limits.LOW_VOLT):
        return BATTERY_FAILSAFE
    if is_used_up(used, limits.LOW_MAH, limits):
        return BATTERY_CAPACITY_FAILSAFE
    if is_low(voltage, limits.CRT_VOLT):
        return BATTERY_CRITICAL_VOLTAGE
    if is_used_up(used, limits.CRT_MAH, limits):
        return BATTERY_CRITICAL_CAPACITY
    return 0


@law
def proximity_checks(seen: Proximity, time_us: int) -> int:
    """Failed checks of a proximity sensor."""
    return NOTHING_SEEN if seen.kind != 0 and not has_data(seen, time_us) else 0


@law
def obstacle_check(seen: Proximity, time_us: int) -> int:
    """Failed check of what is nearest around the vehicle."""
    sector, nearest = 0, math.inf
    for k in range(SECTORS):
        if sees(seen, k, time_us) and seen.distance[k] < nearest:
            sector, nearest = k, float(seen.distance[k])
    return (max(int(nearest * 100.0), 1) << 3 | sector) << OBSTACLE_SHIFT if nearest <= OBSTACLE_CLEARANCE else 0


def obstacle_text(found: int) -> str:
    """Status text of an obstacle that is too near."""
    return f"Proximity {(found & 7) * 45} deg, {(found >> 3) * 0.01:.2f}m (want > {OBSTACLE_CLEARANCE:.1f}m)"


def texts(failed: int, params: Parameters, prefix: str = "", own: Mapping[int, str] | None = None) -> list[str]:
    """Status texts (MAV_SEVERITY_CRITICAL) of failed checks.

    Args:
        failed: their bits.
        params: the vehicle's parameters.
        prefix: "PreArm: " or "Arm: ".
        own: texts of the firmware's own checks, in place of another one's.
    """
    shown = failed
    if shown & WAITING_FOR_HOME:
        shown &= ~NEED_POSITION  # shown only when it is what is missing
    said = [text for bit, text in {**TEXTS, **(own or {})}.items() if shown & bit]
    said += radio_checks.texts(failed, params)
    fence, obstacle = failed >> FENCE_SHIFT & 31, failed >> OBSTACLE_SHIFT & 511
    said += ([fence_arming.text(fence)] if fence else []) + ([obstacle_text(obstacle)] if obstacle else [])
    return [prefix + text for text in said]
