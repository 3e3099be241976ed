# SPDX-License-Identifier: BSD-3-Clause
"""The controllers' record. SI units, NED metres from the estimator's origin, body rates FRD, thrust and
throttle 0 .. 1.

A record of zeros is a valid start: filters take their first input as it is (``started``), ``init.init`` sets
the rest.
"""

from __future__ import annotations

from ....core.records import Floats, Record, array
from ... import state as shared
from ...control.pid_state import Pid

DT = 0.0025
"""Period of every law in this room [s]: one autopilot tick."""
GRAVITY = 9.80665
"""[m/s^2]"""


class AttitudeState(Record):
    """Attitude control: the shaped target and the correction towards it."""

    target_q: Floats = array(4)  # target frame to NED
    target_euler: Floats = array(3)  # of target_q
    target_rate: Floats = array(3)  # angular velocity of the target, target frame [rad/s]
    rate_target: Floats = array(3)  # what the rate loop follows, body frame [rad/s]
    error_q: Floats = array(4)  # target frame to body frame: kept when the estimate's heading jumps
    error: Floats = array(3)  # rotation about x, y that turns the thrust, then about z the heading [rad]
    thrust_error_angle: float  # between the thrust axis and its target [rad]
    cos_lean: float  # cosine of the body's lean
    throttle_in: float  # last throttle asked for, before the angle boost
    lean_max: float  # lean at which altitude can still be held, filtered [rad]
    mix: float  # priority of attitude over throttle, ATC_THR_MIX_*
    mix_desired: float
    yaw_reset_count: int  # estimate.reset_yaw_count already followed


class RateState(Record):
    """The rate loops."""

    roll: Pid
    pitch: Pid
    yaw: Pid


class PositionState(Record):
    """Horizontal position control, north and east."""

    last_tick: int  # control.tick of the last update
    reset_count: int  # estimate.reset_ne_count already followed
    speed_max: float  # of the shaping [m/s]
    accel_max: float  # [m/s^2]
    jerk_max: float  # [m/s^3]
    correction_speed: float  # most that the position loop adds [m/s]
    correction_accel: float  # [m/s^2]
    pos_desired: Floats = array(2)  # the shaped path
    vel_desired: Floats = array(2)
    accel_desired: Floats = array(2)
    pos_error: Floats = array(2)  # pos_desired minus position, limited
    vel_target: Floats = array(2)  # vel_desired plus the position loop's correction
    accel_target: Floats = array(2)  # accel_desired plus the velocity loop's correction, lean limited
    limit: Floats = array(2)  # direction in which the lean is used up; zero when it is not
    started: int  # velocity loop: 0 = the filters take the next input as it is
    vel_error: Floats = array(2)  # filtered
    vel_derivative: Floats = array(2)  # of the error, filtered [m/s^2]
    vel_integrator: Floats = array(2)  # [m/s^2]
    accel_limit: float  # acceleration that the permitted lean gives [m/s^2], renewed every few ticks


class AltitudeState(Record):
    """Vertical position control, down positive."""

    last_tick: int
    reset_count: int
    speed_down: float  # limits, both positive [m/s]
    speed_up: float
    accel_max: float  # [m/s^2]
    jerk_max: float  # [m/s^3]
    correction_speed_down: float
    correction_speed_up: float
    correction_accel: float
    pos_desired: float  # down
    vel_desired: float
    accel_desired: float
    pos_error: float
    vel_target: float
    accel_target: float
    limit: float  # direction in which thrust is used up: -1 no more, 1 no less, 0 free
    vel: Pid
    accel: Pid  # output is throttle taken off hover (down is positive)
    control_ratio: float  # 0 .. 2, falls while the descent runs away


class MotorsState(Record):
    """Spool, mixer and motor outputs."""

    desired_spool: int  # 0 SHUT_DOWN, 1 GROUND_IDLE, 2 THROTTLE_UNLIMITED: set by modes
    spool_state: int  # 0 SHUT_DOWN, 1 GROUND_IDLE, 2 SPOOLING_UP, 3 THROTTLE_UNLIMITED, 4 SPOOLING_DOWN
    spin_up_ratio: float  # 0 .. 1 of MOT_SPIN_MIN, on the ground
    thrust_max: float  # 0 .. 1, ramped by the spool
    roll: float  # demands -1 .. 1
    pitch: float
    yaw: float
    throttle_in: float  # demand 0 .. 1
    throttle_filter_hz: float  # 0: no filter
    throttle: float  # filtered demand
    throttle_avg_max: float  # how far the mixer may raise the throttle for attitude
    throttle_out: float  # what the mixer gave
    limit_roll: int
    limit_pitch: int
    limit_yaw: int
    limit_throttle_lower: int
    limit_throttle_upper: int
    thrust: Floats = array(4)  # of each motor 0 .. 1, compensated
    actuator: Floats = array(4)  # of each motor 0 .. 1 of the PWM range
    voltage_ratio: float  # resting voltage over MOT_BAT_VOLT_MAX, filtered; 1 when not compensated
    lift_max: float  # thrust at full throttle at that voltage, 1 at MOT_BAT_VOLT_MAX
    compensation_gain: float  # of thrust demands for voltage and air density
    resistance: float  # of the battery, estimated [ohm]
    voltage_slow: float  # [V]
    current_slow: float  # [A]
    current_most: float  # highest seen [A]
    voltage_reference: float  # highest voltage seen [V]
    current_reference: float  # at that moment [A]
    test_motor: int  # motor test: 1 .. 4, 0 none
    test_actuator: float  # of that motor
    test_until_us: int


class Control(shared.Control):
    """All controllers of the copter."""

    attitude: AttitudeState
    rate: RateState
    pos_ne: PositionState
    pos_d: AltitudeState
    motors: MotorsState
