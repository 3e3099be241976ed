# SPDX-License-Identifier: BSD-3-Clause
"""The controllers' record. SI units, NED metres from the estimator's origin, angles in radians; steering and throttle
-1 .. 1 of full travel (right and forward positive), where ArduPilot uses +-4500 and +-100.

A record of zeros is a valid start, ``init.init`` sets the rest. A ``*_tick`` field holds ``tick + 1`` of the period in
which its law last ran (0: never): a controller that did not run lately starts afresh from what the vehicle does now.
"""

from __future__ import annotations

from ....core.kernels import law
from ....core.records import Floats, Ints, Record, array
from ....core.vectors import Vec2
from ... import state as shared
from ...control.pid import Pid

DT = 0.02
"""Period of every law in this package [s]: ArduRover's loop of 50 Hz."""
PERIOD_US = 20_000
TEST_THROTTLE, TEST_STEERING, TEST_LEFT, TEST_RIGHT = 1, 2, 3, 4
"""MOTOR_TEST_ORDER of ArduRover's motor test."""


class SteeringState(Record):
    """Steering: turn rate and lateral acceleration."""

    last_tick: int
    turn_rate: float  # desired, limited [rad/s]
    lat_accel_tick: int
    lat_accel: float  # last asked for [m/s^2]
    limit_left: bool  # the turn rate asked for could not be given, or the motors were at a limit
    limit_right: bool
    rate: Pid  # [rad/s] to steering


class SpeedState(Record):
    """Speed along the nose."""

    forward_ok: bool  # a forward speed is known
    forward: float  # speed along the vehicle's nose, backward negative [m/s]
    wheel_ok: bool  # the encoders gave a speed
    wheel: float  # from them [m/s]
    wheel_count: int  # sample that it is from
    wheel_us: int  # when that came
    wheel_distance: float  # mean of left and right there [m]
    last_tick: int
    stop_tick: int  # when last found standing
    desired: float  # what the loop follows, acceleration limited [m/s]
    limit_low: bool  # ATC_BRAKE 0 took away braking in the last period
    limit_high: bool
    loop: Pid  # [m/s] to throttle


class PositionState(Record):
    """Position control in the plane, north and east."""

    last_tick: int
    reset_count: int  # estimate.reset_ne_count already followed
    speed_max: float  # limits of shaped targets [m/s]
    accel_max: float  # [m/s^2]
    lat_accel_max: float  # [m/s^2]
    jerk_max: float  # [m/s^3]
    reversed: bool  # drive backwards
    pos_target: Vec2  # [m]
    vel_desired: Vec2  # of the target [m/s]
    accel_desired: Vec2  # of the target [m/s^2]
    pos_error: Vec2  # target minus position, limited [m]
    vel_target: Vec2  # vel_desired plus the position loop's correction, limited to speed_max [m/s]
    accel_target: Vec2  # [m/s^2]
    started: bool  # velocity loop: false: the filters take the next input as it is
    vel_error: Vec2  # filtered [m/s]
    vel_derivative: Vec2  # of the error, filtered [m/s^2]
    vel_integrator: Vec2  # [m/s^2]
    desired_speed: float  # outputs: along the nose [m/s]
    desired_turn_rate: float  # [rad/s]
    desired_lat_accel: float  # to the right [m/s^2]


class MotorsState(Record):
    """Motor and servo outputs."""

    steering: float  # demand; may lie outside -1 .. 1
    scale_steering: bool  # shrink steering with speed and mirror it in reverse by speed (not in MANUAL)
    throttle: float  # demand -1 .. 1, after an update what the slew limit left of it
    throttle_last: float  # of the last period, for the slew limit
    limit_left: bool  # what the last period's demand ran into
    limit_right: bool
    limit_lower: bool
    limit_upper: bool
    out_steering: float  # -1 .. 1 of each function's travel
    out_throttle: float
    out_left: float  # motors of a skid-steered vehicle
    out_right: float
    direction: Floats = array(3)  # last output that was not zero, of throttle, left and right (MOT_REV_DELAY)
    direction_tick: Ints = array(3, stored="i8")
    driven: Ints = array(4, stored="i8")  # output has a function
    test_motor: int  # motor test: 0 none, or one of TEST_*
    test_value: float  # -1 .. 1 of that motor
    test_pulse: int  # pulse to give it instead [us]; 0: test_value
    test_until_us: int


class Control(shared.Control):
    """All controllers of the rover."""

    steering: SteeringState
    speed: SpeedState
    position: PositionState
    motors: MotorsState


@law
def current_tick(control: Control) -> int:
    """Stamp of this period; modes run before the counter is moved on."""
    return control.tick + 1


@law
def is_recent(control: Control, stamp: int, periods: int) -> bool:
    """Whether ``stamp`` is at most so many periods old; 0 stands for never."""
    return stamp != 0 and current_tick(control) - stamp <= periods
