# SPDX-License-Identifier: BSD-3-Clause
"""Flies the navigation commands that follow legs and circles, and says when one is done.

AUTO calls ``begin`` when ``nav.command_count`` changes, ``run`` on every tick for the kinds that
``follows_path``, and ``complete`` when it finds a take-off, landing or return done. ``run`` calls
``complete`` itself.
"""

from __future__ import annotations

from ...core.kernels import law
from ..events import COMMAND_COMPLETE, emit_and_return
from . import circle, waypoint
from .state import (
    CONDITION_DELAY,
    CONDITION_DISTANCE,
    CONDITION_NONE,
    CONDITION_YAW,
    DELAY,
    DO_COMMAND,
    LOITER_TIME,
    LOITER_TURNS,
    LOITER_UNLIMITED,
    NAV_COMMAND,
    WAYPOINT,
)


@law
def follows_path(kind):
    """1 for the kinds that ``run`` flies."""
    return 1 if kind in (WAYPOINT, LOITER_UNLIMITED, LOITER_TIME, LOITER_TURNS, DELAY) else 0


@law
def begin(ap, time_us):
    """Begin the command that the shell has written."""
    nav = ap.modes.nav
    nav.completed = 0
    nav.since_us = 0
    nav.circle_running = 0
    waypoint.start(ap, time_us)


@law
def run(ap, time_us):
    """One tick of a command that follows a path: writes position targets.

    1 when it is done (and was said so).
    """
    nav = ap.modes.nav
    kind = nav.command_kind
    if kind == LOITER_TURNS and (nav.circle_running != 0 or nav.reached != 0):
        if nav.circle_running == 0:
            circle.start(ap)
        nav.active_us = time_us
        if circle.advance(ap) >= nav.turns:
            complete(ap, time_us)
    elif waypoint.advance(ap, time_us) != 0:
        if nav.since_us == 0:
            nav.since_us = time_us
        waited = (time_us - nav.since_us) * 1e-6 >= nav.delay
        if waited and kind in (WAYPOINT, LOITER_TIME, DELAY):
            complete(ap, time_us)
    return int(nav.completed)


@law
def complete(ap, time_us):
    """Tell the shell, once, that the navigation command is done."""
    nav = ap.modes.nav
    if nav.completed == 0:
        nav.completed = 1
        emit_and_return(ap.events, time_us, COMMAND_COMPLETE, NAV_COMMAND, float(nav.command_count))


@law
def check_condition(ap, time_us, yaw_reached):
    """Tell the shell, once, that the condition which holds back do-commands is met; AUTO calls it every tick.

    ``yaw_reached`` is 1 when the turn of CONDITION_YAW is done.
    """
    nav = ap.modes.nav
    kind = nav.condition_kind
    if kind == CONDITION_NONE:
        return
    met = False
    if kind == CONDITION_DELAY:
        met = time_us >= nav.condition_until_us
    elif kind == CONDITION_DISTANCE:
        met = waypoint.distance(ap) < nav.condition_distance
    elif kind == CONDITION_YAW:
        met = yaw_reached != 0
    if met:
        nav.condition_kind = CONDITION_NONE
        emit_and_return(ap.events, time_us, COMMAND_COMPLETE, DO_COMMAND, float(nav.mission_do))
