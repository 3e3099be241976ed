# SPDX-License-Identifier: BSD-3-Clause
"""CIRCLE: drives around a point (CIRC_RADIUS, CIRC_SPEED, CIRC_DIR); missions use it for LOITER_TURNS.

First to the edge, then after a target that runs along it. When the vehicle falls behind, the target waits and both get
slower by a fifth. CIRCLE_ADAPTED tells what a vehicle's limits changed.
"""

from __future__ import annotations

import math

from ....core.algebra import horizontal, norm2
from ....core.kernels import law
from ....core.scalars import constrain, wrap_pi
from ....core.vectors import Vec2
from ...control.shaping import Motion2
from ...events import CIRCLE_ADAPTED, emit
from ...modes import ACCEPTED, INIT_FAILED
from ...state import Estimate
from ..control import position, speed
from ..control.state import DT
from ..control.steering import lat_accel_max
from ..parameters import Parameters
from ..state import Autopilot, Vehicle
from . import drive
from .mode import PLACE_ON_CIRCLE, Destination, RoverMode
from .state import CircleState

CIRCLE = 9

RADIUS_MIN = 0.1  # [m]
DEFAULT_ACCEL = 1.0
"""When no parameter limits it [m/s^2]."""
SLOWER = 0.8

# What CIRCLE_ADAPTED says
SPEED_LIMITED, RADIUS_ENLARGED, FELL_BEHIND = 0, 1, 2


@law
def tolerance(radius: float, turn_radius: float) -> float:
    """Distance from the edge [m] that counts as on it."""
    return max(turn_radius, 0.2 if radius >= 0.5 else 0.1)


@law
def set_radius(v: Vehicle, radius: float) -> None:
    """A circle that the vehicle can drive [m]."""
    ap = v.autopilot
    circle = ap.modes.circle
    circle.radius = max(abs(radius), RADIUS_MIN)
    if circle.radius < ap.params.TURN_RADIUS:
        circle.radius = ap.params.TURN_RADIUS
        emit(ap.events, v.time_us, CIRCLE_ADAPTED, float(RADIUS_ENLARGED), circle.radius)


@law
def set_speed(v: Vehicle, wanted: float) -> None:
    """Speed [m/s] around the circle, within what the lateral acceleration allows."""
    ap = v.autopilot
    circle = ap.modes.circle
    speed_max = math.sqrt(lat_accel_max(ap.params.ATC) * circle.radius)
    circle.speed = min(wanted, speed_max)
    if wanted > speed_max:
        emit(ap.events, v.time_us, CIRCLE_ADAPTED, float(SPEED_LIMITED), speed_max)


@law
def acceleration(params: Parameters) -> float:
    """Of the target along its way [m/s^2] (WP_ACCEL within ATC_ACCEL_MAX and ATC_DECEL_MAX)."""
    limit = min(params.ATC.ACCEL_MAX, speed.decel_max(params.ATC))
    if limit <= 0.0:
        limit = DEFAULT_ACCEL
    return min(limit, params.WP.ACCEL) if params.WP.ACCEL > 0.0 else limit


@law
def set_limits(ap: Autopilot) -> None:
    """Limits of the position controller for this circle."""
    p = ap.params
    accel = acceleration(p)
    jerk = p.WP.JERK if p.WP.JERK > 0.0 else accel
    position.set_limits(ap.control.position, ap.modes.circle.speed, accel, lat_accel_max(p.ATC), jerk)


@law
def begin(v: Vehicle, centre: Vec2, radius: float, direction: float, angle: float) -> int:
    """Start on a circle around ``centre`` [m]; ``direction`` 1 clockwise, -1 not.

    At ``angle`` [rad] seen from the centre. ACCEPTED, or INIT_FAILED without an origin.
    """
    ap = v.autopilot
    if not ap.estimate.origin_set:
        return INIT_FAILED
    circle = ap.modes.circle
    circle.centre = centre
    set_radius(v, radius)
    circle.direction = direction
    set_speed(v, ap.params.CIRC.SPEED if ap.params.CIRC.SPEED > 0.0 else ap.params.WP.SPEED)
    circle.angle = angle
    circle.target_speed = 0.0
    circle.total = 0.0
    circle.at_edge = False
    circle.waiting = False
    set_limits(ap)
    position.init(ap.control.position, ap.estimate)
    circle.target = edge(circle)
    return ACCEPTED


@law
def start(v: Vehicle) -> int:
    """Enter: around where the vehicle is, beginning ahead of its nose."""
    p = v.autopilot.params.CIRC
    est = v.autopilot.estimate
    return begin(v, horizontal(est.pos), p.RADIUS, -1.0 if p.DIR == 1.0 else 1.0, est.euler.yaw)


@law
def start_around(v: Vehicle, centre: Vec2, radius: float, direction: float) -> int:
    """For missions: around ``centre`` [m], beginning at the nearest point of the edge."""
    return begin(v, centre, radius, direction, angle_from(centre, v.autopilot.estimate))


@law
def angle_from(centre: Vec2, estimate: Estimate) -> float:
    """Direction [rad] in which the vehicle is seen from ``centre`` [m]; its heading when it is there."""
    away = horizontal(estimate.pos) - centre
    if away.x == 0.0 and away.y == 0.0:
        return estimate.euler.yaw
    return math.atan2(away.y, away.x)


@law
def edge(circle: CircleState) -> Vec2:
    """The point of the edge at ``angle`` [m]."""
    return Vec2(
        circle.centre.x + circle.radius * math.cos(circle.angle),
        circle.centre.y + circle.radius * math.sin(circle.angle),
    )


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
    out = Vec2(math.cos(circle.angle), math.sin(circle.angle))
    along = Vec2(-out.y * circle.direction, out.x * circle.direction)
    size = circle.target_speed
    return Motion2(circle.target, size * along, change / DT * along - size * size / circle.radius * out)


@law
def follow(v: Vehicle) -> None:
    """To the edge, then along it, waiting for a vehicle that falls behind."""
    ap = v.autopilot
    circle = ap.modes.circle
    away = edge_distance(circle, horizontal(ap.estimate.pos))
    near = tolerance(circle.radius, ap.params.TURN_RADIUS)
    if not circle.at_edge:
        circle.at_edge = away <= near
        position.input_pos(ap.control.position, circle.target)
    elif away > 2.0 * near and not circle.waiting:
        circle.speed *= SLOWER
        circle.waiting = True
        emit(ap.events, v.time_us, CIRCLE_ADAPTED, float(FELL_BEHIND), circle.speed)
    elif away < near and circle.waiting:
        circle.waiting = False
    else:
        target = advance(circle, ap.control.position.accel_max, ap.estimate)
        position.set_pos_vel_accel(ap.control.position, target)


@law
def run(v: Vehicle) -> None:
    """One period; stops without a position."""
    ap = v.autopilot
    if not ap.estimate.position_ok:
        speed.stop(v)
        return
    follow(v)
    position.follow_target(ap)
    drive.turn(ap, ap.control.position.desired_turn_rate)
    speed.drive(v, ap.control.position.desired_speed)


@law
def turns(circle: CircleState) -> float:
    """Turns driven so far, whatever the direction."""
    return abs(circle.total) / (2.0 * math.pi)


@law
def change_speed(v: Vehicle, wanted: float) -> bool:
    """DO_CHANGE_SPEED [m/s]; False for one that is not positive."""
    if wanted <= 0.0:
        return False
    ap = v.autopilot
    set_speed(v, wanted)
    if ap.modes.circle.speed > ap.control.position.speed_max:
        set_limits(ap)
    return True


@law
def destination(v: Vehicle) -> Destination:
    """The target that goes round."""
    return Destination(PLACE_ON_CIRCLE, v.autopilot.modes.circle.target)


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
