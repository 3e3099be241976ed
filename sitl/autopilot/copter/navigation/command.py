# SPDX-License-Identifier: BSD-3-Clause
"""Flies the navigation commands that follow legs and circles.

AUTO calls ``begin`` when ``nav.command_count`` changes, ``run`` on every tick for the kinds that ``follows_path``, and
``navigation.command.complete`` when it finds a take-off, landing or return done. ``run`` says so itself.
"""

from __future__ import annotations

from ....core.kernels import law
from ...navigation.command import complete
from ...navigation.state import DELAY, LOITER_TIME, LOITER_TURNS, LOITER_UNLIMITED, WAYPOINT
from ..state import Autopilot
from . import circle, waypoint


@law
def follows_path(kind: int) -> bool:
    """Whether ``run`` flies commands of this kind."""
    return kind in (WAYPOINT, LOITER_UNLIMITED, LOITER_TIME, LOITER_TURNS, DELAY)


@law
def begin(ap: Autopilot, time_us: int) -> None:
    """Begin the command that the shell has written."""
    nav = ap.modes.nav
    nav.completed = False
    nav.since_us = 0
    nav.circle_running = False
    waypoint.start(ap, time_us)


@law
def run(ap: Autopilot, time_us: int) -> None:
    """One tick of a command that follows a path: writes position targets."""
    nav = ap.modes.nav
    kind = nav.command_kind
    if kind == LOITER_TURNS and (nav.circle_running or nav.reached):
        nav.active_us = time_us
        if circle.run(ap) >= nav.turns:
            complete(nav, ap.events, time_us)
    elif waypoint.advance(ap, time_us):
        if nav.since_us == 0:
            nav.since_us = time_us
        waited = (time_us - nav.since_us) * 1e-6 >= nav.delay
        if waited and kind in (WAYPOINT, LOITER_TIME, DELAY):
            complete(nav, ap.events, time_us)
