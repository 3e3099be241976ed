# SPDX-License-Identifier: BSD-3-Clause
"""The controllers' record. SI units, NED metres from the estimator's origin, body rates FRD, thrust and
throttle 0 .. 1.

A record of zeros is a valid start: filters take their first input as it is (``started``), ``init.init`` sets
the rest.
"""

from __future__ import annotations

from ....core.algebra import euler_of, quat_from_euler
from ....core.constants import TICK_S
from ....core.kernels import law
from ....core.records import Floats, Ints, Record, array
from ....core.vectors import Euler, Quat, Vec2, Vec3
from ... import state as shared
from ...control.pid import Pid

DT = TICK_S
"""Period of every law in this package [s]: one autopilot tick."""
MOTORS_MAX, QUAD = 8, 4


class AttitudeState(Record):
    """Attitude control: the shaped target and the correction towards it."""

    target_q: Quat  # target frame to NED
    target_rate: Vec3  # angular velocity of the target, target frame [rad/s]
    rate_target: Vec3  # what the rate loop follows, body frame [rad/s]
    error_q: Quat  # target frame to body frame: kept when the estimate's heading jumps
    error: Vec3  # rotation about x, y that turns the thrust, then about z the heading [rad]
    thrust_error_angle: float  # between the thrust axis and its target [rad]
    cos_lean: float  # cosine of the body's lean
    throttle_in: float  # last throttle asked for, before the angle boost
    lean_max: float  # lean at which altitude can still be held, filtered [rad]
    mix: float  # priority of attitude over throttle, ATC_THR_MIX_*
    mix_desired: float
    yaw_reset_count: int  # estimate.reset_yaw_count already followed

    @property
    @law
    def target_euler(self) -> Euler:
        """Roll, pitch, yaw of ``target_q`` [rad]."""
        return euler_of(self.target_q)

    @target_euler.setter
    def target_euler(self, angles: Euler | tuple[float, float, float]) -> None:
        self.target_q = quat_from_euler(Euler(*angles))


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
    pos_desired: Vec2  # the shaped path [m]
    vel_desired: Vec2  # [m/s]
    accel_desired: Vec2  # [m/s^2]
    pos_error: Vec2  # pos_desired minus position, limited [m]
    vel_target: Vec2  # vel_desired plus the position loop's correction [m/s]
    accel_target: Vec2  # accel_desired plus the velocity loop's correction, lean limited [m/s^2]
    limit: Vec2  # direction in which the lean is used up; zero when it is not
    started: bool  # velocity loop; false: its filters take the next input as it is
    vel_error: Vec2  # filtered [m/s]
    vel_derivative: Vec2  # of the error, filtered [m/s^2]
    vel_integrator: Vec2  # [m/s^2]
    accel_limit: float  # acceleration that the permitted lean gives [m/s^2], renewed every few ticks
    disturbed: bool  # SYSTEMID adds to what is measured in this tick
    disturbance_pos: Vec2  # [m]
    disturbance_vel: Vec2  # [m/s]


class AltitudeState(Record):
    """Vertical position control, down positive."""

    last_tick: int  # control.tick of the last update
    reset_count: int  # estimate.reset_d_count already followed
    speed_down: float  # limits, both positive [m/s]
    speed_up: float
    accel_max: float  # [m/s^2]
    jerk_max: float  # [m/s^3]
    correction_speed_down: float  # most that the position loop adds, positive [m/s]
    correction_speed_up: float
    correction_accel: float  # [m/s^2]
    pos_desired: float  # the shaped path [m]
    vel_desired: float  # [m/s]
    accel_desired: float  # [m/s^2]
    pos_error: float  # pos_desired minus position, limited [m]
    vel_target: float  # vel_desired plus the position loop's correction [m/s]
    accel_target: float  # accel_desired plus the velocity loop's correction [m/s^2]
    limit: float  # direction in which thrust is used up: -1 no more, 1 no less, 0 free
    vel: Pid
    accel: Pid  # output is throttle taken off hover (down is positive)
    control_ratio: float  # 0 .. 2, falls while the descent runs away


class VibrationState(Record):
    """Vibration that biases the vertical acceleration (vibration.py), and the height's own rate of change."""

    found: bool  # height is controlled by that rate, and with other gains
    since_us: int  # since when the estimate reports it; 0 it does not
    good_us: int  # since when it no longer does, while ``found``; 0 it does
    # complementary filter, down positive
    pos: float  # [m]
    vel: float  # [m/s]
    bias: float  # of the acceleration [m/s^2]


class MotorsState(Record):
    """Spool, mixer and motor outputs."""

    desired_spool: int  # DesiredSpoolState, set by modes
    spool_state: int  # SpoolState
    spin_up_ratio: float  # 0 .. 1 of MOT_SPIN_MIN, on the ground
    thrust_max: float  # 0 .. 1, ramped by the spool
    roll: float  # demands -1 .. 1
    pitch: float
    yaw: float
    excited: bool  # SYSTEMID adds to the demands in this tick
    excitation: Vec3  # roll, pitch, yaw
    throttle_in: float  # demand 0 .. 1
    throttle_filter_hz: float  # 0: no filter
    throttle: float  # filtered demand
    throttle_avg_max: float  # how far the mixer may raise the throttle for attitude
    throttle_out: float  # what the mixer gave
    limit_roll: bool
    limit_pitch: bool
    limit_yaw: bool
    limit_throttle_lower: bool
    limit_throttle_upper: bool
    count: int  # motors of the frame; 0: there is no such frame
    is_plain_quad: bool  # four motors on outputs 1 to 4: most vehicles, so their loops are unrolled
    roll_factor: Floats = array(MOTORS_MAX)  # parts of the demands that each motor takes, -0.5 .. 0.5
    pitch_factor: Floats = array(MOTORS_MAX)
    yaw_factor: Floats = array(MOTORS_MAX)
    yaw_range: Floats = array(MOTORS_MAX)  # one over the size of the yaw factor
    output: Ints = array(MOTORS_MAX, stored="i8")  # of each motor 0 ..; -1: it has none
    thrust: Floats = array(MOTORS_MAX)  # of each motor 0 .. 1, compensated
    thrust_slow: Floats = array(MOTORS_MAX)  # the same, low-passed
    actuator: Floats = array(MOTORS_MAX)  # of each motor 0 .. 1 of the PWM range
    strongest: int  # motor 0 .. with the greatest thrust_slow; kept while boosting: the one that fails
    unbalanced: bool  # that motor works far harder than the mean
    boosting: bool  # thrust is being lost: the strongest motor does not limit the others
    boost_ratio: float  # 0 .. 1, follows while unbalanced
    loss_ticks: int  # for which thrust seemed to be lost
    learns_at_rest: bool  # hover throttle is learnt only while the path stands still, not while it is slow
    yaw_trim: float  # size of the yaw rate loop's integrator, low-passed
    yaw_trim_reported_us: int  # when that was last reported to be large
    voltage_ratio: float  # resting voltage over MOT_BAT_VOLT_MAX, filtered; 1 when not compensated
    lift_max: float  # thrust at full throttle at that voltage, 1 at MOT_BAT_VOLT_MAX
    compensation_gain: float  # of thrust demands for voltage and air density
    resistance: float  # of the battery, estimated [ohm]
    voltage_slow: float  # [V]
    current_slow: float  # [A]
    current_max: float  # highest seen [A]
    voltage_reference: float  # highest voltage seen [V]
    current_reference: float  # at that moment [A]
    blocked: bool  # by the take-off check: the motors idle
    warned_us: int  # when the check last said why
    test_motor: int  # motor test: 1 .., 0 none
    test_actuator: float  # of that motor
    test_until_us: int


class Control(shared.Control):
    """All controllers of the copter."""

    attitude: AttitudeState
    rate: RateState
    pos_ne: PositionState
    pos_d: AltitudeState
    vibration: VibrationState
    motors: MotorsState
