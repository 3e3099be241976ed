# SPDX-License-Identifier: BSD-3-Clause
"""What the properties of a rover's airframe would be in a log: to judge estimates."""

from __future__ import annotations

import math

from ...core.constants import GRAVITY
from ...vehicles import RoverAirframe
from ...vehicles.properties.ground_vehicle import STEERING_FRONT_WHEELS, STEERING_SKID


def expected(airframe: RoverAirframe) -> dict[str, float]:
    """Properties by name; infinite or not a number: there is none.

    Args:
        airframe: whose outputs -1 .. 1 are the firmware's (SERVOn_MIN, _MAX).
    """

    def value(name: str) -> float:
        return float(airframe.value(name))

    speed, lag, rolling = value("speed_max"), value("time_constant"), value("rolling_resistance")
    loss = lag * rolling * GRAVITY
    held = value("grip") * value("driven_load") * GRAVITY
    accel = min(value("drive_accel") or math.inf, held)
    found = {
        "speed_by_throttle": speed,
        "speed_by_throttle_back": speed,
        "top_speed": speed - loss,
        "top_speed_back": speed - loss,
        "speed_lag": lag,
        "rolling_resistance": rolling,
        "drive_accel": accel,
        "brake_accel": accel + rolling * GRAVITY,
        "grip": value("grip"),
        "rear_axle": value("rear_axle"),
        "battery_resistance": value("battery_resistance"),
        "mass_by_efficiency": value("mass") / value("efficiency") if value("efficiency") else 0.0,
        "power_full": value("power_full"),
        "avionics_current": value("avionics_current"),
    }
    if value("steering_model") == STEERING_SKID:
        track = value("track") * value("track_slip")
        return found | {"turning_track": track, "pivot_rate": 2.0 * (speed - loss) / track, "side_difference": 0.0}
    angle, rate = value("steering_angle"), value("steering_rate")
    if value("steering_model") == STEERING_FRONT_WHEELS:
        bend, gain = math.tan(angle) / value("wheelbase"), angle / value("wheelbase")
    else:
        bend = 2.0 / value("turning_diameter")
        gain = bend * angle / math.sin(angle)
    return found | {
        "turning_radius": 1.0 / bend,
        "steering_gain": gain,
        "steering_trim": 0.0,
        "steering_time": angle / rate if rate else 0.0,
    }
