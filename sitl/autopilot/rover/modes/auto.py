# SPDX-License-Identifier: BSD-3-Clause
"""AUTO: drives the mission's navigation commands one after the other, then does what MIS_DONE_BEHAVE says.

The shell writes the command under way into ``modes.nav`` and counts it up; this mode begins it, drives it and says when
it is done (``navigation.command.complete``), upon which the shell gives the next.
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.scalars import constrain, wrap_pi
from ...navigation import command
from ...navigation import state as kinds
from ..control import speed
from ..navigation import waypoint
from . import auto_state as doing
from . import circle, drive, guided_drive, loiter, rtl
from .numbers import ACCEPTED, ACRO, MANUAL, NO_MISSION, REASON_MISSION_END

HEADING_REACHED = math.radians(5.0)
LOITER_WHEN_DONE, ACRO_WHEN_DONE, MANUAL_WHEN_DONE = 1.0, 2.0, 3.0
"""MIS_DONE_BEHAVE"""


@law
def start(v):
    """Enter; needs a mission. The shell gives the first command."""
    ap = v.autopilot
    if ap.modes.mission_count < 2:
        return NO_MISSION
    auto = ap.modes.auto
    waypoint.start(v)
    ap.modes.guided.limit_us = 0
    ap.modes.guided.limit_distance = 0.0
    auto.command = int(ap.modes.nav.command_count)
    ap.modes.nav.command_kind = kinds.NONE
    auto.submode = doing.STOP
    auto.complete = 0
    return ACCEPTED


@law
def begin(v):
    """Begin the command that the shell has written."""
    ap = v.autopilot
    nav = ap.modes.nav
    auto = ap.modes.auto
    auto.command = int(nav.command_count)
    auto.complete = 0
    nav.completed = 0
    nav.since_us = 0
    kind = nav.command_kind
    auto.submode = doing.STOP
    if kind == kinds.WAYPOINT or kind == kinds.LOITER_UNLIMITED or kind == kinds.LOITER_TIME:
        auto.submode = doing.WAYPOINT
    elif kind == kinds.LOITER_TURNS:
        begin_circle(v)
    elif kind == kinds.RTL:
        if rtl.start(v) == ACCEPTED:
            auto.submode = doing.RTL
    elif kind == kinds.GUIDED:
        guided_drive.start(v)
        guided_drive.begin_limits(v)
        auto.submode = doing.GUIDED
    elif kind == kinds.YAW_SPEED:
        begin_heading(v)
    elif kind == kinds.DELAY:
        nav.since_us = v.time_us


@law
def begin_circle(v):
    """LOITER_TURNS: around ``nav.target``."""
    ap = v.autopilot
    nav = ap.modes.nav
    direction = -1.0 if nav.circle_radius < 0.0 else 1.0
    n, e = float(nav.target[0]), float(nav.target[1])
    if circle.start_around(v, n, e, abs(float(nav.circle_radius)), direction) == ACCEPTED:
        ap.modes.auto.submode = doing.CIRCLE


@law
def begin_heading(v):
    """SET_YAW_SPEED: towards ``nav.heading`` at ``nav.heading_speed``, no faster than WP_SPEED."""
    ap = v.autopilot
    nav = ap.modes.nav
    auto = ap.modes.auto
    most = float(ap.params.WP.SPEED)
    auto.heading = wrap_pi(float(nav.heading))
    auto.speed = constrain(float(nav.heading_speed), -most, most)
    auto.heading_reached = 0
    auto.submode = doing.HEADING_AND_SPEED


@law
def run(v):
    """One period."""
    ap = v.autopilot
    nav = ap.modes.nav
    if ap.modes.auto.command != nav.command_count:
        begin(v)
    if nav.mission_state == kinds.COMPLETE and ap.modes.auto.complete == 0:
        finish(v)
    submode = ap.modes.auto.submode
    if submode == doing.WAYPOINT:
        run_path(v)
    elif submode == doing.CIRCLE:
        circle.run(v)
    elif submode == doing.RTL:
        rtl.run(v)
    elif submode == doing.LOITER:
        loiter.run(v)
    elif submode == doing.GUIDED:
        guided_drive.run(v)
    elif submode == doing.HEADING_AND_SPEED:
        run_heading(v)
    else:
        speed.stop(v)
    if nav.completed == 0 and is_done(v):
        command.complete(ap, v.time_us)
    command.check_condition(ap, v.time_us, True)


@law
def run_path(v):
    """One period towards a waypoint. There, waiting, a car stands: it would have to circle to hold the very point."""
    if waypoint.reached(v.autopilot) != 0 and not waypoint.is_fast(v.autopilot):
        speed.stop(v)
    else:
        drive.along_path(v)


@law
def run_heading(v):
    """One period of SET_YAW_SPEED: turns while it drives, then stops."""
    ap = v.autopilot
    auto = ap.modes.auto
    if auto.heading_reached != 0:
        speed.stop(v)
        return
    drive.to_heading(v, float(auto.heading))
    speed.drive(v, drive.nudged(ap, float(auto.speed)))
    if abs(wrap_pi(float(auto.heading) - float(ap.estimate.euler[2]))) < HEADING_REACHED:
        auto.heading_reached = 1


@law
def is_done(v):
    """Whether the command under way is complete; one that could not begin is."""
    ap = v.autopilot
    nav = ap.modes.nav
    kind = nav.command_kind
    if kind == kinds.NONE:
        return False
    if kind == kinds.WAYPOINT or kind == kinds.LOITER_TIME or kind == kinds.LOITER_UNLIMITED:
        if nav.since_us == 0 and waypoint.reached(ap) != 0:
            command.arrive(ap, v.time_us)
        return kind != kinds.LOITER_UNLIMITED and nav.since_us != 0 and (v.time_us - nav.since_us) * 1e-6 >= nav.delay
    if kind == kinds.DELAY:
        return (v.time_us - nav.since_us) * 1e-6 >= nav.delay
    submode = ap.modes.auto.submode
    if submode == doing.CIRCLE:
        return circle.turns(ap) >= nav.turns
    if submode == doing.RTL:
        return waypoint.reached(ap) != 0
    if submode == doing.GUIDED:
        return is_guided_done(v)
    if submode == doing.HEADING_AND_SPEED:
        return ap.modes.auto.heading_reached != 0
    return True


@law
def is_guided_done(v):
    """Guided within the mission: at its place, or at its limit."""
    ap = v.autopilot
    nav = ap.modes.nav
    north = float(nav.target[0]) - float(ap.estimate.pos[0])
    east = float(nav.target[1]) - float(ap.estimate.pos[1])
    if nav.has_place != 0 and math.sqrt(north * north + east * east) <= ap.params.WP.RADIUS:
        return True
    return guided_drive.is_at_limit(v)


@law
def finish(v):
    """The mission is complete: MIS_DONE_BEHAVE; what cannot be entered becomes a stop."""
    ap = v.autopilot
    auto = ap.modes.auto
    wanted = ap.params.MIS.DONE_BEHAVE
    auto.complete = 1
    auto.submode = doing.STOP
    if wanted == LOITER_WHEN_DONE:
        if loiter.start(v) == ACCEPTED:
            auto.submode = doing.LOITER
    elif wanted in (ACRO_WHEN_DONE, MANUAL_WHEN_DONE):
        ap.modes.wanted = 1 + (ACRO if wanted == ACRO_WHEN_DONE else MANUAL)
        ap.modes.wanted_reason = REASON_MISSION_END
