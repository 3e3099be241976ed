# SPDX-License-Identifier: BSD-3-Clause
"""Steering of a rover: the angle of its front wheels or the difference of its sides, to a yaw rate that tyres hold."""

from __future__ import annotations

import math

from ....core.elementary import sin, tan
from ....core.kernels import law
from ....vehicles.properties.ground_vehicle import STEERING_FRONT_WHEELS, Properties
from .state import SERVO_RING, Derived, SteeringServo


@law
def approach(value: float, target: float, step: float) -> float:
    """``value`` a tick later, which goes to ``target`` by at most ``step``."""
    return min(max(target, value - step), value + step)


@law
def low_passed(servo: SteeringServo, command: float) -> float:
    """A command behind the servo's low-pass."""
    scaled = servo.gain * command
    after = scaled + servo.first
    servo.first = 2.0 * scaled - servo.a1 * after + servo.second
    servo.second = scaled - servo.a2 * after
    return after


@law
def followed(servo: SteeringServo, command: float) -> float:
    """The command [-1 .. 1] that a slow servo turns to in this tick."""
    servo.ring[servo.kept % SERVO_RING] = command
    late = float(servo.ring[max(servo.kept - servo.delay, 0) % SERVO_RING])
    servo.kept += 1
    return low_passed(servo, late) if servo.is_filtered else late


@law
def curvature(angle: float, airframe: Properties, derived: Derived) -> float:
    """1 / radius [1/m] of the driven axle's path that the front wheels' angle [rad] asks for, right positive."""
    if airframe.steering_model == STEERING_FRONT_WHEELS:
        return tan(angle) * derived.inverse_wheelbase
    return sin(angle) * derived.circle_scale


@law
def bend(angle: float, airframe: Properties, derived: Derived) -> float:
    """The same; kept while the wheels keep their angle, since tangent and sine cost a good part of a rover's tick."""
    if angle != derived.bend_angle:
        derived.bend, derived.bend_angle = curvature(angle, airframe, derived), angle
    return derived.bend


@law
def grip_across(wanted: float, speed: float, accel: float, grip: float) -> float:
    """Yaw rate [rad/s] that tyres of a grip [m/s^2] give of the one wanted, while they accelerate the vehicle, of this
    speed [m/s], along [m/s^2]: beyond the friction circle it runs wide (understeer).
    """
    across = abs(speed) * abs(wanted)
    if across * across + accel * accel > grip * grip:
        left = math.sqrt(max(grip * grip - accel * accel, 0.0))
        if across > left:
            return wanted * (left / across)
    return wanted
