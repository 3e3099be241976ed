# SPDX-License-Identifier: BSD-3-Clause
"""A rover's properties by name, unit and meaning."""

from __future__ import annotations

from ..estimate import Sought

FORWARD = Sought("speed_by_throttle", "m/s", "forward speed that full throttle stands for, without load")
BACKWARD = Sought("speed_by_throttle_back", "m/s", "the same backwards")
TOP = Sought("top_speed", "m/s", "speed at full throttle")
TOP_BACK = Sought("top_speed_back", "m/s", "the same backwards")
LAG = Sought("speed_lag", "s", "time constant of the speed after the throttle")
ROLLING = Sought("rolling_resistance", "", "resisting force by weight")
MOTORS = Sought("drive_accel", "m/s^2", "strongest acceleration that the motors give")
BRAKE = Sought("brake_accel", "m/s^2", "strongest deceleration")
RADIUS = Sought("turning_radius", "m", "of the driven axle's path at full steering")
GAIN = Sought("steering_gain", "1/m", "curvature by steering output, about straight on")
TRIM = Sought("steering_trim", "", "steering output (-1 .. 1) at which it drives straight on")
SERVO = Sought("steering_time", "s", "of the steering servo from straight on to full")
TRACK = Sought(
    "turning_track", "m", "difference of the sides' speeds by yaw rate: the track, and more since wheels scrub"
)
PIVOT = Sought("pivot_rate", "rad/s", "yaw rate on the spot at full outputs")
DIFFER = Sought("side_difference", "", "part by which left motors are faster than the mean of both sides")
GRIP = Sought("grip", "", "greatest force of the tyres by weight")
AXLE = Sought("rear_axle", "m", "from the axle that does not steer forward to the autopilot")
VOLTAGE = Sought("battery_voltage", "V", "highest voltage of the battery at rest")
LOAD = Sought("mass_by_efficiency", "kg", "battery's power by the motors' work of each kilogram")
FULL = Sought("power_full", "W", "drawn at full throttle whatever the load")
ELECTRONICS = Sought("avionics_current", "A", "drawn by all that is no motor")
