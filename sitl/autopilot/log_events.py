# SPDX-License-Identifier: BSD-3-Clause
"""What logs say of an event (EV.Id) and of a failure (ERR.Subsys), by ArduPilot's names and numbers.

https://ardupilot.org/copter/docs/logmessages.html#ev, https://ardupilot.org/copter/docs/logmessages.html#err
"""

from __future__ import annotations

from enum import IntEnum


class LogEvent(IntEnum):
    """EV.Id."""

    ARMED = 10
    DISARMED = 11
    AUTO_ARMED = 15
    LAND_COMPLETE_MAYBE = 17
    LAND_COMPLETE = 18
    LOST_GPS = 19
    SET_HOME = 25
    NOT_LANDED = 28
    AUTOTUNE_INITIALISED = 30
    AUTOTUNE_OFF = 31
    AUTOTUNE_SUCCESS = 33
    AUTOTUNE_FAILED = 34
    AUTOTUNE_REACHED_LIMIT = 35
    AUTOTUNE_PILOT_TESTING = 36
    AUTOTUNE_SAVEDGAINS = 37
    FENCE_ENABLE = 41
    FENCE_DISABLE = 42
    EKF_ALT_RESET = 60
    EKF_YAW_RESET = 62
    FENCE_ALT_MAX_ENABLE = 76
    FENCE_CIRCLE_ENABLE = 78
    FENCE_ALT_MIN_ENABLE = 80
    FENCE_POLYGON_ENABLE = 82


class LogErrorSubsystem(IntEnum):
    """ERR.Subsys."""

    COMPASS = 3
    FAILSAFE_RADIO = 5
    FAILSAFE_BATT = 6
    FAILSAFE_GCS = 8
    FAILSAFE_FENCE = 9
    FLIGHT_MODE = 10
    CRASH_CHECK = 12
    FAILSAFE_EKFINAV = 17
    BARO = 18
    FAILSAFE_TERRAIN = 23
    THRUST_LOSS_CHECK = 25
