# SPDX-License-Identifier: BSD-3-Clause
"""AUTO: drives the navigation commands of the mission one after the other; at the end it follows MIS_DONE_BEHAVE.

The shell writes the command under way into ``modes.nav`` and counts it up; this mode begins it, drives it and says when
it is done (``navigation.command.complete``), upon which the shell gives the next.
"""

from __future__ import annotations

import math

from ....core.algebra import horizontal, norm2
from ....core.kernels import law
from ....core.scalars import constrain, wrap_pi
from ....core.vectors import Vec2
from ...modes import ModeReason, ModeResult, ask
from ...navigation import command
from ...navigation import state as kinds
from .. import pilot
from ..control import speed
from ..navigation import waypoint
from ..navigation.state import RoverNav
from ..state import Vehicle
from . import circle, drive, guided, loiter, rtl
from .acro import ACRO
from .manual import MANUAL
from .mode import Destination, RoverMode, end_of_path, no_destination
from .state import AutoState, Modes

AUTO = 10

STOPPED, ON_PATH, TURNING, RETURNING, LOITERING, GUIDED_IN_MISSION, CIRCLING = 0, 1, 2, 3, 4, 5, 6
"""What it is doing (``modes.auto.submode``); TURNING: to a heading, at a speed."""
HEADING_REACHED = math.radians(5.0)
LEGS = (kinds.WAYPOINT, kinds.LOITER_UNLIMITED, kinds.LOITER_TIME)
"""Kinds of command that drive along a leg."""
LOITER_WHEN_DONE, ACRO_WHEN_DONE, MANUAL_WHEN_DONE = 1.0, 2.0, 3.0
"""MIS_DONE_BEHAVE"""


@law
def start(v: Vehicle) -> int:
    """Enter; needs a mission. The shell gives the first command."""
    ap = v.autopilot
    modes, auto = ap.modes, ap.modes.auto
    if modes.mission_count < 2:
        return ModeResult.NO_MISSION
    waypoint.start(modes.nav, ap.control.position, ap.params)
    modes.guided.limit_us = 0
    modes.guided.limit_distance = 0.0
    auto.command = modes.nav.command_count
    modes.nav.command_kind = kinds.NONE
    auto.submode = STOPPED
    auto.complete = False
    return ModeResult.ACCEPTED


@law
def first_submode(kind: int) -> int:
    """What it begins to do for a command of this kind."""
    if kind in LEGS:
        return ON_PATH
    if kind == kinds.LOITER_TURNS:
        return CIRCLING
    if kind == kinds.RTL:
        return RETURNING
    if kind == kinds.GUIDED:
        return GUIDED_IN_MISSION
    return TURNING if kind == kinds.YAW_SPEED else STOPPED


@law
def begin(v: Vehicle) -> None:
    """Begin the command that the shell has written; what cannot begin becomes a stop."""
    ap = v.autopilot
    nav, auto = ap.modes.nav, ap.modes.auto
    auto.command = nav.command_count
    auto.complete = False
    nav.completed = False
    nav.since_us = v.time_us if nav.command_kind == kinds.DELAY else 0
    auto.submode = first_submode(nav.command_kind)
    cause: int = ModeResult.ACCEPTED
    if auto.submode == CIRCLING:
        cause = circle.begin(v, circle.circuit_around(horizontal(nav.target), nav.circle_radius, ap.estimate))
    elif auto.submode == RETURNING:
        cause = rtl.start(v)
    elif auto.submode == GUIDED_IN_MISSION:
        cause = guided.start(v)
        guided.begin_limits(ap.modes.guided, v.time_us, horizontal(ap.estimate.pos))
    elif auto.submode == TURNING:
        begin_turn(auto, nav, ap.params.WP.SPEED)
    if cause != ModeResult.ACCEPTED:
        auto.submode = STOPPED


@law
def begin_turn(auto: AutoState, nav: RoverNav, speed_max: float) -> None:
    """SET_YAW_SPEED: towards ``nav.heading`` at ``nav.heading_speed``, no faster than ``speed_max`` [m/s]."""
    auto.heading = wrap_pi(nav.heading)
    auto.speed = constrain(nav.heading_speed, -speed_max, speed_max)
    auto.heading_reached = False
    auto.submode = TURNING


@law
def run(v: Vehicle) -> None:
    """One period."""
    ap = v.autopilot
    nav, auto = ap.modes.nav, ap.modes.auto
    pos = ap.estimate.pos
    if auto.command != nav.command_count:
        begin(v)
    if nav.mission_state == kinds.COMPLETE and not auto.complete:
        finish(ap.modes, ap.params.MIS.DONE_BEHAVE)
        if ap.params.MIS.DONE_BEHAVE == LOITER_WHEN_DONE and loiter.start(v) == ModeResult.ACCEPTED:
            auto.submode = LOITERING
    run_command(v)
    if has_arrived(nav):
        command.arrive(nav, ap.events, v.time_us)
    if not nav.completed and is_done(ap.modes, v.time_us, horizontal(pos), ap.params.WP.RADIUS):
        command.complete(nav, ap.events, v.time_us)
    command.check_condition(nav, ap.events, v.time_us, pos, True)


@law
def run_command(v: Vehicle) -> None:
    """One period of the command under way.

    Waiting at a waypoint a car stands: it would have to circle to hold the very point.
    """
    ap = v.autopilot
    auto, nav = ap.modes.auto, ap.modes.nav
    control, armed, p = ap.control, ap.arming.armed, ap.params
    submode = auto.submode
    if submode == ON_PATH and (nav.current.fast or not waypoint.reached(nav)):
        drive.follow_path(v)
    elif submode == CIRCLING:
        circle.run(v)
    elif submode == RETURNING:
        rtl.run(v)
    elif submode == LOITERING:
        loiter.run(v)
    elif submode == GUIDED_IN_MISSION:
        guided.run(v)
    elif submode == TURNING and not auto.heading_reached:
        drive.turn_to(control, ap.estimate, ap.modes.pilot, auto.heading, p)
        drive.at_speed(v, pilot.nudged(ap.modes.pilot, auto.speed, p))
        auto.heading_reached = abs(wrap_pi(auto.heading - ap.estimate.yaw)) < HEADING_REACHED
    else:
        speed.stop(control, armed, p)


@law
def has_arrived(nav: RoverNav) -> bool:
    """Whether the command under way has just come to its position, where it may wait."""
    return not nav.completed and nav.command_kind in LEGS and nav.since_us == 0 and waypoint.reached(nav)


@law
def is_done(modes: Modes, time_us: int, pos: Vec2, radius: float) -> bool:
    """Whether the command under way is complete, at ``pos`` [m]; one that could not begin is.

    Guided within the mission is within ``radius`` [m] of its position, or at its limit.
    """
    nav, submode = modes.nav, modes.auto.submode
    kind = nav.command_kind
    if kind == kinds.NONE or kind == kinds.LOITER_UNLIMITED:
        return False
    if kind in LEGS or kind == kinds.DELAY:
        waited = (time_us - nav.since_us) * 1e-6 >= nav.delay
        return waited and (kind == kinds.DELAY or nav.since_us != 0)
    if submode == CIRCLING:
        return circle.turns(modes.circle) >= nav.turns
    if submode == RETURNING:
        return waypoint.reached(nav)
    if submode == GUIDED_IN_MISSION:
        at_position = nav.has_target and norm2(horizontal(nav.target) - pos) <= radius
        return at_position or guided.is_at_limit(modes.guided, time_us, pos)
    if submode == TURNING:
        return modes.auto.heading_reached
    return True


@law
def finish(modes: Modes, wanted: float) -> None:
    """The mission is complete: it stops; some modes of MIS_DONE_BEHAVE are asked for."""
    modes.auto.complete = True
    modes.auto.submode = STOPPED
    if wanted in (ACRO_WHEN_DONE, MANUAL_WHEN_DONE):
        ask(modes, ACRO if wanted == ACRO_WHEN_DONE else MANUAL, ModeReason.MISSION_END)


def change_speed(v: Vehicle, wanted: float) -> bool:
    """DO_CHANGE_SPEED [m/s] of what it is doing."""
    auto = v.autopilot.modes.auto
    if auto.submode == CIRCLING:
        return circle.change_speed(v, wanted)
    if auto.submode == GUIDED_IN_MISSION:
        return guided.change_speed(v, wanted)
    if auto.submode == TURNING:
        auto.speed = wanted
        return True
    return auto.submode != LOITERING and drive.change_path_speed(v, wanted)


@law
def destination(modes: Modes) -> Destination:
    """That of what it is doing."""
    submode = modes.auto.submode
    if submode in (ON_PATH, RETURNING):
        return end_of_path(modes)
    if submode == CIRCLING:
        return circle.destination(modes)
    if submode == LOITERING:
        return loiter.destination(modes)
    return guided.destination(modes) if submode == GUIDED_IN_MISSION else no_destination(modes)


MODE = RoverMode(
    number=AUTO,
    name="AUTO",
    start=start,
    run=run,
    needs_position=True,
    autonomous=True,
    destination=destination,
    change_speed=change_speed,
)
