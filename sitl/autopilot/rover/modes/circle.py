# SPDX-License-Identifier: BSD-3-Clause
"""CIRCLE: drives around a point (CIRC_RADIUS, CIRC_SPEED, CIRC_DIR); missions use it for LOITER_TURNS.

First to the edge, then after a target that runs along it. When the vehicle falls behind, the target waits and both get
slower by a fifth. CIRCLE_ADAPTED reports what a vehicle's limits changed.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ....core.algebra import direction, horizontal, norm2
from ....core.elementary import atan2
from ....core.kernels import law
from ....core.mavlink import MavSeverity
from ....core.scalars import constrain, wrap_pi
from ....core.vectors import Vec2
from ...control.shaping import Motion2
from ...events import Event, Events, emit
from ...modes import ModeResult
from ...state import Estimate
from ..control import position, speed
from ..control.state import DT, PositionState
from ..control.steering import lat_accel_max
from ..parameters import Parameters
from ..state import Vehicle
from . import drive
from .mode import POSITION_ON_CIRCLE, Destination, RoverMode
from .state import CircleState, Modes

CIRCLE = 9

RADIUS_MIN = 0.1  # [m]
DEFAULT_ACCEL = 1.0
"""When no parameter limits it [m/s^2]."""
SLOWER = 0.8

# What CIRCLE_ADAPTED says
SPEED_LIMITED, RADIUS_ENLARGED, FELL_BEHIND = 0, 1, 2
_TEXTS = {
    SPEED_LIMITED: "Circle: max speed is {b:4.1f}",
    RADIUS_ENLARGED: "Circle: radius increased to TURN_RADIUS ({b:4.1f})",
    FELL_BEHIND: "Circle: cannot keep up, slowing to {b:.1f}m/s",
}
CIRCLE_ADAPTED = Event(26, MavSeverity.WARNING, _TEXTS)  # b: the value now


class Circuit(NamedTuple):
    """A circle to drive, and where on it to begin."""

    centre: Vec2  # [m]
    radius: float  # [m]
    direction: float  # 1 clockwise, -1 counter-clockwise
    angle: float  # of the beginning, seen from the centre [rad]


@law
def tolerance(radius: float, turn_radius: float) -> float:
    """Distance from the edge [m] that counts as on it."""
    return max(turn_radius, 0.2 if radius >= 0.5 else 0.1)


@law
def set_radius(circle: CircleState, events: Events, time_us: int, radius: float, turn_radius: float) -> None:
    """A circle [m] that a vehicle with this ``turn_radius`` [m] can drive."""
    circle.radius = max(abs(radius), RADIUS_MIN)
    if circle.radius < turn_radius:
        circle.radius = turn_radius
        emit(events, time_us, CIRCLE_ADAPTED, float(RADIUS_ENLARGED), circle.radius)


@law
def set_speed(circle: CircleState, events: Events, time_us: int, wanted: float, accel_max: float) -> None:
    """Speed [m/s] around the circle, within what the lateral acceleration ``accel_max`` [m/s^2] allows."""
    speed_max = math.sqrt(accel_max * circle.radius)
    circle.speed = min(wanted, speed_max)
    if wanted > speed_max:
        emit(events, time_us, CIRCLE_ADAPTED, float(SPEED_LIMITED), speed_max)


@law
def acceleration(params: Parameters) -> float:
    """Of the target along the circle [m/s^2] (WP_ACCEL within ATC_ACCEL_MAX and ATC_DECEL_MAX)."""
    limit = min(params.ATC.ACCEL_MAX, speed.decel_max(params.ATC))
    if limit <= 0.0:
        limit = DEFAULT_ACCEL
    return min(limit, params.WP.ACCEL) if params.WP.ACCEL > 0.0 else limit


@law
def set_limits(c: PositionState, circle: CircleState, params: Parameters) -> None:
    """Limits of the position controller for this circle."""
    accel = acceleration(params)
    jerk = params.WP.JERK if params.WP.JERK > 0.0 else accel
    position.set_limits(c, circle.speed, accel, lat_accel_max(params.ATC), jerk)


@law
def set_up(circle: CircleState, wanted: Circuit, events: Events, time_us: int, params: Parameters) -> None:
    """A circle that the vehicle can drive, begun at its edge."""
    circle.centre = wanted.centre
    set_radius(circle, events, time_us, wanted.radius, params.TURN_RADIUS)
    circle.direction = wanted.direction
    wanted_speed = params.CIRC.SPEED if params.CIRC.SPEED > 0.0 else params.WP.SPEED
    set_speed(circle, events, time_us, wanted_speed, lat_accel_max(params.ATC))
    circle.angle = wanted.angle
    circle.target_speed = 0.0
    circle.total = 0.0
    circle.at_edge = False
    circle.waiting = False
    circle.target = edge(circle)


@law
def begin(v: Vehicle, wanted: Circuit) -> int:
    """Drive to a circle and along it. ACCEPTED, or INIT_FAILED without an origin."""
    ap = v.autopilot
    if not ap.estimate.origin_set:
        return ModeResult.INIT_FAILED
    set_up(ap.modes.circle, wanted, ap.events, v.time_us, ap.params)
    set_limits(ap.control.position, ap.modes.circle, ap.params)
    position.init(ap.control.position, ap.estimate)
    return ModeResult.ACCEPTED


@law
def start(v: Vehicle) -> int:
    """Enter: around where the vehicle is, beginning ahead of its nose."""
    p = v.autopilot.params.CIRC
    est = v.autopilot.estimate
    return begin(v, Circuit(horizontal(est.pos), p.RADIUS, -1.0 if p.DIR == 1.0 else 1.0, est.yaw))


@law
def circuit_around(centre: Vec2, radius: float, estimate: Estimate) -> Circuit:
    """For missions: around ``centre`` [m], beginning at the nearest point of the edge; counter-clockwise below 0."""
    return Circuit(centre, abs(radius), -1.0 if radius < 0.0 else 1.0, angle_from(centre, estimate))


@law
def angle_from(centre: Vec2, estimate: Estimate) -> float:
    """Direction [rad] in which the vehicle is seen from ``centre`` [m]; its heading when it is there."""
    away = horizontal(estimate.pos) - centre
    if away.x == 0.0 and away.y == 0.0:
        return estimate.yaw
    return atan2(away.y, away.x)


@law
def edge(circle: CircleState) -> Vec2:
    """The point of the edge at ``angle`` [m]."""
    return circle.centre + direction(circle.angle) * circle.radius


@law
def edge_distance(circle: CircleState, pos: Vec2) -> float:
    """Distance of ``pos`` from the edge [m]."""
    return abs(norm2(pos - circle.centre) - circle.radius)


@law
def advance(circle: CircleState, accel_max: float, estimate: Estimate) -> Motion2:
    """Move the target along the edge by one period, no faster than ``accel_max`` [m/s^2] lets it; how it moves now."""
    change_max = 0.5 * accel_max * DT
    change = constrain(circle.speed - circle.target_speed, -change_max, change_max)
    circle.target_speed += change
    if not circle.waiting:
        step = circle.direction * circle.target_speed / circle.radius * DT
        circle.angle = wrap_pi(circle.angle + step)
        circle.total += step
    else:
        circle.angle = angle_from(circle.centre, estimate)
    circle.target = edge(circle)
    out = direction(circle.angle)
    along = Vec2(-out.y * circle.direction, out.x * circle.direction)
    size = circle.target_speed
    return Motion2(circle.target, size * along, change / DT * along - size * size / circle.radius * out)


@law
def follow(circle: CircleState, c: PositionState, estimate: Estimate, turn_radius: float) -> bool:
    """To the edge, then along it; whether the vehicle has just fallen behind, so that the target waits."""
    away = edge_distance(circle, horizontal(estimate.pos))
    near = tolerance(circle.radius, turn_radius)
    if not circle.at_edge:
        circle.at_edge = away <= near
        position.input_pos(c, circle.target)
    elif away > 2.0 * near and not circle.waiting:
        circle.speed *= SLOWER
        circle.waiting = True
        return True
    elif away < near and circle.waiting:
        circle.waiting = False
    else:
        position.set_pos_vel_accel(c, advance(circle, c.accel_max, estimate))
    return False


@law
def run(v: Vehicle) -> None:
    """One period; stops without a position."""
    ap = v.autopilot
    circle = ap.modes.circle
    control, armed, p = ap.control, ap.arming.armed, ap.params
    if not ap.estimate.position_ok:
        speed.stop(control, armed, p)
        return
    if follow(circle, control.position, ap.estimate, p.TURN_RADIUS):
        emit(ap.events, v.time_us, CIRCLE_ADAPTED, float(FELL_BEHIND), circle.speed)
    position.follow_target(control, ap.estimate, armed, p)
    drive.turn(control, ap.estimate, ap.modes.pilot, control.position.desired_turn_rate, p)
    drive.on_path(v, control.position.desired_speed)


@law
def turns(circle: CircleState) -> float:
    """Turns driven so far, whatever the direction."""
    return abs(circle.total) / (2.0 * math.pi)


def change_speed(v: Vehicle, wanted: float) -> bool:
    """DO_CHANGE_SPEED [m/s]; False for one that is not positive."""
    if wanted <= 0.0:
        return False
    ap = v.autopilot
    circle, c = ap.modes.circle, ap.control.position
    set_speed(circle, ap.events, v.time_us, wanted, lat_accel_max(ap.params.ATC))
    if circle.speed > c.speed_max:
        set_limits(c, circle, ap.params)
    return True


@law
def destination(modes: Modes) -> Destination:
    """The target that goes round."""
    return Destination(POSITION_ON_CIRCLE, modes.circle.target)


MODE = RoverMode(
    number=CIRCLE,
    name="CIRCLE",
    start=start,
    run=run,
    needs_position=True,
    autonomous=True,
    destination=destination,
    change_speed=change_speed,
)
