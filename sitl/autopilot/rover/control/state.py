# SPDX-License-Identifier: BSD-3-Clause
"""The controllers' record. SI units, NED metres from the estimator's origin, angles in radians; steering and throttle
-1 .. 1 of full travel (right and forward positive), where ArduPilot uses +-4500 and +-100.

A record of zeros is a valid start, ``init.init`` sets the rest. A ``*_tick`` field holds ``tick + 1`` of the period in
which its law last ran (0: never), see ``recent.py``.
"""

from __future__ import annotations

from ....core.records import Floats, Ints, Record, array
from ... import state as shared
from ...control.pid import Pid

DT = 0.02
"""Period of every law in this room [s]: ArduRover's loop of 50 Hz."""
PERIOD_US = 20_000
GRAVITY = 9.80665
"""[m/s^2]"""


class SteeringState(Record):
    """Steering: turn rate and lateral acceleration."""

    last_tick: int
    turn_rate: float  # desired, limited [rad/s]
    lat_accel_tick: int
    lat_accel: float  # last asked for [m/s^2]
    limit_left: int  # the turn rate asked for could not be given, or the motors were at a limit
    limit_right: int
    rate: Pid  # [rad/s] to steering


class SpeedState(Record):
    """Speed along the nose."""

    forward_ok: int  # a forward speed is known
    forward: float  # speed along the vehicle's nose, backward negative [m/s]
    wheel_ok: int  # the encoders gave a speed
    wheel: float  # from them [m/s]
    wheel_count: int  # sample that it is from
    wheel_us: int  # when that came
    wheel_distance: float  # mean of left and right there [m]
    last_tick: int
    stop_tick: int  # when last found standing
    desired: float  # what the loop follows, acceleration limited [m/s]
    limit_low: int  # ATC_BRAKE 0 took away braking in the last period
    limit_high: int
    loop: Pid  # [m/s] to throttle


class PositionState(Record):
    """Position control in the plane, north and east."""

    last_tick: int
    reset_count: int  # estimate.reset_ne_count already followed
    speed_max: float  # limits of shaped targets [m/s]
    accel_max: float  # [m/s^2]
    lat_accel_max: float  # [m/s^2]
    jerk_max: float  # [m/s^3]
    reversed: int  # drive backwards
    pos_target: Floats = array(2)
    vel_desired: Floats = array(2)  # of the target
    accel_desired: Floats = array(2)
    pos_error: Floats = array(2)  # target minus position, limited
    vel_target: Floats = array(2)  # vel_desired plus the position loop's correction, limited to speed_max
    accel_target: Floats = array(2)
    started: int  # velocity loop: 0 = the filters take the next input as it is
    vel_error: Floats = array(2)  # filtered
    vel_derivative: Floats = array(2)  # of the error, filtered [m/s^2]
    vel_integrator: Floats = array(2)  # [m/s^2]
    desired_speed: float  # outputs: along the nose [m/s]
    desired_turn_rate: float  # [rad/s]
    desired_lat_accel: float  # to the right [m/s^2]


class MotorsState(Record):
    """Motor and servo outputs."""

    steering: float  # demand; may lie outside -1 .. 1
    scale_steering: int  # shrink steering with speed and mirror it in reverse by speed (not in MANUAL)
    throttle: float  # demand -1 .. 1, after an update what the slew limit left of it
    throttle_last: float  # of the last period, for the slew limit
    limit_left: int  # what the last period's demand ran into
    limit_right: int
    limit_lower: int
    limit_upper: int
    out_steering: float  # -1 .. 1 of each function's travel
    out_throttle: float
    out_left: float  # motors of a skid-steered vehicle
    out_right: float
    direction: Floats = array(3)  # last output that was not zero, of throttle, left and right (MOT_REV_DELAY)
    direction_tick: Ints = array(3, stored="i8")
    driven: Ints = array(4, stored="i8")  # output has a function
    test_motor: int  # motor test: 0 none, 1 throttle, 2 steering, 3 left, 4 right
    test_value: float  # -1 .. 1 of that motor
    test_pulse: int  # pulse to give it instead [us]; 0: test_value
    test_until_us: int


class Control(shared.Control):
    """All controllers of the rover."""

    steering: SteeringState
    speed: SpeedState
    position: PositionState
    motors: MotorsState
