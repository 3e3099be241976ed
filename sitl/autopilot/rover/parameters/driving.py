# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of the rover's modes: sticks, legs, circles, the way home."""

from __future__ import annotations

from ...params import system
from ...params.parameter import BITS32, INT8, INT16, INT32, ParameterGroup, param


class Circle(ParameterGroup):
    """CIRC_: CIRCLE, and circles in missions."""

    RADIUS: float = param(20.0, 0.0, 1000.0, "m", "Distance from the centre")
    SPEED: float = param(0.0, 0.0, 30.0, "m/s", "Speed around the circle; 0: WP_SPEED")
    DIR: float = param(0, 0, 1, "", "0 clockwise, 1 counter-clockwise", INT8)


class Cruise(ParameterGroup):
    """CRUISE_: the throttle that a speed needs."""

    SPEED: float = param(2.0, 0.0, 100.0, "m/s", "Speed that the vehicle has at CRUISE_THROTTLE")
    THROTTLE: float = param(50, 0, 100, "%", "Throttle that gives CRUISE_SPEED", INT8)


class Dock(ParameterGroup):
    """DOCK_: DOCK."""

    SPEED: float = param(0.0, 0.0, 100.0, "m/s", "Greatest speed; 0: WP_SPEED")
    DIR: float = param(-1.0, -1.0, 360.0, "deg", "Heading in which the dock is entered; -1: none is wanted")
    HDG_CORR_EN: float = param(0, 0, 1, "", "1: the path bends onto the line through the dock at DOCK_DIR", INT8)
    HDG_CORR_WT: float = param(0.75, 0.0, 1.0, "", "How soon: aims so far before the dock, as a share of the distance")
    STOP_DIST: float = param(0.3, 0.0, 2.0, "m", "Stops so far from the dock")


class Loiter(ParameterGroup):
    """LOIT_: LOITER."""

    TYPE: float = param(
        0, 0, 2, "", "Returns to its position: 0 forwards or backwards, 1 always forwards, 2 always backwards", INT8
    )
    RADIUS: float = param(2.0, 0.0, 20.0, "m", "Drifts so far from its position before it returns")
    SPEED_GAIN: float = param(0.5, 0.0, 5.0, "1/s", "Speed of the return for each metre beyond LOIT_RADIUS")


class Manual(ParameterGroup):
    """MANUAL_: MANUAL."""

    OPTIONS: float = param(0, *BITS32, "", "1: steering shrinks with speed, as in the other modes", INT32)
    STR_EXPO: float = param(0.0, -0.5, 0.95, "", "Softness of the steering stick around its middle")


class Mission(system.Mission):
    """MIS_: with the end of a mission."""

    DONE_BEHAVE: float = param(0, 0, 3, "", "Mission complete: 0 stops, 1 loiters, 2 ACRO, 3 MANUAL", INT8)


class Legs(ParameterGroup):
    """WP_: driving along paths."""

    SPEED: float = param(2.0, 0.0, 100.0, "m/s", "Speed along legs")
    RADIUS: float = param(2.0, 0.0, 100.0, "m", "Distance at which a waypoint counts as reached")
    PIVOT_ANGLE: float = param(60, 0, 360, "deg", "Skid steering: turns on the spot from so much on; 0: never", INT16)
    PIVOT_RATE: float = param(60, 0, 360, "deg/s", "Turn rate on the spot", INT16)
    PIVOT_DELAY: float = param(0.0, 0.0, 60.0, "s", "Wait after a turn on the spot")
    ACCEL: float = param(0.0, 0.0, 100.0, "m/s/s", "Acceleration along legs; 0: ATC_ACCEL_MAX")
    JERK: float = param(0.0, 0.0, 100.0, "m/s/s/s", "Jerk along legs; 0: the same number as the acceleration")
