# SPDX-License-Identifier: BSD-3-Clause
"""Figures of a ground vehicle on wheels; the origin, where the IMU is, lies on its middle line."""

from __future__ import annotations

import math

from .battery import BATTERY
from .body import BODY, OUTLINE
from .figure import Figure, figures_record
from .ranging import RANGING
from .sensors import SENSORS

STEERING_FRONT_WHEELS = 0
"""Steering model: a bicycle, whose rear axle runs on a circle of wheelbase / tan(angle)."""
STEERING_TURNING_CIRCLE = 1
"""Steering model of ArduPilot's SITL rover: turning circle of diameter * sin(angle_max) / sin(angle)."""
STEERING_SKID = 2
"""Steering model: left and right wheels driven apart."""

_CAR = (STEERING_FRONT_WHEELS,)
_CIRCLE = (STEERING_TURNING_CIRCLE,)
_ANGLED = (STEERING_FRONT_WHEELS, STEERING_TURNING_CIRCLE)
_SKID = (STEERING_SKID,)

MODEL = "steering_model"
"""The figure that says which of the others are needed."""

DRIVE = (
    Figure("control_full", "", "actuator control that gives full steering and full throttle", 0.01, 1.0),
    Figure("speed_max", "m/s", "rolling speed of a free wheel at full throttle", 1e-3, 100.0),
    Figure("time_constant", "s", "first-order lag of the wheel speed, 0 none", default=0.0),
    Figure("drive_accel", "m/s^2", "strongest acceleration and braking that the motors give, 0 unlimited", default=0.0),
    Figure("rolling_resistance", "", "resisting force by weight", 0.0, 1.0, 0.0),
    Figure("efficiency", "", "share of the battery's power that drives; 0: only power_full is drawn", 0.0, 1.0),
    Figure("power_full", "W", "drawn at full throttle whatever the load", default=0.0),
)

TYRES = (
    Figure("grip", "", "friction of the tyres: greatest force by weight, along and across together", 0.01, 1e4),
    Figure("driven_load", "", "share of the weight on the driven wheels", 0.01, 1.0, 1.0),
)

STEERING = (
    Figure(MODEL, "", "STEERING_FRONT_WHEELS 0, STEERING_TURNING_CIRCLE 1 or STEERING_SKID 2", 0, 2, whole=True),
    Figure("rear_axle", "m", "from the driven axle that does not steer forward to the origin", -10.0, 10.0, 0.0),
    Figure("wheelbase", "m", "between the axles", 0.01, 20.0, models=_CAR),
    Figure("front_load", "", "share of the weight on the front axle", 0.01, 0.99, models=_CAR),
    Figure("track", "m", "between the left and the right driven wheel", 0.01, 20.0),
    Figure("steering_angle", "rad", "of the front wheels at full steering", 0.01, math.radians(80.0), models=_ANGLED),
    Figure("steering_rate", "rad/s", "fastest turn of the front wheels, 0 unlimited", default=0.0),
    Figure("turning_diameter", "m", "of the circle at full steering", 0.01, 1000.0, models=_CIRCLE),
    Figure("track_slip", "", "track that the yaw rate follows by the true one: wheels scrub", 1.0, 10.0, models=_SKID),
)

CHASSIS = (  # for engines that build the vehicle of parts; native physics has no use for them
    Figure("wheel_radius", "m", "of the wheels, 0: a sixth of the wheelbase", default=0.0),
    Figure("centre_height", "m", "of the centre of mass over the floor, 0: one and a half wheel radii", default=0.0),
)

ENCODERS = (
    Figure("encoder_rate", "Hz", "samples a second of the wheel encoders, 0 none", 0.0, 200.0, 0.0),
    Figure("encoder_step", "m", "travel of the rim a count, 0 continuous", default=0.0),
)

FIGURES = (*BODY, *DRIVE, *TYRES, *STEERING, *CHASSIS, *BATTERY, *SENSORS, *ENCODERS, *OUTLINE, *RANGING)
FIGURES_RECORD = figures_record("Rover", FIGURES)
