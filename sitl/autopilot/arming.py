# SPDX-License-Identifier: BSD-3-Clause
"""Arming and disarming: the checks, their texts, and the rules.

Bits of failed checks are this firmware's own; texts and their order are those that ArduPilot's users know. ARMING_CHECK selects
which optional checks count; forcing skips all but the estimate that the mode itself cannot do without.
"""

from __future__ import annotations

import math
from typing import Any

from ..core.kernels import law
from . import home, pilot
from .events import ARMED, ARMING_REFUSED, DISARMED, emit, emit_and_return
from .modes.copter.numbers import AUTO, BRAKE, GUIDED, LAND, RTL, has_manual_throttle, requires_position

# Who arms or disarms (ArduPilot's AP_Arming::Method)
BY_RUDDER = 0
BY_MAVLINK = 1
BY_TERMINATION = 5
BY_BATTERY_FAILSAFE = 7
BY_CRASH = 12
BY_LANDING = 13
BY_MISSION_EXIT = 14
BY_RADIO_FAILSAFE = 16
BY_DELAY = 17
BY_GCS_FAILSAFE = 18
BY_EKF_FAILSAFE = 19

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
ARMING_DELAY_US = 2_000_000
"""Motors stay off for so long after arming."""
_ARM_ONLY = 1  # AUTO_OPTIONS and GUID_OPTIONS: arming in AUTO; arming by transmitter in GUIDED


@law
def mode_allows(v, method):
    """Whether the present mode may be armed by ``method``."""
    ap = v.autopilot
    mode = ap.modes.number
    if mode == RTL or mode == LAND or mode == BRAKE:
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


@law
def update(v):
    """Keep ``arming.prearm_ok`` up to date; called about once a second."""
    failed = check(v)
    v.autopilot.modes.arming_failures = failed
    v.autopilot.arming.prearm_ok = 1 if failed == 0 else 0


@law
def try_arm(v, method, force):
    """Arm unless checks fail. Returns the bits of the failed ones, 0 when armed (or armed already)."""
    ap = v.autopilot
    if ap.arming.armed != 0:
        return 0
    failed = check_now(v, method)
    ap.modes.arming_failures = failed
    if (force == 0 and failed != 0) or (failed & MANDATORY) != 0:
        emit(ap.events, v.time_us, ARMING_REFUSED, float(failed), float(method))
        return failed
    if ap.home.locked == 0:
        home.set_here(v)
    ap.arming.armed = 1
    ap.arming.armed_us = v.time_us
    ap.arming.auto_armed = 0
    ap.arming.landed = 1
    ap.arming.landed_maybe = 1
    ap.arming.landed_ticks = 0
    ap.arming.idle_us = v.time_us
    ap.arming.crash_ticks = 0
    ap.modes.arming_delay = 1
    ap.modes.takeoff.user_active = 0
    emit(ap.events, v.time_us, ARMED, float(method), 0.0)
    return 0


@law
def may_disarm(v, method):
    """Whether ``method`` may disarm now: not in the air by command, nor by stick unless the stick is the throttle."""
    ap = v.autopilot
    if method == BY_MAVLINK:
        return ap.arming.landed != 0
    if method == BY_RUDDER:
        return ap.arming.landed != 0 or has_manual_throttle(int(ap.modes.number))
    return True


@law
def disarm(v, method, force):
    """Disarm. Returns 1 when disarmed (or disarmed already), 0 when refused."""
    ap = v.autopilot
    if ap.arming.armed == 0:
        return 1
    if force == 0 and not may_disarm(v, method):
        return 0
    ap.arming.armed = 0
    ap.arming.disarmed_us = v.time_us
    ap.arming.auto_armed = 0
    ap.arming.landed = 1
    ap.arming.landed_maybe = 1
    ap.arming.landed_ticks = 0
    ap.arming.crash_ticks = 0
    ap.modes.arming_delay = 0
    ap.modes.takeoff.user_active = 0
    ap.modes.auto.started = 0
    ap.control.motors.desired_spool = 0
    emit_and_return(ap.events, v.time_us, DISARMED, float(method), 0.0)  # the mission goes back to its start
    return 1


@law
def update_armed(v):
    """Every tick: end of the arming delay, and whether the vehicle was told to fly since arming."""
    ap = v.autopilot
    arming = ap.arming
    if arming.armed == 0:
        arming.auto_armed = 0
        return
    if ap.modes.arming_delay != 0 and v.time_us - arming.armed_us >= ARMING_DELAY_US:
        ap.modes.arming_delay = 0
    throttle_zero = ap.modes.pilot.throttle_zero != 0
    if arming.auto_armed == 0:
        if not throttle_zero:
            arming.auto_armed = 1
    elif has_manual_throttle(int(ap.modes.number)) and throttle_zero and ap.modes.failsafe.radio == 0:
        arming.auto_armed = 0


@law
def update_delay(v):
    """Disarm what was armed on the ground and left alone for DISARM_DELAY; called ten times a second."""
    ap = v.autopilot
    delay = ap.params.DISARM_DELAY
    idle = ap.arming.landed != 0 and ap.modes.pilot.throttle_zero != 0 and ap.control.motors.spool_state <= 1
    if ap.arming.armed == 0 or delay <= 0.0 or not idle:
        ap.arming.idle_us = v.time_us
    elif v.time_us - ap.arming.idle_us >= delay * 1e6:
        disarm(v, BY_DELAY, 0)


def texts(failed: int, prefix: str = "") -> list[str]:
    """Status texts (MAV_SEVERITY_CRITICAL) of failed checks; ArduPilot puts "PreArm: " or "Arm: " before them."""
    shown = failed
    if shown & WAITING_FOR_HOME:
        shown &= ~NEED_POSITION  # said only when it is what is missing
    return [prefix + text for bit, text in TEXTS.items() if shown & bit]


def arm(v: Any, method: int, force: bool) -> tuple[bool, list[str]]:
    """Arm from the shell: whether it worked, and the texts for the user when it did not."""
    failed = try_arm(v, method, 1 if force else 0)
    if v.autopilot.arming.armed:
        return True, []
    first = failed & MANDATORY if force else 0
    return False, texts(first, "Arm: ") + texts(failed & ~first, "Arm: ")
