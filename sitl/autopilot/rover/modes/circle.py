# SPDX-License-Identifier: BSD-3-Clause
"""CIRCLE: drives around a point (CIRC_RADIUS, CIRC_SPEED, CIRC_DIR); missions use it for LOITER_TURNS.

First to the edge, then after a target that runs along it. When the vehicle falls behind, the target waits and both get
slower by a fifth. CIRCLE_ADAPTED tells what a vehicle's limits changed.
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.scalars import constrain, wrap_pi
from ....core.vectors import Vec2
from ...control.shaping import Motion2
from ...events import CIRCLE_ADAPTED, emit
from ..control import position, speed
from ..control.state import DT
from ..control.steering import lat_accel_max
from . import drive
from .numbers import ACCEPTED, INIT_FAILED

LEAST_RADIUS = 0.1  # [m]
DEFAULT_ACCEL = 1.0
"""When no parameter limits it [m/s^2]."""
SLOWER = 0.8

# What CIRCLE_ADAPTED says
SPEED_LIMITED, RADIUS_ENLARGED, FELL_BEHIND = 0, 1, 2


@law
def tolerance(ap):
    """Distance from the edge [m] that counts as on it."""
    least = 0.2 if ap.modes.circle.radius >= 0.5 else 0.1
    return max(float(ap.params.TURN_RADIUS), least)


@law
def set_radius(v, radius):
    """A circle that the vehicle can drive."""
    ap = v.autopilot
    circle = ap.modes.circle
    circle.radius = max(abs(radius), LEAST_RADIUS)
    if circle.radius < ap.params.TURN_RADIUS:
        circle.radius = ap.params.TURN_RADIUS
        emit(ap.events, v.time_us, CIRCLE_ADAPTED, float(RADIUS_ENLARGED), float(circle.radius))


@law
def set_speed(v, wanted):
    """Speed [m/s] around the circle, within what the lateral acceleration allows."""
    ap = v.autopilot
    circle = ap.modes.circle
    most = math.sqrt(lat_accel_max(ap.params.ATC) * float(circle.radius))
    circle.speed = min(wanted, most)
    if wanted > most:
        emit(ap.events, v.time_us, CIRCLE_ADAPTED, float(SPEED_LIMITED), most)


@law
def acceleration(ap):
    """Of the target along its way [m/s^2] (WP_ACCEL within ATC_ACCEL_MAX and ATC_DECEL_MAX)."""
    p = ap.params
    most = min(float(p.ATC.ACCEL_MAX), speed.decel_max(p.ATC))
    if most <= 0.0:
        most = DEFAULT_ACCEL
    return min(most, float(p.WP.ACCEL)) if p.WP.ACCEL > 0.0 else most


@law
def set_limits(ap):
    """Limits of the position controller for this circle."""
    accel = acceleration(ap)
    jerk = float(ap.params.WP.JERK) if ap.params.WP.JERK > 0.0 else accel
    position.set_limits(ap.control.position, float(ap.modes.circle.speed), accel, lat_accel_max(ap.params.ATC), jerk)


@law
def begin(v, n, e, radius, direction, angle):
    """Start on a circle around (n, e) [m], at ``angle`` [rad] seen from there; ``direction`` 1 clockwise, -1 not."""
    ap = v.autopilot
    if ap.estimate.origin_set == 0:
        return INIT_FAILED
    circle = ap.modes.circle
    circle.centre[0], circle.centre[1] = n, e
    set_radius(v, radius)
    circle.direction = direction
    set_speed(v, float(ap.params.CIRC.SPEED) if ap.params.CIRC.SPEED > 0.0 else float(ap.params.WP.SPEED))
    circle.angle = angle
    circle.target_speed = 0.0
    circle.total = 0.0
    circle.at_edge = 0
    circle.waiting = 0
    set_limits(ap)
    position.init(ap.control.position, ap.estimate)
    place_target(ap)
    return ACCEPTED


@law
def start(v):
    """Enter: around where the vehicle is, beginning ahead of its nose."""
    ap = v.autopilot
    direction = -1.0 if ap.params.CIRC.DIR == 1.0 else 1.0
    n, e = float(ap.estimate.pos[0]), float(ap.estimate.pos[1])
    return begin(v, n, e, float(ap.params.CIRC.RADIUS), direction, float(ap.estimate.euler[2]))


@law
def start_around(v, n, e, radius, direction):
    """For missions: around (n, e) [m], beginning at the nearest point of the edge."""
    return begin(v, n, e, radius, direction, angle_from(v.autopilot, n, e))


@law
def angle_from(ap, n, e):
    """Direction [rad] in which the vehicle is seen from (n, e); its heading when it is there."""
    north, east = float(ap.estimate.pos[0]) - n, float(ap.estimate.pos[1]) - e
    if north == 0.0 and east == 0.0:
        return float(ap.estimate.euler[2])
    return math.atan2(east, north)


@law
def place_target(ap):
    """The point of the edge at ``angle``."""
    circle = ap.modes.circle
    circle.target[0] = circle.centre[0] + circle.radius * math.cos(circle.angle)
    circle.target[1] = circle.centre[1] + circle.radius * math.sin(circle.angle)


@law
def edge_distance(ap):
    """Distance of the vehicle from the edge [m]."""
    circle = ap.modes.circle
    north = float(ap.estimate.pos[0]) - float(circle.centre[0])
    east = float(ap.estimate.pos[1]) - float(circle.centre[1])
    return abs(math.sqrt(north * north + east * east) - float(circle.radius))


@law
def distance(ap):
    """Distance to the target on the edge [m]."""
    circle = ap.modes.circle
    north = float(circle.target[0]) - float(ap.estimate.pos[0])
    east = float(circle.target[1]) - float(ap.estimate.pos[1])
    return math.sqrt(north * north + east * east)


@law
def advance(ap):
    """Move the target along the edge by one period, and the position controller's with it."""
    circle = ap.modes.circle
    most = 0.5 * float(ap.control.position.accel_max) * DT
    change = constrain(float(circle.speed) - float(circle.target_speed), -most, most)
    circle.target_speed += change
    if circle.waiting == 0:
        step = circle.direction * circle.target_speed / circle.radius * DT
        circle.angle = wrap_pi(float(circle.angle) + step)
        circle.total += step
    else:
        circle.angle = angle_from(ap, float(circle.centre[0]), float(circle.centre[1]))
    place_target(ap)
    out_n, out_e = math.cos(circle.angle), math.sin(circle.angle)
    along_n, along_e = -out_e * circle.direction, out_n * circle.direction
    size = float(circle.target_speed)
    inward, along = size * size / circle.radius, change / DT
    vel = Vec2(along_n * size, along_e * size)
    acc = Vec2(along_n * along - out_n * inward, along_e * along - out_e * inward)
    position.set_pos_vel_accel(ap.control.position, Motion2(Vec2(circle.target[0], circle.target[1]), vel, acc))


@law
def follow(v):
    """To the edge, then along it, waiting for a vehicle that falls behind."""
    ap = v.autopilot
    circle = ap.modes.circle
    away, near = edge_distance(ap), tolerance(ap)
    if circle.at_edge == 0:
        if away <= near:
            circle.at_edge = 1
        position.input_pos(ap.control.position, Vec2(circle.target[0], circle.target[1]))
    elif away > 2.0 * near and circle.waiting == 0:
        circle.speed *= SLOWER
        circle.waiting = 1
        emit(ap.events, v.time_us, CIRCLE_ADAPTED, float(FELL_BEHIND), float(circle.speed))
    elif away < near and circle.waiting != 0:
        circle.waiting = 0
    else:
        advance(ap)


@law
def run(v):
    """One period; stops without a position."""
    ap = v.autopilot
    if ap.estimate.position_ok == 0:
        speed.stop(v)
        return
    follow(v)
    position.follow_target(ap)
    drive.turn(v, float(ap.control.position.desired_turn_rate))
    speed.drive(v, float(ap.control.position.desired_speed))


@law
def turns(ap):
    """Turns driven so far, whatever the direction."""
    return abs(float(ap.modes.circle.total)) / (2.0 * math.pi)


@law
def change_speed(v, wanted):
    """MAV_CMD_DO_CHANGE_SPEED: 1, or 0 for a speed that is not positive."""
    if wanted <= 0.0:
        return 0
    ap = v.autopilot
    set_speed(v, wanted)
    if ap.modes.circle.speed > ap.control.position.speed_max:
        set_limits(ap)
    return 1
