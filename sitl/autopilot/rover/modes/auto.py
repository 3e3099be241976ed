# SPDX-License-Identifier: BSD-3-Clause
"""AUTO: drives the mission's navigation commands one after the other, then does what MIS_DONE_BEHAVE says.

The shell writes the command under way into ``modes.nav`` and counts it up; this mode begins it, drives it and says when
it is done (``navigation.command.complete``), upon which the shell gives the next.
"""

from __future__ import annotations

import math

from ....core.algebra import horizontal, norm2
from ....core.kernels import law
from ....core.scalars import constrain, wrap_pi
from ...modes import ACCEPTED, NO_MISSION, REASON_MISSION_END
from ...navigation import command
from ...navigation import state as kinds
from ..control import speed
from ..navigation import waypoint
from ..navigation.state import RoverNav
from ..state import Vehicle
from . import circle, drive, guided, loiter, rtl
from .acro import ACRO
from .manual import MANUAL
from .mode import Destination, RoverMode, end_of_path, no_destination
from .state import AutoState

AUTO = 10

STOPPED, ON_PATH, TURNING, RETURNING, LOITERING, GUIDED_IN_MISSION, CIRCLING = 0, 1, 2, 3, 4, 5, 6
"""What it is doing (``modes.auto.submode``); TURNING: to a heading, at a speed."""
HEADING_REACHED = math.radians(5.0)
LOITER_WHEN_DONE, ACRO_WHEN_DONE, MANUAL_WHEN_DONE = 1.0, 2.0, 3.0
"""MIS_DONE_BEHAVE"""


@law
def start(v: Vehicle) -> int:
    """Enter; needs a mission. The shell gives the first command."""
    modes = v.autopilot.modes
    auto = modes.auto
    if modes.mission_count < 2:
        return NO_MISSION
    waypoint.start(v.autopilot)
    modes.guided.limit_us = 0
    modes.guided.limit_distance = 0.0
    auto.command = modes.nav.command_count
    modes.nav.command_kind = kinds.NONE
    auto.submode = STOPPED
    auto.complete = False
    return ACCEPTED


@law
def begin(v: Vehicle) -> None:
    """Begin the command that the shell has written."""
    modes = v.autopilot.modes
    nav, auto = modes.nav, modes.auto
    auto.command = nav.command_count
    auto.complete = False
    nav.completed = False
    nav.since_us = 0
    kind = nav.command_kind
    auto.submode = STOPPED
    if kind == kinds.WAYPOINT or kind == kinds.LOITER_UNLIMITED or kind == kinds.LOITER_TIME:
        auto.submode = ON_PATH
    elif kind == kinds.LOITER_TURNS:
        begin_circle(v)
    elif kind == kinds.RTL:
        if rtl.start(v) == ACCEPTED:
            auto.submode = RETURNING
    elif kind == kinds.GUIDED:
        guided.start_in_mission(v)
        auto.submode = GUIDED_IN_MISSION
    elif kind == kinds.YAW_SPEED:
        begin_turn(auto, nav, v.autopilot.params.WP.SPEED)
    elif kind == kinds.DELAY:
        nav.since_us = v.time_us


@law
def begin_circle(v: Vehicle) -> None:
    """LOITER_TURNS: around ``nav.target``."""
    nav = v.autopilot.modes.nav
    direction = -1.0 if nav.circle_radius < 0.0 else 1.0
    if circle.start_around(v, horizontal(nav.target), abs(nav.circle_radius), direction) == ACCEPTED:
        v.autopilot.modes.auto.submode = CIRCLING


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
    if auto.command != nav.command_count:
        begin(v)
    if nav.mission_state == kinds.COMPLETE and not auto.complete:
        finish(v)
    run_command(v)
    if not nav.completed and is_done(v):
        command.complete(ap, v.time_us)
    command.check_condition(ap, v.time_us, True)


@law
def run_command(v: Vehicle) -> None:
    """One period of the command under way."""
    submode = v.autopilot.modes.auto.submode
    if submode == ON_PATH:
        run_path(v)
    elif submode == CIRCLING:
        circle.run(v)
    elif submode == RETURNING:
        rtl.run(v)
    elif submode == LOITERING:
        loiter.run(v)
    elif submode == GUIDED_IN_MISSION:
        guided.run(v)
    elif submode == TURNING:
        run_turn(v)
    else:
        speed.stop(v)


@law
def run_path(v: Vehicle) -> None:
    """One period towards a waypoint. There, waiting, a car stands: it would have to circle to hold the very point."""
    if waypoint.reached(v.autopilot) and not waypoint.is_fast(v.autopilot):
        speed.stop(v)
    else:
        drive.follow_path(v)


@law
def run_turn(v: Vehicle) -> None:
    """One period of SET_YAW_SPEED: turns while it drives, then stops."""
    ap = v.autopilot
    auto = ap.modes.auto
    if auto.heading_reached:
        speed.stop(v)
        return
    drive.turn_to(ap, auto.heading)
    speed.drive(v, drive.nudged(ap, auto.speed))
    auto.heading_reached = abs(wrap_pi(auto.heading - ap.estimate.euler.yaw)) < HEADING_REACHED


@law
def is_done(v: Vehicle) -> bool:
    """Whether the command under way is complete; one that could not begin is."""
    ap = v.autopilot
    nav = ap.modes.nav
    kind = nav.command_kind
    if kind == kinds.NONE:
        return False
    if kind == kinds.WAYPOINT or kind == kinds.LOITER_TIME or kind == kinds.LOITER_UNLIMITED:
        if nav.since_us == 0 and waypoint.reached(ap):
            command.arrive(ap, v.time_us)
        return kind != kinds.LOITER_UNLIMITED and nav.since_us != 0 and (v.time_us - nav.since_us) * 1e-6 >= nav.delay
    if kind == kinds.DELAY:
        return (v.time_us - nav.since_us) * 1e-6 >= nav.delay
    submode = ap.modes.auto.submode
    if submode == CIRCLING:
        return circle.turns(ap.modes.circle) >= nav.turns
    if submode == RETURNING:
        return waypoint.reached(ap)
    if submode == GUIDED_IN_MISSION:
        return is_guided_done(v)
    if submode == TURNING:
        return ap.modes.auto.heading_reached
    return True


@law
def is_guided_done(v: Vehicle) -> bool:
    """Guided within the mission: at its place, or at its limit."""
    ap = v.autopilot
    nav = ap.modes.nav
    pos = horizontal(ap.estimate.pos)
    if nav.has_place and norm2(horizontal(nav.target) - pos) <= ap.params.WP.RADIUS:
        return True
    return guided.is_at_limit(ap.modes.guided, v.time_us, pos)


@law
def finish(v: Vehicle) -> None:
    """The mission is complete: MIS_DONE_BEHAVE; what cannot be entered becomes a stop."""
    modes = v.autopilot.modes
    wanted = v.autopilot.params.MIS.DONE_BEHAVE
    modes.auto.complete = True
    modes.auto.submode = STOPPED
    if wanted == LOITER_WHEN_DONE:
        if loiter.start(v) == ACCEPTED:
            modes.auto.submode = LOITERING
    elif wanted in (ACRO_WHEN_DONE, MANUAL_WHEN_DONE):
        modes.wanted = 1 + (ACRO if wanted == ACRO_WHEN_DONE else MANUAL)
        modes.wanted_reason = REASON_MISSION_END


@law
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
def destination(v: Vehicle) -> Destination:
    """That of what it is doing."""
    submode = v.autopilot.modes.auto.submode
    if submode in (ON_PATH, RETURNING):
        return end_of_path(v)
    if submode == CIRCLING:
        return circle.destination(v)
    if submode == LOITERING:
        return loiter.destination(v)
    return guided.destination(v) if submode == GUIDED_IN_MISSION else no_destination(v)


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
