# SPDX-License-Identifier: BSD-3-Clause
"""Properties of a ground vehicle on wheels; the origin, where the IMU is, lies on its middle line."""

from __future__ import annotations

import math

from ...core.records import Record
from . import body
from .body import Battery, Body, Outline, Ranging, Sensors
from .property import described

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
"""The property that says which of the others are needed."""


class Drive(Record):
    """Motors."""

    control_full: float = described("", "actuator control that gives full steering and full throttle", 0.01, 1.0)
    speed_max: float = described("m/s", "rolling speed of a free wheel at full throttle", 0.001, 100.0)
    time_constant: float = described("s", "first-order lag of the wheel speed, 0 none", default=0.0)
    drive_accel: float = described(
        "m/s^2", "strongest acceleration and braking that the motors give, 0 unlimited", default=0.0
    )
    rolling_resistance: float = described("", "resisting force by weight", 0.0, 1.0, 0.0)
    efficiency: float = described("", "share of the battery's power that drives; 0: only power_full is drawn", 0.0, 1.0)
    power_full: float = described("W", "drawn at full throttle whatever the load", default=0.0)


class Tyres(Record):
    """Grip."""

    grip: float = described("", "friction of the tyres: greatest force by weight, along and across together", 0.01, 1e4)
    driven_load: float = described("", "share of the weight on the driven wheels", 0.01, 1.0, 1.0)


class Steering(Record):
    """Steering and wheels."""

    steering_model: int = described("", "STEERING_FRONT_WHEELS 0, STEERING_TURNING_CIRCLE 1 or STEERING_SKID 2", 0, 2)
    rear_axle: float = described(
        "m", "from the driven axle that does not steer forward to the origin", -10.0, 10.0, 0.0
    )
    wheelbase: float = described("m", "between the axles", 0.01, 20.0, models=_CAR)
    front_load: float = described("", "share of the weight on the front axle", 0.01, 0.99, models=_CAR)
    track: float = described("m", "between the left and the right driven wheel", 0.01, 20.0)
    steering_angle: float = described(
        "rad", "of the front wheels at full steering", 0.01, math.radians(80.0), models=_ANGLED
    )
    steering_rate: float = described("rad/s", "fastest turn of the front wheels, 0 unlimited", default=0.0)
    turning_diameter: float = described("m", "of the circle at full steering", 0.01, 1000.0, models=_CIRCLE)
    track_slip: float = described(
        "", "track that the yaw rate follows by the true one: wheels scrub", 1.0, 10.0, models=_SKID
    )


class Chassis(Record):
    """For engines that build the vehicle of parts; native physics has no use for them."""

    wheel_radius: float = described("m", "of the wheels, 0: a sixth of the wheelbase", default=0.0)
    centre_height: float = described(
        "m", "of the centre of mass over the floor, 0: one and a half wheel radii", default=0.0
    )


class Encoders(Record):
    """Wheel encoders."""

    encoder_rate: float = described("Hz", "samples a second of the wheel encoders, 0 none", 0.0, 200.0, 0.0)
    encoder_step: float = described("m", "travel of the rim a count, 0 continuous", default=0.0)


class Properties(body.Properties, Body, Drive, Tyres, Steering, Chassis, Battery, Sensors, Encoders, Outline, Ranging):
    """All properties of a ground vehicle."""
