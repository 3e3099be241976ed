# SPDX-License-Identifier: BSD-3-Clause
"""Flies the navigation commands that follow legs and circles.

AUTO calls ``begin`` when ``nav.command_count`` changes, ``run`` on every tick for the kinds that ``follows_path``, and
``navigation.command.complete`` when ``run`` says that the command is done, or a take-off, landing or return is.
"""

from __future__ import annotations

from ....core.kernels import law
from ...navigation.state import DELAY, LOITER_TIME, LOITER_TURNS, LOITER_UNLIMITED, WAYPOINT
from ...state import Estimate
from ..control.state import Control
from ..parameters import Parameters
from . import circle, waypoint
from .state import CopterNav


@law
def follows_path(kind: int) -> bool:
    """Whether ``run`` flies commands of this kind."""
    return kind in (WAYPOINT, LOITER_UNLIMITED, LOITER_TIME, LOITER_TURNS, DELAY)


@law
def begin(nav: CopterNav, control: Control, est: Estimate, p: Parameters, time_us: int) -> None:
    """Begin the command that the shell has written."""
    nav.completed = False
    nav.since_us = 0
    nav.circle_running = False
    waypoint.start(nav, control, est, p, time_us)


@law
def run(nav: CopterNav, control: Control, est: Estimate, p: Parameters, time_us: int) -> bool:
    """One tick of a command that follows a path: writes position targets; whether the command is done."""
    kind = nav.command_kind
    if kind == LOITER_TURNS and (nav.circle_running or nav.reached):
        nav.active_us = time_us
        return circle.run(nav, control, est, p) >= nav.turns
    if not waypoint.advance(nav, control, est, p, time_us):
        return False
    return has_waited(nav, time_us) and kind in (WAYPOINT, LOITER_TIME, DELAY)


@law
def has_waited(nav: CopterNav, time_us: int) -> bool:
    """Whether the delay of the command is over; it counts from the first call."""
    if nav.since_us == 0:
        nav.since_us = time_us
    return (time_us - nav.since_us) * 1e-6 >= nav.delay
