# SPDX-License-Identifier: BSD-3-Clause
"""Set-points of GUIDED, as the MAVLink services write them; a mission's GUIDED_ENABLE takes them, too.

Every law returns OK, or says why it left the record as it was (``guided_state``). NE metres from the EKF origin,
headings [rad] from north, turn rates [rad/s] right positive, speeds [m/s] backward negative.
"""

from __future__ import annotations

from ....core.kernels import law
from ....core.scalars import constrain, wrap_pi
from ....core.vectors import Vec2
from ..navigation import waypoint
from .auto_state import is_guided
from .guided_state import (
    HEADING_AND_SPEED,
    LARGEST,
    NOT_FINITE,
    NOT_IN_GUIDED,
    OK,
    OUT_OF_RANGE,
    POSITION,
    STEERING_AND_THROTTLE,
    STOP,
    TURN_RATE_AND_SPEED,
)
from .numbers import AUTO, GUIDED

PLANNED = 64
"""GUID_OPTIONS: positions are driven to along planned legs; else the target is shaped, which suits moving ones."""


@law
def are_finite(x, y):
    """Whether both are usable numbers: neither NaN nor infinite nor absurdly large."""
    return abs(x) <= LARGEST and abs(y) <= LARGEST


@law
def is_open(ap):
    """Whether set-points are taken now."""
    if ap.modes.number == GUIDED:
        return True
    return ap.modes.number == AUTO and is_guided(ap)


@law
def refusal(v, x, y):
    """OK, or why a set-point with these numbers is not taken."""
    if not are_finite(x, y):
        return NOT_FINITE
    return OK if is_open(v.autopilot) else NOT_IN_GUIDED


@law
def begin(v, submode):
    """A set-point of this kind has come."""
    guided = v.autopilot.modes.guided
    guided.submode = submode
    guided.update_us = v.time_us
    guided.has_target = 1


@law
def set_position(v, n, e):
    """Drive to a point and stop there; arrival is GUIDED_REACHED."""
    code = refusal(v, n, e)
    if code != OK:
        return code
    ap = v.autopilot
    if (int(ap.params.GUID_OPTIONS) & PLANNED) != 0:
        waypoint.set_destination(ap, v.time_us, Vec2(n, e))
    else:
        waypoint.set_destination_shaped(ap, v.time_us, Vec2(n, e))
    begin(v, POSITION)
    ap.modes.guided.pos[0] = n
    ap.modes.guided.pos[1] = e
    ap.modes.guided.reached_told = 0
    return OK


@law
def set_heading_and_speed(v, heading, speed):
    """Turn to a heading and drive."""
    code = refusal(v, heading, speed)
    if code == OK:
        begin(v, HEADING_AND_SPEED)
        v.autopilot.modes.guided.heading = wrap_pi(heading)
        v.autopilot.modes.guided.speed = speed
    return code


@law
def set_heading_change_and_speed(v, change, speed):
    """Turn by an angle [rad] from the heading under way (from the nose when there is none) and drive."""
    ap = v.autopilot
    guided = ap.modes.guided
    from_heading = guided.heading if guided.submode == HEADING_AND_SPEED else ap.estimate.euler[2]
    code = refusal(v, change, speed)
    if code != OK:
        return code
    return set_heading_and_speed(v, float(from_heading) + change, speed)


@law
def set_turn_rate_and_speed(v, turn_rate, speed):
    """Turn steadily and drive."""
    code = refusal(v, turn_rate, speed)
    if code == OK:
        begin(v, TURN_RATE_AND_SPEED)
        v.autopilot.modes.guided.turn_rate = turn_rate
        v.autopilot.modes.guided.speed = speed
    return code


@law
def set_steering_and_throttle(v, steering, throttle):
    """Steering and throttle -1 .. 1 directly (ArduRover: for scripts on board; no message asks for it)."""
    code = refusal(v, steering, throttle)
    if code == OK:
        begin(v, STEERING_AND_THROTTLE)
        v.autopilot.modes.guided.steering = constrain(steering, -1.0, 1.0)
        v.autopilot.modes.guided.throttle = constrain(throttle, -1.0, 1.0)
    return code


@law
def stop(v):
    """Stop and stay."""
    if not is_open(v.autopilot):
        return NOT_IN_GUIDED
    v.autopilot.modes.guided.submode = STOP
    v.autopilot.modes.guided.has_target = 0
    return OK


@law
def set_limits(v, seconds, distance):
    """DO_GUIDED_LIMITS of a mission: guided ends after so long [s] and so far [m] from its beginning; 0 never."""
    if not are_finite(seconds, distance):
        return NOT_FINITE
    if seconds < 0.0 or distance < 0.0:
        return OUT_OF_RANGE
    v.autopilot.modes.guided.limit_us = int(seconds * 1e6)
    v.autopilot.modes.guided.limit_distance = distance
    return OK
