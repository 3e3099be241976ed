# SPDX-License-Identifier: BSD-3-Clause
"""The record of navigation: the command under way, the legs planned for it, and how far the mission is.

The shell (``mission.sequencer``, ``navigation.planner``) writes commands and legs; the core follows them.
Positions are NED metres from the EKF origin, speeds m/s, angles radians, times simulated microseconds or
seconds as said.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ...core.records import record

# Kinds of navigation command (``command_kind``)
NONE = 0
TAKEOFF = 1  # climb to target[2]
WAYPOINT = 2  # fly the leg to target, wait delay
LOITER_UNLIMITED = 3  # fly the leg to target, stay
LOITER_TURNS = 4  # circles: radius, turns
LOITER_TIME = 5  # fly the leg to target, stay for delay
RTL = 6
LAND = 7  # at target when has_place, else where it is
DELAY = 8  # stay where it is for delay
GUIDED = 9  # rover: set-points drive, until target (when has_place) or a limit is reached
YAW_SPEED = 10  # rover: turn to a heading at a speed
PASSED_OVER = 11  # complete at once

# Conditions that hold back the do-commands that follow them (``condition_kind``)
CONDITION_NONE = 0
CONDITION_DELAY = 1  # until condition_until_us
CONDITION_DISTANCE = 2  # until the destination is nearer than condition_distance
CONDITION_YAW = 3  # until auto_yaw (modes) has turned

# What COMMAND_COMPLETE and LEG_ENDING events say in ``a``
NAV_COMMAND = 0.0  # the navigation command
DO_COMMAND = 1.0  # the condition that held back do-commands is met
LEG_REQUEST = 2.0  # LEG_ENDING: the core asks for a leg to ``request`` (path.request_leg)
SPEED_REQUEST = 3.0  # LEG_ENDING: the speed limit changed: plan the legs anew

# State of the mission (``mission_state``)
STOPPED = 0
RUNNING = 1
COMPLETE = 2

SEGMENTS = 16
JUMPS = 100

LEG_DTYPE = record(
    ("segments", "i8"),  # 0: no leg; the last one is the state at and after the end
    ("started", "i8"),
    ("k", "i8"),  # segment at ``elapsed``
    ("elapsed", "f8"),  # path time since its start [s]
    ("duration", "f8"),  # [s]
    ("turn_in", "f8"),  # when the acceleration from its start is over [s]
    ("turn_out", "f8"),  # when the deceleration to its end begins [s]
    ("length", "f8"),  # [m]
    ("origin", "f8", 3),  # NED [m]
    ("unit", "f8", 3),  # direction, unit vector NED; zero for a leg of no length
    ("top_speed", "f8"),  # limit along this direction [m/s]
    ("fast", "i8"),  # goes through its end into the next leg without a stop
    # distance along the leg as polynomials of the time since the segment's start:
    # p + v t + a t^2/2 + j t^3/6 + s t^4/24
    ("t", "f8", SEGMENTS),  # start of the segment [s]
    ("p", "f8", SEGMENTS),  # [m]
    ("v", "f8", SEGMENTS),  # [m/s]
    ("a", "f8", SEGMENTS),  # [m/s^2]
    ("j", "f8", SEGMENTS),  # [m/s^3]
    ("s", "f8", SEGMENTS),  # [m/s^4]
)


def nav_dtype(*own: tuple[Any, ...]) -> np.dtype[Any]:
    """The record of a firmware: what navigation and missions of all share, and its ``own`` fields."""
    return record(
        # the navigation command under way
        ("command_kind", "i8"),
        ("command_count", "i8"),  # one more for each command given: a change tells the mode to begin it
        ("command_seq", "i8"),  # its number in the mission; 0 none
        ("target", "f8", 3),  # NED [m]
        ("has_place", "i8"),  # LAND, LOITER: target was given
        ("delay", "f8"),  # [s]
        ("turns", "f8"),
        ("circle_radius", "f8"),  # LOITER_TURNS: < 0 counter-clockwise [m]
        ("completed", "i8"),  # COMMAND_COMPLETE was sent for this command
        ("since_us", "i8"),  # when it arrived (start of the delay); 0 not yet
        # waypoint follower
        ("previous", LEG_DTYPE),  # still decelerating beyond the corner
        ("current", LEG_DTYPE),
        ("next", LEG_DTYPE),
        ("active_us", "i8"),  # last time flown along legs
        ("fresh", "i8"),  # the current leg starts from a standstill: controllers start anew
        ("joined", "i8"),  # the current leg goes on from the one before without a stop
        ("reached", "i8"),  # the end of the current leg
        ("time_scale", "f8"),  # 0 .. 1: path time slows down for a vehicle that lags
        ("pos", "f8", 3),  # point on the path, NED [m]
        ("vel", "f8", 3),  # [m/s]
        ("acc", "f8", 3),  # [m/s^2]
        ("request", "f8", 3),  # the core asks for a leg to here, NED [m]
        ("request_next", "f8", 3),  # and then to here, without a stop, when request_pending is 2 [m]
        ("request_pending", "i8"),  # legs asked for: 0, 1 or 2
        ("speed_ne", "f8"),  # horizontal speed limit that a command set [m/s]; 0 none: the parameter's
        # do-commands
        ("condition_kind", "i8"),
        ("condition_until_us", "i8"),
        ("condition_distance", "f8"),  # [m]
        # the mission: run state of the sequencer, numbers of items (0 is home: none)
        ("mission_state", "i8"),
        ("mission_current", "i8"),  # MISSION_CURRENT: navigation command under way, or first to fly
        ("mission_reached", "i8"),  # last navigation command completed
        ("mission_do", "i8"),  # do-command waiting or last run
        ("mission_do_next", "i8"),  # where to look for the following do-command; 0 all done
        ("mission_resume", "i8"),  # MISSION_SET_CURRENT was used: the next start goes on there in spite of MIS_RESTART
        ("mission_events", "i8"),  # events that the sequencer has seen
        ("jump_item", "i8", JUMPS),  # DO_JUMP items run so far ...
        ("jump_runs", "i8", JUMPS),  # ... and how often
        *own,
    )
