# SPDX-License-Identifier: BSD-3-Clause
"""GUIDED: follows the set-points; it stops when they expire.

``guided_setpoints`` takes the set-points. Positions are good until the next one. A mission's GUIDED_ENABLE drives so,
too, within limits of time and distance.
"""

from __future__ import annotations

from ....core.algebra import norm2
from ....core.kernels import law
from ....core.mavlink import MavSeverity
from ....core.vectors import Vec2
from ...events import Event, Events, emit
from ...modes import ModeResult
from ...notes import ItemReached
from .. import pilot
from ..control import speed
from ..navigation import waypoint
from ..state import Vehicle
from . import drive
from .mode import Destination, RoverMode, end_of_path, no_destination
from .state import GuidedState, Modes

GUIDED = 15

STOP, POSITION, HEADING_AND_SPEED, TURN_RATE_AND_SPEED = 0, 1, 2, 3
"""What it is doing (``modes.guided.submode``)."""
TIMEOUT_US = 3_000_000
"""Velocity, heading and turn-rate set-points are good for so long (ArduRover's)."""

GUIDED_TIMEOUT = Event(9, MavSeverity.WARNING, "target not received last 3secs, stopping")
GUIDED_REACHED = Event(23, says=lambda v, a, b: [ItemReached(0)])  # the position target


@law
def start(v: Vehicle) -> int:
    """Enter: stops until a set-point comes."""
    ap = v.autopilot
    guided = ap.modes.guided
    waypoint.start(ap.modes.nav, ap.control.position, ap.params)
    guided.submode = STOP
    guided.has_target = False
    guided.arrival_reported = True
    return ModeResult.ACCEPTED


@law
def check_age(guided: GuidedState, events: Events, time_us: int) -> None:
    """Drop a set-point that is too old, and say so once."""
    if guided.has_target and time_us - guided.update_us > TIMEOUT_US:
        guided.has_target = False
        emit(events, time_us, GUIDED_TIMEOUT, TIMEOUT_US * 1e-6, 0.0)


@law
def note_arrival(guided: GuidedState, events: Events, time_us: int) -> None:
    """At a position target: say so once."""
    if not guided.arrival_reported:
        guided.arrival_reported = True
        emit(events, time_us, GUIDED_REACHED, 0.0, 0.0)


@law
def run(v: Vehicle) -> None:
    """One period."""
    ap = v.autopilot
    guided = ap.modes.guided
    control, armed, p = ap.control, ap.arming.armed, ap.params
    kind = guided.submode
    if kind != POSITION:
        check_age(guided, ap.events, v.time_us)
    elif not waypoint.reached(ap.modes.nav):
        drive.follow_path(v)
        return
    else:
        note_arrival(guided, ap.events, v.time_us)
    if kind in (POSITION, STOP) or not guided.has_target:
        speed.stop(control, armed, p)
    else:
        if kind == TURN_RATE_AND_SPEED:
            drive.turn(control, ap.estimate, ap.modes.pilot, guided.turn_rate, p)
        elif kind == HEADING_AND_SPEED:
            drive.turn_to(control, ap.estimate, ap.modes.pilot, guided.heading, p)
        drive.at_speed(v, pilot.nudged(ap.modes.pilot, guided.speed, p))


def change_speed(v: Vehicle, wanted: float) -> bool:
    """DO_CHANGE_SPEED [m/s]: only on the way to a position."""
    return v.autopilot.modes.guided.submode == POSITION and drive.change_path_speed(v, wanted)


@law
def is_at_limit(guided: GuidedState, time_us: int, pos: Vec2) -> bool:
    """Guided within a mission: whether its time is over or it has gone too far, at ``pos`` [m] (DO_GUIDED_LIMITS)."""
    if guided.limit_us > 0 and time_us - guided.limit_since_us >= guided.limit_us:
        return True
    return guided.limit_distance > 0.0 and norm2(pos - guided.limit_from) > guided.limit_distance


@law
def begin_limits(guided: GuidedState, time_us: int, pos: Vec2) -> None:
    """Guided within a mission begins now, at ``pos`` [m]."""
    guided.limit_since_us = time_us
    guided.limit_from = pos


@law
def destination(modes: Modes) -> Destination:
    """The set-point, when it is a position."""
    return end_of_path(modes) if modes.guided.submode == POSITION else no_destination(modes)


MODE = RoverMode(
    number=GUIDED,
    name="GUIDED",
    start=start,
    run=run,
    needs_position=True,
    autonomous=True,
    destination=destination,
    change_speed=change_speed,
)
