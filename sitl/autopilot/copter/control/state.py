# SPDX-License-Identifier: BSD-3-Clause
"""The controllers' record. SI units, NED metres from the estimator's origin, body rates FRD, thrust and
throttle 0 .. 1.

A record of zeros is a valid start: filters take their first input as it is (``started``), ``init.init`` sets
the rest.
"""

from __future__ import annotations

from ....core.records import record
from ...control.pid_state import PID_DTYPE

DT = 0.0025
"""Period of every law in this room [s]: one autopilot tick."""
GRAVITY = 9.80665
"""[m/s^2]"""

ATTITUDE_DTYPE = record(
    ("target_q", "f8", 4),  # target frame to NED
    ("target_euler", "f8", 3),  # of target_q
    ("target_rate", "f8", 3),  # angular velocity of the target, target frame [rad/s]
    ("rate_target", "f8", 3),  # what the rate loop follows, body frame [rad/s]
    ("error_q", "f8", 4),  # target frame to body frame: kept when the estimate's heading jumps
    ("error", "f8", 3),  # rotation about x, y that turns the thrust, then about z the heading [rad]
    ("thrust_error_angle", "f8"),  # between the thrust axis and its target [rad]
    ("cos_lean", "f8"),  # cosine of the body's lean
    ("throttle_in", "f8"),  # last throttle asked for, before the angle boost
    ("lean_max", "f8"),  # lean at which altitude can still be held, filtered [rad]
    ("mix", "f8"),  # priority of attitude over throttle, ATC_THR_MIX_*
    ("mix_desired", "f8"),
    ("yaw_reset_count", "i8"),  # estimate.reset_yaw_count already followed
)

RATE_DTYPE = record(("roll", PID_DTYPE), ("pitch", PID_DTYPE), ("yaw", PID_DTYPE))

POS_NE_DTYPE = record(
    ("last_tick", "i8"),  # control.tick of the last update
    ("reset_count", "i8"),  # estimate.reset_ne_count already followed
    ("speed_max", "f8"),  # of the shaping [m/s]
    ("accel_max", "f8"),  # [m/s^2]
    ("jerk_max", "f8"),  # [m/s^3]
    ("correction_speed", "f8"),  # most that the position loop adds [m/s]
    ("correction_accel", "f8"),  # [m/s^2]
    ("pos_desired", "f8", 2),  # the shaped path
    ("vel_desired", "f8", 2),
    ("accel_desired", "f8", 2),
    ("pos_error", "f8", 2),  # pos_desired minus position, limited
    ("vel_target", "f8", 2),  # vel_desired plus the position loop's correction
    ("accel_target", "f8", 2),  # accel_desired plus the velocity loop's correction, lean limited
    ("limit", "f8", 2),  # direction in which the lean is used up; zero when it is not
    ("started", "i8"),  # velocity loop: 0 = the filters take the next input as it is
    ("vel_error", "f8", 2),  # filtered
    ("vel_derivative", "f8", 2),  # of the error, filtered [m/s^2]
    ("vel_integrator", "f8", 2),  # [m/s^2]
    ("accel_limit", "f8"),  # acceleration that the permitted lean gives [m/s^2], renewed every few ticks
)

POS_D_DTYPE = record(
    ("last_tick", "i8"),
    ("reset_count", "i8"),
    ("speed_down", "f8"),  # limits, both positive [m/s]
    ("speed_up", "f8"),
    ("accel_max", "f8"),  # [m/s^2]
    ("jerk_max", "f8"),  # [m/s^3]
    ("correction_speed_down", "f8"),
    ("correction_speed_up", "f8"),
    ("correction_accel", "f8"),
    ("pos_desired", "f8"),  # down
    ("vel_desired", "f8"),
    ("accel_desired", "f8"),
    ("pos_error", "f8"),
    ("vel_target", "f8"),
    ("accel_target", "f8"),
    ("limit", "f8"),  # direction in which thrust is used up: -1 no more, 1 no less, 0 free
    ("vel", PID_DTYPE),
    ("accel", PID_DTYPE),  # output is throttle taken off hover (down is positive)
    ("control_ratio", "f8"),  # 0 .. 2, falls while the descent runs away
)

MOTORS_DTYPE = record(
    ("desired_spool", "i8"),  # 0 SHUT_DOWN, 1 GROUND_IDLE, 2 THROTTLE_UNLIMITED: set by modes
    ("spool_state", "i8"),  # 0 SHUT_DOWN, 1 GROUND_IDLE, 2 SPOOLING_UP, 3 THROTTLE_UNLIMITED, 4 SPOOLING_DOWN
    ("spin_up_ratio", "f8"),  # 0 .. 1 of MOT_SPIN_MIN, on the ground
    ("thrust_max", "f8"),  # 0 .. 1, ramped by the spool
    ("roll", "f8"),  # demands -1 .. 1
    ("pitch", "f8"),
    ("yaw", "f8"),
    ("throttle_in", "f8"),  # demand 0 .. 1
    ("throttle_filter_hz", "f8"),  # 0: no filter
    ("throttle", "f8"),  # filtered demand
    ("throttle_avg_max", "f8"),  # how far the mixer may raise the throttle for attitude
    ("throttle_out", "f8"),  # what the mixer gave
    ("limit_roll", "i8"),
    ("limit_pitch", "i8"),
    ("limit_yaw", "i8"),
    ("limit_throttle_lower", "i8"),
    ("limit_throttle_upper", "i8"),
    ("thrust", "f8", 4),  # of each motor 0 .. 1, compensated
    ("actuator", "f8", 4),  # of each motor 0 .. 1 of the PWM range
    ("voltage_ratio", "f8"),  # resting voltage over MOT_BAT_VOLT_MAX, filtered; 1 when not compensated
    ("lift_max", "f8"),  # thrust at full throttle at that voltage, 1 at MOT_BAT_VOLT_MAX
    ("compensation_gain", "f8"),  # of thrust demands for voltage and air density
    ("resistance", "f8"),  # of the battery, estimated [ohm]
    ("voltage_slow", "f8"),  # [V]
    ("current_slow", "f8"),  # [A]
    ("current_most", "f8"),  # highest seen [A]
    ("voltage_reference", "f8"),  # highest voltage seen [V]
    ("current_reference", "f8"),  # at that moment [A]
    ("test_motor", "i8"),  # motor test: 1 .. 4, 0 none
    ("test_actuator", "f8"),  # of that motor
    ("test_until_us", "i8"),
)

CONTROL_DTYPE = record(
    ("tick", "i8"),  # ticks of this room
    ("attitude", ATTITUDE_DTYPE),
    ("rate", RATE_DTYPE),
    ("pos_ne", POS_NE_DTYPE),
    ("pos_d", POS_D_DTYPE),
    ("motors", MOTORS_DTYPE),
)
