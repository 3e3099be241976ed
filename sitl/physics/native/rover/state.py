# SPDX-License-Identifier: BSD-3-Clause
"""Record of a rover's physics: what every vehicle has (``records``), and its wheels."""

from __future__ import annotations

from ....core.records import Floats, Int32, Record, array
from ....core.vectors import Vec2
from ....vehicles.properties.ground_vehicle import Properties
from .. import records as shared


class Derived(shared.Derived):
    """What follows from the properties (``prepare``), so that a tick divides little."""

    control_scale: float  # 1 / control_full
    motor_lag: float  # time constant of the motors in place of the properties' [s]; 0: theirs
    servo_rate: float  # of the steering servo in place of the properties' [rad/s]; 0: theirs
    speed_decay: float  # what is left of a wheel-speed error after a tick
    speed_step: float  # largest change of wheel speed a tick that the motors give [m/s]
    rolling_step: float  # speed that rolling resistance takes off a tick [m/s]
    grip: float  # greatest acceleration on these tyres [m/s^2]
    drive_grip: float  # the same, of the driven wheels along [m/s^2]
    yaw_step: float  # largest change of the yaw rate a tick that the tyres give [rad/s]
    steering_step: float  # largest turn of the front wheels a tick [rad]
    inverse_wheelbase: float  # STEERING_FRONT_WHEELS [1/m]
    circle_scale: float  # STEERING_TURNING_CIRCLE: curvature by sine of the angle [1/m]
    bend: float  # curvature that front wheels at ``bend_angle`` ask for [1/m]: worked out when they turn
    bend_angle: float  # [rad]
    inverse_track: float  # STEERING_SKID: yaw rate by difference of the sides' speeds [1/m]
    power_by_accel: float  # battery power by acceleration and speed at no load [W/(m/s^2)/(m/s)]
    encoder_period: int  # [ticks], 0 no encoder


SERVO_RING = 401
"""Commands of the steering servo that are kept: 1 s and the present one."""


class SteeringServo(Record):
    """What is slow about the steering servo, besides its speed (SIM_SERVO_DELAY, SIM_SERVO_FILTER)."""

    is_slow: bool
    delay: Int32  # [ticks]
    kept: int  # commands so far
    ring: Floats = array(SERVO_RING, stored="f4")  # command n at n % SERVO_RING
    is_filtered: bool
    gain: float  # of a second-order low-pass: y = gain (x + 2 x' + x") - a1 y' - a2 y"
    a1: float
    a2: float
    first: float  # its states
    second: float


class Wheels(Record):
    """Wheels and motors."""

    servo: SteeringServo
    angle: float  # of the front wheels, to the right [rad]
    speed: Vec2  # rolling speed that the motors give [m/s]: x of the axle, or x of the left and y of the right side
    distance: Vec2  # rolled by the left (x) and right (y) driven wheel [m]
    encoder_period: int  # [ticks] of encoders that the airframe lacks; 0: there are none
    encoder_step: float  # travel of the rim a count [m]
    power: float  # taken from the battery by the motors [W]
    is_faulty: bool  # the outputs of steering and motors, or of the left and right motors, fail:
    share: Vec2  # of their commands that is left (SIM_ENGINE_FAIL)
    stuck: int  # bits of those whose command stays (SIM_ENGINE_STUCK)
    held: Vec2  # their last commands
    forward: float  # speed of the driven axle over the ground [m/s]; less than the wheels' when they slip


class Physics(shared.Physics):
    """The physics of a rover."""

    airframe: Properties
    derived: Derived
    wheels: Wheels
