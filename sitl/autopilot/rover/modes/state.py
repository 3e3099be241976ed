# SPDX-License-Identifier: BSD-3-Clause
"""The record of the rover's modes, of the pilot's sticks and of the failsafes.

Positions are NE metres from the EKF origin (as ``estimate.pos``), velocities m/s, angles radians; steering and throttle
-1 .. 1, right and forward positive.
"""

from __future__ import annotations

from ....core.records import record
from ...failsafe_state import FAILSAFE_DTYPE
from ..navigation.state import NAV_DTYPE

PATH_POINTS = 500
"""Room of SMART_RTL's path; SRTL_POINTS are used."""

GUIDED_DTYPE = record(
    ("submode", "i8"),  # guided_state.py: STOP, POSITION, HEADING_AND_SPEED, ...
    ("pos", "f8", 2),  # POSITION [m]
    ("heading", "f8"),  # HEADING_AND_SPEED [rad]
    ("turn_rate", "f8"),  # TURN_RATE_AND_SPEED [rad/s]
    ("speed", "f8"),  # of both, backward negative [m/s]
    ("steering", "f8"),  # STEERING_AND_THROTTLE
    ("throttle", "f8"),
    ("update_us", "i8"),  # when the last set-point came
    ("has_target", "i8"),  # the set-point under way is fresh enough; 0 stops
    ("reached_told", "i8"),  # POSITION: arrival was said
    ("limit_us", "i8"),  # guided within a mission ends after so long; 0 never
    ("limit_distance", "f8"),  # and so far from where it began [m]; 0 never
    ("limit_since_us", "i8"),  # when it began
    ("limit_from", "f8", 2),  # where [m]
)

LOITER_DTYPE = record(
    ("place", "f8", 2),  # [m]
    ("heading", "f8"),  # [rad]
    ("speed", "f8"),  # [m/s]
    ("distance", "f8"),  # to the place [m]
)

CIRCLE_DTYPE = record(
    ("centre", "f8", 2),  # [m]
    ("radius", "f8"),  # [m]
    ("direction", "f8"),  # 1 clockwise, -1 counter-clockwise
    ("speed", "f8"),  # wanted [m/s]
    ("angle", "f8"),  # of the target, seen from the centre [rad]
    ("target", "f8", 2),  # [m]
    ("target_speed", "f8"),  # [m/s]
    ("total", "f8"),  # turned so far, signed [rad]
    ("at_edge", "i8"),  # 0 still on the way there
    ("waiting", "i8"),  # the vehicle fell behind: the target waits for it
)

SIMPLE_DTYPE = record(
    ("first_heading", "f8"),  # when armed [rad]
    ("heading", "f8"),  # last asked for [rad]
)

RTL_DTYPE = record(
    ("told", "i8"),  # arrival was said
)

PATH_DTYPE = record(
    ("active", "i8"),  # points are recorded
    ("home_saved", "i8"),
    ("points", "i8"),  # on the path; point 0 is home
    ("simplified", "i8"),  # so many from the start need no second look
    ("good_us", "i8"),  # last good position
    ("saved_us", "i8"),  # last point that found room
    ("n", "f8", PATH_POINTS),  # [m]
    ("e", "f8", PATH_POINTS),  # [m]
    ("keep", "i8", PATH_POINTS),  # for the simplification
)

SMART_RTL_DTYPE = record(
    ("state", "i8"),  # smart_rtl.py: CLEAN_UP, FOLLOW, ARRIVED
)

AUTO_DTYPE = record(
    ("submode", "i8"),  # what AUTO is doing (auto_state.py)
    ("command", "i8"),  # count of the command that is begun (nav.command_count)
    ("heading", "f8"),  # SET_YAW_SPEED [rad]
    ("speed", "f8"),  # backward negative [m/s]
    ("heading_reached", "i8"),
    ("complete", "i8"),  # what comes after the mission has begun (MIS_DONE_BEHAVE)
)

PILOT_DTYPE = record(
    ("steering", "f8"),  # stick with dead zone, right positive
    ("throttle", "f8"),
    ("left", "f8"),  # the same sticks as the paddles of a tank, without dead zone
    ("right", "f8"),
    ("switch_position", "i8"),  # of the mode channel 0 .. 5, -1 none
    ("switch_candidate", "i8"),
    ("switch_us", "i8"),  # since when the candidate is there
    ("rudder_us", "i8"),  # since when the steering stick is held for arming or disarming; 0 not
)

LINKS_DTYPE = record(
    ("bad", "i8"),  # bits: 1 radio, 2 ground station (failsafe.py)
    ("since_us", "i8"),  # when the first of them was lost
    ("acted", "i8"),  # bits for which FS_ACTION was done
)

MODES_DTYPE = record(
    ("number", "i8"),  # ArduPilot's custom mode (numbers.py)
    ("previous", "i8"),
    ("reason", "i8"),  # ArduPilot's ModeReason of the last change
    ("guided", GUIDED_DTYPE),
    ("loiter", LOITER_DTYPE),
    ("circle", CIRCLE_DTYPE),
    ("simple", SIMPLE_DTYPE),
    ("rtl", RTL_DTYPE),
    ("path", PATH_DTYPE),
    ("smart_rtl", SMART_RTL_DTYPE),
    ("auto", AUTO_DTYPE),
    ("pilot", PILOT_DTYPE),
    ("failsafe", FAILSAFE_DTYPE),
    ("links", LINKS_DTYPE),
    ("ekf_was_good", "i8"),  # while armed, since boot
    ("wanted", "i8"),  # a mode asks for another one: its number + 1, 0 none
    ("wanted_reason", "i8"),
    ("mission_count", "i8"),  # items of the mission, home included (written by the shell)
    ("mission_takes_off", "i8"),  # (written by the shell; says nothing to a rover)
    ("nav", NAV_DTYPE),
)
