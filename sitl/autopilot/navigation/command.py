# SPDX-License-Identifier: BSD-3-Clause
"""The navigation command under way: given by the shell, begun by AUTO when ``nav.command_count`` changes.

When it, or the condition before do-commands, is done, the shell is notified once.
"""

from __future__ import annotations

from ...core.kernels import law
from ...core.vectors import Vec3
from ..events import Events, emit, emit_and_return
from .path import distance
from .state import (
    COMMAND_ARRIVED,
    COMMAND_COMPLETE,
    CONDITION_DELAY,
    CONDITION_DISTANCE,
    CONDITION_NONE,
    CONDITION_YAW,
    DO_COMMAND,
    NAV_COMMAND,
    NONE,
    Nav,
)


def give(nav: Nav, kind: int, seq: int) -> None:
    """Command ``kind`` of ``state``, item ``seq`` of the mission, is under way; its other fields start from zero."""
    nav.command_kind, nav.command_seq = kind, seq
    nav.command_count += 1
    nav.completed, nav.since_us = False, 0
    nav.has_target, nav.delay, nav.turns = False, 0.0, 0.0


def give_none(nav: Nav) -> None:
    """No command is under way."""
    give(nav, NONE, 0)


@law
def arrive(nav: Nav, events: Events, time_us: int) -> None:
    """The command under way has come to its position, where it may wait: ``nav.since_us`` counts from now."""
    nav.since_us = time_us
    emit(events, time_us, COMMAND_ARRIVED, NAV_COMMAND, float(nav.command_count))


@law
def complete(nav: Nav, events: Events, time_us: int) -> None:
    """Report to the shell, once, that the navigation command is done."""
    if not nav.completed:
        nav.completed = True
        emit_and_return(events, time_us, COMMAND_COMPLETE, NAV_COMMAND, float(nav.command_count))


@law
def is_condition_met(nav: Nav, time_us: int, pos: Vec3, yaw_reached: bool) -> bool:
    """Whether the condition that holds back do-commands is met; ``pos`` NED [m]."""
    kind = nav.condition_kind
    if kind == CONDITION_DELAY:
        return time_us >= nav.condition_until_us
    if kind == CONDITION_DISTANCE:
        return distance(nav, pos) < nav.condition_distance
    return kind == CONDITION_YAW and yaw_reached


@law
def check_condition(nav: Nav, events: Events, time_us: int, pos: Vec3, yaw_reached: bool) -> None:
    """Report to the shell, once, that the condition which holds back do-commands is met; AUTO calls it every tick.

    ``pos``: NED [m]; ``yaw_reached``: the turn of CONDITION_YAW is done.
    """
    if is_condition_met(nav, time_us, pos, yaw_reached):
        nav.condition_kind = CONDITION_NONE
        emit_and_return(events, time_us, COMMAND_COMPLETE, DO_COMMAND, float(nav.mission_do))
