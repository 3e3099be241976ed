# SPDX-License-Identifier: BSD-3-Clause
"""PX4's parameters for a rover of ours, from the properties of its airframe: an Ackermann rover, or a differential one.

Limits are those of the airframe's own ArduPilot parameters, where it has them.
"""

from __future__ import annotations

import math

from ..core.constants import TICK_HZ
from ..core.elementary import tan
from ..vehicles import RoverAirframe
from ..vehicles.properties.ground_vehicle import STEERING_FRONT_WHEELS, STEERING_SKID

ACKERMANN, DIFFERENTIAL = "gz_rover_ackermann", "gz_rover_differential"
"""PX4_SIM_MODEL: airframes of PX4's own, without their simulator."""
_LEFT, _RIGHT, _STEERING = 102, 101, 201
"""Output functions: motors two and one, servo one."""
_SPEED, _ACCELERATION, _RADIUS = 1.0, 1.0, 2.0
"""When the airframe does not say [m/s], [m/s^2], [m]."""


def model(airframe: RoverAirframe) -> str:
    """PX4_SIM_MODEL."""
    return DIFFERENTIAL if int(airframe.value("steering_model")) == STEERING_SKID else ACKERMANN


def parameters(airframe: RoverAirframe) -> dict[str, float]:
    """Parameters with which PX4 drives this airframe; outputs 1 and 3 are steering and throttle, or left and right."""
    own, value = airframe.parameters, airframe.value
    speed = float(own.get("CRUISE_SPEED", _SPEED))
    acceleration = float(own.get("WP_ACCEL", _ACCELERATION))
    length, steering = _steering(airframe)
    values: dict[str, float] = {
        "SIM_GZ_EN": 0,
        "RO_MAX_THR_SPEED": float(value("speed_max")),
        "RO_SPEED_LIM": speed,
        "RO_ACCEL_LIM": acceleration,
        "RO_DECEL_LIM": acceleration,
        "RO_JERK_LIM": 4.0 * acceleration,
        "RO_SPEED_P": 1.0,
        "RO_SPEED_I": 0.5,
        "NAV_ACC_RAD": float(own.get("WP_RADIUS", _RADIUS)),
        "PP_LOOKAHD_MIN": max(length, 0.3),
        "PP_LOOKAHD_MAX": max(5.0 * length, 5.0),
        "BAT1_CAPACITY": 1000.0 * float(value("battery_capacity")) or -1.0,
        **steering,
    }
    values["IMU_INTEG_RATE"] = TICK_HZ
    return values | {"NAV_DLL_ACT": 0, "NAV_RCL_ACT": 0, "COM_RC_IN_MODE": 4}


def _steering(airframe: RoverAirframe) -> tuple[float, dict[str, float]]:
    """A length by which it looks ahead [m], and what its steering is made of."""
    value = airframe.value
    if model(airframe) == DIFFERENTIAL:
        track = float(value("track")) * (float(value("track_slip")) or 1.0)
        return track, {"CA_R_REV": 3, "RD_WHEEL_TRACK": track, "PWM_MAIN_FUNC1": _LEFT, "PWM_MAIN_FUNC3": _RIGHT}
    angle = float(value("steering_angle"))
    if int(value("steering_model")) == STEERING_FRONT_WHEELS:
        wheelbase = float(value("wheelbase"))
    else:  # the one that turns in the same circle
        wheelbase = 0.5 * float(value("turning_diameter")) * tan(angle)
    most = math.degrees(float(airframe.parameters.get("CRUISE_SPEED", _SPEED)) * tan(angle) / wheelbase)
    return wheelbase, {
        "CA_R_REV": 1,
        "RA_WHEEL_BASE": wheelbase,
        "RA_MAX_STR_ANG": angle,
        "RA_STR_RATE_LIM": math.degrees(float(value("steering_rate"))) or -1.0,
        "RA_ACC_RAD_MAX": 2.0 * float(airframe.parameters.get("WP_RADIUS", _RADIUS)),
        "RO_YAW_RATE_LIM": most,
        "PWM_MAIN_FUNC1": _STEERING,
        "PWM_MAIN_FUNC3": _RIGHT,
    }
