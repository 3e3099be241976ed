# SPDX-License-Identifier: BSD-3-Clause
"""Set-points of GUIDED, as the MAVLink services write them; a mission's GUIDED_ENABLE takes them, too.

Every law returns OK, or says why it left the record as it was. NE metres from the EKF origin, headings [rad] from
north, turn rates [rad/s] right positive, speeds [m/s] backward negative.
"""

from __future__ import annotations

from ....core.algebra import with_down
from ....core.kernels import law
from ....core.mavlink import MavSeverity
from ....core.scalars import wrap_pi
from ....core.vectors import Vec2
from ...command_results import CommandResult
from ...events import Event
from ...navigation.path import request_leg
from ..navigation import waypoint
from ..state import Vehicle
from .auto import AUTO, GUIDED_IN_MISSION
from .guided import GUIDED, HEADING_AND_SPEED, POSITION, STOP, TURN_RATE_AND_SPEED
from .state import GuidedState, Modes

_IGNORED = {
    84: "Ignoring SET_POSITION_TARGET_LOCAL_NED; set ACC_IGNORE in mask",
    86: "Ignoring SET_POSITION_TARGET_GLOBAL_INT; set ACC_IGNORE in mask",
}
SETPOINT_IGNORED = Event(29, MavSeverity.INFO, _IGNORED)
"""It has an acceleration; a: number of the MAVLink message"""

LARGEST = 1e9
"""Metres, metres a second, radians beyond this are refused."""
PLANNED = 64
"""GUID_OPTIONS: positions are driven to along planned legs; else the target is shaped, which suits moving ones."""


@law
def are_finite(x: float, y: float) -> bool:
    """Whether both are usable numbers: neither NaN nor infinite nor absurdly large."""
    return abs(x) <= LARGEST and abs(y) <= LARGEST


@law
def is_open(modes: Modes) -> bool:
    """Whether set-points are taken now."""
    return modes.number == GUIDED or (modes.number == AUTO and modes.auto.submode == GUIDED_IN_MISSION)


@law
def refusal(modes: Modes, x: float, y: float) -> int:
    """OK, or why a set-point with these numbers is not taken."""
    if not are_finite(x, y):
        return CommandResult.NOT_FINITE
    return CommandResult.OK if is_open(modes) else CommandResult.WRONG_MODE


@law
def begin(guided: GuidedState, time_us: int, submode: int) -> None:
    """A set-point of this kind has come."""
    guided.submode = submode
    guided.update_us = time_us
    guided.has_target = True


@law
def set_position(v: Vehicle, point: Vec2) -> int:
    """Drive to a point and stop there; arrival is GUIDED_REACHED."""
    ap = v.autopilot
    code = refusal(ap.modes, point.x, point.y)
    if code != CommandResult.OK:
        return code
    if (int(ap.params.GUID_OPTIONS) & PLANNED) != 0 or ap.params.OA.TYPE != 0.0:
        request_leg(ap.modes.nav, ap.events, v.time_us, with_down(point, 0.0))
    else:
        waypoint.set_destination_shaped(ap.modes.nav, ap.estimate, v.time_us, point, ap.params)
    begin(ap.modes.guided, v.time_us, POSITION)
    ap.modes.guided.pos = point
    ap.modes.guided.arrival_reported = False
    return CommandResult.OK


@law
def set_heading_and_speed(modes: Modes, time_us: int, heading: float, speed: float) -> int:
    """Turn to a heading and drive."""
    guided = modes.guided
    code = refusal(modes, heading, speed)
    if code == CommandResult.OK:
        begin(guided, time_us, HEADING_AND_SPEED)
        guided.heading = wrap_pi(heading)
        guided.speed = speed
    return code


@law
def set_turn_rate_and_speed(modes: Modes, time_us: int, turn_rate: float, speed: float) -> int:
    """Turn steadily and drive."""
    guided = modes.guided
    code = refusal(modes, turn_rate, speed)
    if code == CommandResult.OK:
        begin(guided, time_us, TURN_RATE_AND_SPEED)
        guided.turn_rate = turn_rate
        guided.speed = speed
    return code


@law
def stop(modes: Modes) -> int:
    """Stop and stay."""
    if not is_open(modes):
        return CommandResult.WRONG_MODE
    modes.guided.submode = STOP
    modes.guided.has_target = False
    return CommandResult.OK


@law
def set_limits(guided: GuidedState, seconds: float, distance: float) -> int:
    """DO_GUIDED_LIMITS of a mission: guided ends after so long [s] and so far [m] from its beginning; 0 never."""
    if not are_finite(seconds, distance):
        return CommandResult.NOT_FINITE
    if seconds < 0.0 or distance < 0.0:
        return CommandResult.OUT_OF_RANGE
    guided.limit_us = int(seconds * 1e6)
    guided.limit_distance = distance
    return CommandResult.OK
