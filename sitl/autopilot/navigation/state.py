# SPDX-License-Identifier: BSD-3-Clause
"""The record of navigation: the command under way, the legs planned for it, and how far the mission is.

The shell (``mission.sequencer``, ``navigation.planner``) writes commands and legs; the core follows them.
Positions are NED metres from the EKF origin, speeds m/s, angles radians, times simulated microseconds or
seconds as said.
"""

from __future__ import annotations

from ...core.records import Floats, Ints, Record, array
from ...core.vectors import Vec2, Vec3
from ..events import Event

# Kinds of navigation command (``command_kind``)
NONE = 0
TAKEOFF = 1  # climb to target.z
WAYPOINT = 2  # fly the leg to target, wait delay
LOITER_UNLIMITED = 3  # fly the leg to target, stay
LOITER_TURNS = 4  # circles: radius, turns
LOITER_TIME = 5  # fly the leg to target, stay for delay
RTL = 6
LAND = 7  # at target when has_target, else where it is
DELAY = 8  # stay where it is for delay
GUIDED = 9  # set-points drive, until a limit is reached (a rover: or target, when has_target)
YAW_SPEED = 10  # rover: turn to a heading at a speed
PASSED_OVER = 11  # complete at once
LOITER_TO_ALT = 12  # copter: fly the leg to target, then climb or sink to its height
PAYLOAD_PLACE = 13  # copter: at target when has_target, else where it is: down, release, up again

# Conditions that hold back the do-commands that follow them (``condition_kind``)
CONDITION_NONE = 0
CONDITION_DELAY = 1  # until condition_until_us
CONDITION_DISTANCE = 2  # until the destination is nearer than condition_distance
CONDITION_YAW = 3  # until auto_yaw (modes) has turned

COMMAND_COMPLETE = Event(6)  # the command under way is done (b: its count), or a condition is met: the shell goes on
LEG_ENDING = Event(7)  # the shell plans the following leg
COMMAND_ARRIVED = Event(27)  # the navigation command under way is at its position, b: its count (nav.command_count)

# What COMMAND_COMPLETE and LEG_ENDING events say in ``a``
NAV_COMMAND = 0.0  # the navigation command
DO_COMMAND = 1.0  # the condition that held back do-commands is met
LEG_REQUEST = 2.0  # LEG_ENDING: the core asks for a leg to ``request`` (path.request_leg)
DETOUR_REQUEST = 4.0  # LEG_ENDING: a position of a detour is reached, or a path is to be looked for again
SPEED_REQUEST = 3.0  # LEG_ENDING: the speed limit changed: plan the legs anew

# State of the mission (``mission_state``)
STOPPED = 0
RUNNING = 1
COMPLETE = 2

# Parts of a mission (``mission_part``)
OUTWARD = 0
RETURN_PATH = 1  # behind DO_RETURN_PATH_START
LANDING = 2  # behind DO_LAND_START, or a landing

# Ways back (AUTO_RTL)
BEST = 0  # by a return path, else by a landing sequence
BY_LANDING = 1
BY_PATH = 2

SEGMENTS = 16
DETOUR = 24
"""Positions of a detour that there is space for."""
STRAIGHT, BENT, ENDED = 0, 1, 2
"""Whether BendyRuler steers; ``ENDED``: no longer, and the shell plans a leg to the destination."""
GO_ON = 3
"""``request_pending``: a position of a detour is reached."""
JUMPS = 100


class Leg(Record):
    """A planned leg: a straight line that is flown with limited speed, acceleration and jerk."""

    segments: int  # 0: no leg; the last one is the state at and after the end
    started: bool
    k: int  # segment at ``elapsed``
    elapsed: float  # path time since its start [s]
    duration: float  # [s]
    turn_in: float  # when the acceleration from its start is over [s]
    turn_out: float  # when the deceleration to its end begins [s]
    length: float  # [m]
    origin: Vec3  # NED [m]
    unit: Vec3  # direction, unit vector NED; zero for a leg of no length
    top_speed: float  # limit along this direction [m/s]
    fast: bool  # goes through its end into the next leg without a stop
    # distance along the leg as polynomials of the time since the segment's start:
    # p + v t + a t^2/2 + j t^3/6 + s t^4/24
    t: Floats = array(SEGMENTS)  # start of the segment [s]
    p: Floats = array(SEGMENTS)  # [m]
    v: Floats = array(SEGMENTS)  # [m/s]
    a: Floats = array(SEGMENTS)  # [m/s^2]
    j: Floats = array(SEGMENTS)  # [m/s^3]
    s: Floats = array(SEGMENTS)  # [m/s^4]


class Detour(Record):
    """A path around fences: positions behind the end of the leg under way (``navigation.detour``)."""

    left: int  # positions that are still to come, the destination the last of them; 0: none
    waypoints: Floats = array(3 * DETOUR, stored="f4")  # the next one last, NED [m]
    areas: int  # the areas of the fence that it was laid around (``path.areas_of``)
    blocked_us: int  # there is no path: when that was found; 0 not
    reported_us: int  # when it was last said
    bend: int  # BendyRuler: STRAIGHT, BENT, ENDED (``avoidance.bendy_ruler``)
    bent_target: Vec3  # what it steers for in place of the destination, NED [m]
    bent_from: Vec2  # the destination when it last found a bearing, NE [m]
    bearing: float  # that it found then [rad]; vertical: the slope, up positive
    lookahead: float  # so far it looks now [m]
    bent_us: int  # when it last looked


class Nav(Record):
    """Navigation and missions: what those of all firmwares share."""

    # the navigation command under way
    command_kind: int
    command_count: int  # one more for each command given: a change tells the mode to begin it
    command_seq: int  # its number in the mission; 0 none
    target: Vec3  # NED [m]
    has_target: bool  # LAND, LOITER: target was given
    delay: float  # [s]
    turns: float
    circle_radius: float  # LOITER_TURNS: < 0 counter-clockwise [m]
    completed: bool  # COMMAND_COMPLETE was sent for this command
    since_us: int  # when it arrived (start of the delay); 0 not yet
    # waypoint follower
    previous: Leg  # still decelerating beyond the corner
    current: Leg
    next: Leg
    detour: Detour
    active_us: int  # last time flown along legs
    fresh: bool  # the current leg starts from a standstill: controllers start anew
    joined: bool  # the current leg goes on from the one before without a stop
    reached: bool  # the end of the current leg
    time_scale: float  # 0 .. 1: path time slows down for a vehicle that lags
    pos: Vec3  # point on the path, NED [m]
    vel: Vec3  # [m/s]
    acc: Vec3  # [m/s^2]
    request: Vec3  # the core asks for a leg to here, NED [m]
    request_next: Vec3  # and then to here, without a stop, when request_pending is 2 [m]
    request_pending: int  # legs asked for: 0, 1 or 2; GO_ON
    speed_ne: float  # horizontal speed limit that a command set [m/s]; 0 none: the parameter's
    # do-commands
    condition_kind: int
    condition_until_us: int
    condition_distance: float  # [m]
    # the mission: run state of the sequencer, numbers of items (0 is home: none)
    mission_state: int
    mission_current: int  # MISSION_CURRENT: navigation command under way, or first to fly
    mission_reached: int  # last navigation command completed
    mission_do: int  # do-command waiting or last run
    mission_do_next: int  # where to look for the following do-command; 0 all done
    mission_resume: bool  # MISSION_SET_CURRENT was used: the next start goes on there in spite of MIS_RESTART
    mission_part: int  # OUTWARD, RETURN_PATH or LANDING: what the command under way belongs to
    mission_events: int  # events that the sequencer has seen
    jump_item: Ints = array(JUMPS, stored="u2")  # DO_JUMP items run so far ...
    jump_runs: Ints = array(JUMPS, stored="i4")  # ... and how often
