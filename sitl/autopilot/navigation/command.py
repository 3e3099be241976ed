# SPDX-License-Identifier: BSD-3-Clause
"""When a navigation command, or the condition before do-commands, is done: the shell is told once."""

from __future__ import annotations

from ...core.kernels import law
from ..events import COMMAND_ARRIVED, COMMAND_COMPLETE, emit, emit_and_return
from .path import distance
from .state import CONDITION_DELAY, CONDITION_DISTANCE, CONDITION_NONE, CONDITION_YAW, DO_COMMAND, NAV_COMMAND


@law
def arrive(ap, time_us):
    """The command under way has come to its place, where it may wait: ``nav.since_us`` counts from now."""
    nav = ap.modes.nav
    nav.since_us = time_us
    emit(ap.events, time_us, COMMAND_ARRIVED, NAV_COMMAND, float(nav.command_count))


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
        met = distance(ap) < nav.condition_distance
    elif kind == CONDITION_YAW:
        met = yaw_reached != 0
    if met:
        nav.condition_kind = CONDITION_NONE
        emit_and_return(ap.events, time_us, COMMAND_COMPLETE, DO_COMMAND, float(nav.mission_do))
