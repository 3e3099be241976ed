# SPDX-License-Identifier: BSD-3-Clause
"""GUIDED: drives what the set-points say; a set-point too old stops the vehicle.

``guided_setpoints`` takes the set-points. Positions are good until the next one. A mission's GUIDED_ENABLE drives so,
too, within limits of time and distance.
"""

from __future__ import annotations

from ....core.algebra import horizontal, norm2
from ....core.kernels import law
from ....core.vectors import Vec2
from ...events import GUIDED_REACHED, GUIDED_TIMEOUT, emit
from ...modes import ACCEPTED
from ..control import motors, speed
from ..navigation import waypoint
from ..state import Vehicle
from . import drive
from .mode import Destination, RoverMode, end_of_path, no_destination
from .state import GuidedState

GUIDED = 15

STOP, POSITION, HEADING_AND_SPEED, TURN_RATE_AND_SPEED, STEERING_AND_THROTTLE = 0, 1, 2, 3, 4
"""What it is doing (``modes.guided.submode``)."""
TIMEOUT_US = 3_000_000
"""Velocity, heading, turn-rate and throttle set-points are good for so long (ArduRover's)."""


@law
def start(v: Vehicle) -> int:
    """Enter: stops until a set-point comes."""
    guided = v.autopilot.modes.guided
    waypoint.start(v.autopilot)
    guided.submode = STOP
    guided.has_target = False
    guided.reached_told = True
    return ACCEPTED


@law
def check_age(v: Vehicle) -> None:
    """Drop a set-point that is too old, and say so once."""
    guided = v.autopilot.modes.guided
    if guided.has_target and v.time_us - guided.update_us > TIMEOUT_US:
        guided.has_target = False
        emit(v.autopilot.events, v.time_us, GUIDED_TIMEOUT, TIMEOUT_US * 1e-6, 0.0)


@law
def run_position(v: Vehicle) -> None:
    """One period of a position target."""
    ap = v.autopilot
    if not waypoint.reached(ap):
        drive.follow_path(v)
        return
    if not ap.modes.guided.reached_told:
        ap.modes.guided.reached_told = True
        emit(ap.events, v.time_us, GUIDED_REACHED, 0.0, 0.0)
    speed.stop(v)


@law
def run(v: Vehicle) -> None:
    """One period."""
    ap = v.autopilot
    guided = ap.modes.guided
    kind = guided.submode
    if kind == POSITION:
        run_position(v)
        return
    check_age(v)
    if kind == STOP or not guided.has_target:
        speed.stop(v)
    elif kind == STEERING_AND_THROTTLE:
        motors.set_steering_unscaled(ap, guided.steering)
        motors.set_throttle(ap, guided.throttle)
    else:
        if kind == TURN_RATE_AND_SPEED:
            drive.turn(ap, guided.turn_rate)
        elif kind == HEADING_AND_SPEED:
            drive.turn_to(ap, guided.heading)
        speed.drive(v, drive.nudged(ap, guided.speed))


@law
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
def start_in_mission(v: Vehicle) -> None:
    """Guided within a mission begins here and now."""
    ap = v.autopilot
    start(v)
    ap.modes.guided.limit_since_us = v.time_us
    ap.modes.guided.limit_from = horizontal(ap.estimate.pos)


@law
def destination(v: Vehicle) -> Destination:
    """The set-point, when it is a position."""
    return end_of_path(v) if v.autopilot.modes.guided.submode == POSITION else no_destination(v)


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
