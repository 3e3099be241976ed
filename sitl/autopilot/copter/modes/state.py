# SPDX-License-Identifier: BSD-3-Clause
"""The record of the flight modes, of the pilot's sticks and of the failsafes.

Positions are NED metres from the EKF origin (as ``estimate.pos``), velocities m/s, accelerations m/s^2,
angles radians.
"""

from __future__ import annotations

from ....core.records import record
from ...failsafe_state import FAILSAFE_DTYPE
from ..navigation.state import NAV_DTYPE

AUTO_YAW_DTYPE = record(
    ("mode", "i8"),  # auto_yaw.py
    ("yaw", "f8"),  # heading under way [rad]
    ("rate", "f8"),  # [rad/s]
    ("offset", "f8"),  # FIXED: angle still to turn, signed [rad]
    ("slew", "f8"),  # FIXED: greatest turn rate [rad/s], 0 no limit
    ("look_ahead", "f8"),  # last course flown faster than 1 m/s [rad]
    ("roi", "f8", 3),  # point to look at, NED [m]
)

TAKEOFF_DTYPE = record(
    ("target_d", "f8"),  # NED [m]
    ("no_nav_active", "i8"),  # no horizontal control below no_nav_d (WP_NAVALT_MIN)
    ("no_nav_d", "f8"),  # NED [m]
    ("complete", "i8"),
    ("user_active", "i8"),  # take-off in ALT_HOLD and LOITER (PILOT_TKOFF_ALT or NAV_TAKEOFF)
    ("user_start_d", "f8"),  # NED [m]
    ("user_alt", "f8"),  # to climb [m]
)

GUIDED_DTYPE = record(
    ("submode", "i8"),  # guided.py: TAKEOFF, POSITION, VELOCITY_ACCEL, POS_VEL_ACCEL, ACCEL, ANGLE
    ("pos", "f8", 3),  # NED [m]
    ("vel", "f8", 3),
    ("acc", "f8", 3),
    ("update_us", "i8"),  # time of the last set-point
    ("timed_out", "i8"),  # the set-point under way is too old; said once
    ("paused", "i8"),
    ("q", "f8", 4),  # ANGLE: attitude, body to NED
    ("rates", "f8", 3),  # ANGLE: body rates [rad/s]
    ("use_attitude", "i8"),  # ANGLE: 0 rates only
    ("climb_rate", "f8"),  # ANGLE: [m/s] up
    ("thrust", "f8"),  # ANGLE: 0 .. 1
    ("use_thrust", "i8"),  # ANGLE: thrust instead of climb rate
)

LOITER_DTYPE = record(
    ("acc", "f8", 2),  # what the sticks ask, NE [m/s^2]
    ("predicted_acc", "f8", 2),  # what the lean of the sticks would do, NE
    ("predicted_euler", "f8", 2),  # roll, pitch that follow the sticks [rad]
    ("predicted_rate", "f8", 2),  # [rad/s]
    ("brake_acc", "f8"),  # [m/s^2]
    ("brake_us", "i8"),  # when the sticks were released
)

RTL_DTYPE = record(
    ("state", "i8"),  # rtl.py: CLIMB, RETURN, LOITER, FINAL_DESCENT, LANDING
    ("return_d", "f8"),  # height of the way home, NED [m]
    ("descent_d", "f8"),  # where RTL_ALT_FINAL ends, NED [m]
    ("home", "f8", 2),  # NE [m]
    ("loiter_us", "i8"),  # when the wait over home began
)

LAND_DTYPE = record(
    ("start_us", "i8"),
    ("with_position", "i8"),
    ("pause", "i8"),  # wait 4 s before descending, after a failsafe
)

AUTO_DTYPE = record(
    ("submode", "i8"),  # auto.py
    ("started", "i8"),  # by MISSION_START, or by raising the throttle
    ("command", "i8"),  # count of the command that is begun (nav.command_count)
    ("land_state", "i8"),  # 0 flying to the place, 1 descending
)

PILOT_DTYPE = record(
    ("roll", "f8"),  # sticks with dead zone, -1 .. 1, right positive
    ("pitch", "f8"),  # -1 .. 1, stick back (nose up) positive
    ("yaw", "f8"),  # -1 .. 1, right positive
    ("throttle", "f8"),  # 0 .. 1, no dead zone
    ("throttle_filtered", "f8"),  # PILOT_THR_FILT
    ("yaw_rate", "f8"),  # filtered by PILOT_Y_RATE_TC [rad/s]
    ("switch_position", "i8"),  # of the mode channel 0 .. 5, -1 none
    ("switch_candidate", "i8"),
    ("switch_us", "i8"),  # since when the candidate is there
    ("rudder_us", "i8"),  # since when the yaw stick is held for arming or disarming; 0 not
    ("rudder_done", "i8"),  # the stick must return before it counts again
    ("throttle_zero", "i8"),  # low, for at least 0.4 s
    ("throttle_zero_us", "i8"),  # when last above zero
)

LANDING_DTYPE = record(
    ("acc", "f8", 3),  # acceleration NED, low-passed at 1 Hz [m/s^2]
    ("landing", "i8"),  # a mode is descending to land
)

MODES_DTYPE = record(
    ("number", "i8"),  # ArduPilot's custom mode (numbers.py)
    ("previous", "i8"),
    ("reason", "i8"),  # ArduPilot's ModeReason of the last change
    ("auto_yaw", AUTO_YAW_DTYPE),
    ("takeoff", TAKEOFF_DTYPE),
    ("guided", GUIDED_DTYPE),
    ("loiter", LOITER_DTYPE),
    ("rtl", RTL_DTYPE),
    ("land", LAND_DTYPE),
    ("auto", AUTO_DTYPE),
    ("pilot", PILOT_DTYPE),
    ("failsafe", FAILSAFE_DTYPE),
    ("landing", LANDING_DTYPE),
    ("arming_delay", "i8"),  # armed less than 2 s ago: motors wait
    ("wanted", "i8"),  # a mode asks for another one: its number + 1, 0 none
    ("wanted_reason", "i8"),
    ("mission_count", "i8"),  # items of the mission, home included (written by the shell)
    ("mission_takes_off", "i8"),  # its first navigation command is a take-off (written by the shell)
    ("nav", NAV_DTYPE),
)
