# SPDX-License-Identifier: BSD-3-Clause
"""The controllers' record. SI units, NED metres from the estimator's origin, angles in radians; steering and throttle
-1 .. 1 of full travel (right and forward positive), where ArduPilot uses +-4500 and +-100.

A record of zeros is a valid start, ``init.init`` sets the rest. A ``*_tick`` field holds ``tick + 1`` of the period in
which its law last ran (0: never), see ``recent.py``.
"""

from __future__ import annotations

from ....core.records import record
from ...control.pid_state import PID_DTYPE

DT = 0.02
"""Period of every law in this room [s]: ArduRover's loop of 50 Hz."""
PERIOD_US = 20_000
GRAVITY = 9.80665
"""[m/s^2]"""

STEERING_DTYPE = record(
    ("last_tick", "i8"),
    ("turn_rate", "f8"),  # desired, limited [rad/s]
    ("lat_accel_tick", "i8"),
    ("lat_accel", "f8"),  # last asked for [m/s^2]
    ("limit_left", "i8"),  # the turn rate asked for could not be given, or the motors were at a limit
    ("limit_right", "i8"),
    ("rate", PID_DTYPE),  # [rad/s] to steering
)

SPEED_DTYPE = record(
    ("forward_ok", "i8"),  # a forward speed is known
    ("forward", "f8"),  # speed along the vehicle's nose, backward negative [m/s]
    ("wheel_ok", "i8"),  # the encoders gave a speed
    ("wheel", "f8"),  # from them [m/s]
    ("wheel_count", "i8"),  # sample that it is from
    ("wheel_us", "i8"),  # when that came
    ("wheel_distance", "f8"),  # mean of left and right there [m]
    ("last_tick", "i8"),
    ("stop_tick", "i8"),  # when last found standing
    ("desired", "f8"),  # what the loop follows, acceleration limited [m/s]
    ("limit_low", "i8"),  # ATC_BRAKE 0 took away braking in the last period
    ("limit_high", "i8"),
    ("loop", PID_DTYPE),  # [m/s] to throttle
)

POSITION_DTYPE = record(
    ("last_tick", "i8"),
    ("reset_count", "i8"),  # estimate.reset_ne_count already followed
    ("speed_max", "f8"),  # limits of shaped targets [m/s]
    ("accel_max", "f8"),  # [m/s^2]
    ("lat_accel_max", "f8"),  # [m/s^2]
    ("jerk_max", "f8"),  # [m/s^3]
    ("reversed", "i8"),  # drive backwards
    ("pos_target", "f8", 2),
    ("vel_desired", "f8", 2),  # of the target
    ("accel_desired", "f8", 2),
    ("pos_error", "f8", 2),  # target minus position, limited
    ("vel_target", "f8", 2),  # vel_desired plus the position loop's correction, limited to speed_max
    ("accel_target", "f8", 2),
    ("started", "i8"),  # velocity loop: 0 = the filters take the next input as it is
    ("vel_error", "f8", 2),  # filtered
    ("vel_derivative", "f8", 2),  # of the error, filtered [m/s^2]
    ("vel_integrator", "f8", 2),  # [m/s^2]
    ("desired_speed", "f8"),  # outputs: along the nose [m/s]
    ("desired_turn_rate", "f8"),  # [rad/s]
    ("desired_lat_accel", "f8"),  # to the right [m/s^2]
)

MOTORS_DTYPE = record(
    ("steering", "f8"),  # demand; may lie outside -1 .. 1
    ("scale_steering", "i8"),  # shrink steering with speed and mirror it in reverse by speed (not in MANUAL)
    ("throttle", "f8"),  # demand -1 .. 1, after an update what the slew limit left of it
    ("throttle_last", "f8"),  # of the last period, for the slew limit
    ("limit_left", "i8"),  # what the last period's demand ran into
    ("limit_right", "i8"),
    ("limit_lower", "i8"),
    ("limit_upper", "i8"),
    ("out_steering", "f8"),  # -1 .. 1 of each function's travel
    ("out_throttle", "f8"),
    ("out_left", "f8"),  # motors of a skid-steered vehicle
    ("out_right", "f8"),
    ("direction", "f8", 3),  # last output that was not zero, of throttle, left and right (MOT_REV_DELAY)
    ("direction_tick", "i8", 3),
    ("driven", "i8", 4),  # output has a function
    ("test_motor", "i8"),  # motor test: 0 none, 1 throttle, 2 steering, 3 left, 4 right
    ("test_value", "f8"),  # -1 .. 1 of that motor
    ("test_pulse", "i8"),  # pulse to give it instead [us]; 0: test_value
    ("test_until_us", "i8"),
)

CONTROL_DTYPE = record(
    ("tick", "i8"),  # periods of this room
    ("steering", STEERING_DTYPE),
    ("speed", SPEED_DTYPE),
    ("position", POSITION_DTYPE),
    ("motors", MOTORS_DTYPE),
)
