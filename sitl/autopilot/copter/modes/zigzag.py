# SPDX-License-Identifier: BSD-3-Clause
"""ZIGZAG: LOITER with two points, A and B, stored by a switch; then it flies between parallel lines through A and B.

The lines are at right angles to A .. B, and it flies parallel to that. Function 61: low is A, high is B, the middle
gives back to the sticks. Function 83 sweeps from line to line (ZIGZ_AUTO_ENABLE): sideways by ZIGZ_SIDE_DIST towards
ZIGZ_DIRECTION, to the other line, sideways again, for ZIGZ_LINE_NUM lines.
"""

from __future__ import annotations

import math
from typing import Any

from ....core.algebra import direction, dot2, norm2, with_down
from ....core.kernels import law
from ....core.mavlink import MavSeverity
from ....core.scalars import constrain
from ....core.vectors import Vec2
from ...events import Event, emit
from ...navigation.path import request_leg
from ...notes import Text
from ..control import altitude, attitude, position, position_start
from ..control.spool import DesiredSpoolState
from ..navigation import waypoint
from ..state import Vehicle
from . import ground, loiter
from .mode import CopterMode
from .state import ZigZagState

ZIGZAG = 24

# Stages (``ZigZagState.stage``)
STORING = 0
BY_STICKS = 1
BY_ITSELF = 2

# Points
A = 0
B = 1

# What it did (ZIGZAG_DID)
STORED = 0  # and the point
GOES_TO = 2  # and the point
GIVES_BACK = 4
GOES_SIDEWAYS = 5  # and the direction


def text(did: int, line: int, lines: int) -> str:
    """Status text (MAV_SEVERITY_INFO) of ZIGZAG_DID; ``line`` 1 .. of so many ``lines`` of a sweep, 0 none."""
    if did == GIVES_BACK:
        return "ZIGZAG: manual control"
    if did < GOES_TO:
        return f"ZIGZAG: point {'AB'[did - STORED]} stored"
    if did >= GOES_SIDEWAYS:
        return f"ZIGZAG: moving to {('forward', 'right', 'backward', 'left')[did - GOES_SIDEWAYS]}"
    return f"ZIGZAG: moving to {'AB'[did - GOES_TO]}" + (f" (line {line}/{lines})" if 0 < line <= lines else "")


def _texts(v: Any, did: float, line: float) -> list[Text]:
    return [Text(MavSeverity.INFO, text(int(did), int(line), int(v.autopilot.params.ZIGZ.LINE_NUM)))]


ZIGZAG_DID = Event(34, says=_texts)  # a: what, b: line of the sweep, 0 none


@law
def start(v: Vehicle) -> int:
    """Enter, without points."""
    state = v.autopilot.modes.zigzag
    state.stage = STORING
    state.point = A
    state.has_a = state.has_b = state.sweeping = state.suspended = False
    return loiter.start(v)


@law
def position_on_line(state: ZigZagState, point: int, here: Vec2) -> Vec2:
    """The position nearest to ``here`` on the line through a point, NE [m]."""
    along = state.b - state.a
    away = here - (state.a if point == A else state.b)
    return here - along * (dot2(away, along) / dot2(along, along))


@law
def position_beside(state: ZigZagState, here: Vec2, heading: float, distance: float) -> Vec2:
    """``distance`` [m] from ``here``, at right angles to A .. B, on the side that a heading [rad] points to."""
    along = state.b - state.a
    side = Vec2(-along.y, along.x) * (distance / norm2(along))
    if dot2(side, direction(heading)) < 0.0:
        return here - side
    return here + side


@law
def here(v: Vehicle) -> Vec2:
    """Where the line begins, NE [m]: where the last one ended, or the vehicle can stop."""
    ap = v.autopilot
    if ap.modes.zigzag.stage == BY_ITSELF and ap.modes.nav.reached:
        return Vec2(ap.modes.nav.target.x, ap.modes.nav.target.y)
    return position_start.stopping_point_ne(ap.control.pos_ne, ap.estimate, ap.params.PSC)


@law
def fly_to(v: Vehicle, goal: Vec2, did: int) -> None:
    """Set off to a position, NE [m], at the present height; report what it ``did``."""
    modes = v.autopilot.modes
    state, nav = modes.zigzag, modes.nav
    height_d = nav.target.z
    if state.stage != BY_ITSELF:
        waypoint.stop(nav)
        nav.speed_ne = nav.speed_up = nav.speed_down = 0.0
        height_d = v.autopilot.control.pos_d.pos_desired
    state.stage = BY_ITSELF
    state.reached_us = 0
    emit(v.autopilot.events, v.time_us, ZIGZAG_DID, float(did), float(state.line if state.sweeping else 0))
    request_leg(nav, v.autopilot.events, v.time_us, with_down(goal, height_d))


@law
def go_to(v: Vehicle, point: int) -> None:
    """Set off to the line through a point."""
    state = v.autopilot.modes.zigzag
    state.point = point
    state.sideways = False
    fly_to(v, position_on_line(state, point, here(v)), GOES_TO + point)


@law
def go_sideways(v: Vehicle) -> None:
    """Set off to where the next line begins."""
    ap, p = v.autopilot, v.autopilot.params.ZIGZ
    state, direction = ap.modes.zigzag, int(constrain(p.DIRECTION, 0.0, 3.0))
    state.sideways = True
    heading = ap.estimate.yaw + 0.5 * math.pi * direction
    goal = position_beside(state, here(v), heading, constrain(p.SIDE_DIST, 0.1, 100.0))
    fly_to(v, goal, GOES_SIDEWAYS + direction)


@law
def store(v: Vehicle, point: int) -> None:
    """Store a point where the vehicle can stop; with both the stage ends."""
    state, goal = v.autopilot.modes.zigzag, here(v)
    if point == A:
        state.a, state.has_a = goal, True
    else:
        state.b, state.has_b = goal, True
    emit(v.autopilot.events, v.time_us, ZIGZAG_DID, float(STORED + point), 0.0)
    if state.has_a and state.has_b and norm2(state.b - state.a) > 0.0:
        state.stage = BY_STICKS


@law
def choose(v: Vehicle, point: int) -> None:
    """The switch is at a point: store it, or fly to its line."""
    state = v.autopilot.modes.zigzag
    state.sweeping = state.suspended = False
    if state.stage == STORING:
        store(v, point)
    else:
        go_to(v, point)


@law
def give_back(v: Vehicle) -> None:
    """Give back to the sticks, if it flies by itself."""
    state = v.autopilot.modes.zigzag
    state.sweeping = False
    if state.stage == BY_ITSELF:
        state.stage = BY_STICKS
        waypoint.stop(v.autopilot.modes.nav)
        loiter.start(v)
        emit(v.autopilot.events, v.time_us, ZIGZAG_DID, float(GIVES_BACK), 0.0)


@law
def sweep(v: Vehicle) -> None:
    """Begin a sweep, or go on with a suspended one; only from the sticks."""
    state = v.autopilot.modes.zigzag
    if v.autopilot.params.ZIGZ.AUTO_ENABLE == 0.0 or state.stage != BY_STICKS:
        return
    resumed, state.suspended, state.sweeping = state.suspended, False, True
    if resumed and not state.sideways:
        go_to(v, state.point)
    else:
        state.line = state.line if resumed else 0
        go_sideways(v)


@law
def suspend(v: Vehicle) -> None:
    """Give a sweep back to the sticks for a while."""
    state = v.autopilot.modes.zigzag
    state.suspended = state.suspended or (state.sweeping and state.stage == BY_ITSELF)
    if state.sweeping:
        give_back(v)
        v.autopilot.modes.loiter.brake_us = 0  # brakes at once


@law
def arrive(v: Vehicle) -> None:
    """At the end of a line, after ZIGZ_WP_DELAY: give back, or go on with the sweep."""
    ap, p = v.autopilot, v.autopilot.params.ZIGZ
    state = ap.modes.zigzag
    if state.reached_us == 0:
        state.reached_us = v.time_us
    if v.time_us - state.reached_us < p.WP_DELAY * 1e6:
        return
    if not state.sweeping or 0 <= int(p.LINE_NUM) <= state.line:
        give_back(v)
    elif state.sideways:
        state.line += 1
        go_to(v, B if state.point == A else A)
    else:
        go_sideways(v)


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    if ap.modes.zigzag.stage == BY_ITSELF and ground.is_grounded(ap.arming):
        give_back(v)
    if ap.modes.zigzag.stage == BY_ITSELF:
        run_line(v)
    else:
        loiter.run(v)


@law
def run_line(v: Vehicle) -> None:
    """One tick of flying by itself; the yaw stick turns it."""
    ap = v.autopilot
    modes, control, est, p = ap.modes, ap.control, ap.estimate, ap.params
    control.motors.desired_spool = DesiredSpoolState.THROTTLE_UNLIMITED
    reached = False
    if modes.nav.request_pending != 0:
        ground.brake(control)
    else:
        reached = waypoint.advance(modes.nav, control, est, p, v.time_us)
    position.update_ne(control, est, p)
    altitude.update_d(control, est, p)
    thrust = position.thrust_vector(control.pos_ne)
    attitude.input_thrust_vector_heading_rate(control, est, p, thrust, modes.pilot.yaw_rate)
    if reached:
        arrive(v)


MODE = CopterMode(number=ZIGZAG, name="ZIGZAG", start=start, run=run, climb_stick=True, needs_position=True)
