# SPDX-License-Identifier: BSD-3-Clause
"""Avoidance at work: what is to be avoided now, and the velocities, climb rates and leans of modes kept to it.

A mode asks only while ``is_active``. Copters are limited in LOITER, in GUIDED with velocities and, by their lean, in
ALT_HOLD; their climb rate in all modes in which the throttle stick is one; rovers in all modes that control the speed.
"""

from __future__ import annotations

from ...core.algebra import direction, dot2, horizontal
from ...core.kernels import law
from ...core.vectors import Vec2
from ..fence.checks import active, margin_of
from ..fence.shapes import use_origin
from ..fence.state import AREAS, CIRCLE
from ..state import Autopilot, Vehicle
from . import fences, objects, obstacles, proximity, velocity
from .state import Avoidance
from .velocity import Braking

FENCES, OBSTACLES = 1, 2
"""AVOID_ENABLE"""


@law
def is_active(avoid: Avoidance) -> bool:
    """Whether there is anything to avoid."""
    return avoid.obstacles or avoid.fences != 0


@law
def watch(v: Vehicle, too_low: bool) -> None:
    """Ten times a second: look around, and say what is to be avoided; ``too_low`` for obstacles."""
    ap = v.autopilot
    seen, p = ap.proximity, ap.params
    if seen.kind in proximity.LIDARS:
        if v.sensors.lidar_count > 0:
            before = seen.scan
            proximity.look(seen, v.sensors, v.time_us, p.PRX.FILT, p.PRX1)
            if seen.scan != before and objects.are_noted(ap):
                objects.note_scan(ap, v.sensors, v.time_us)
        elif seen.kind == proximity.SIMULATED and ap.fence.shapes > 0 and ap.estimate.origin_set:
            use_origin(ap.fence, ap.estimate)
            fences.look(seen, ap.fence, horizontal(ap.estimate.pos), ap.estimate.yaw, p.PRX1)
            proximity.end_scan(seen, v.time_us, p.PRX.FILT)
    enabled = int(p.AVOID.ENABLE)
    watched = seen.kind != 0 and (enabled & OBSTACLES) != 0 and not ap.avoid.switched_off
    ap.avoid.obstacles = watched and not too_low and proximity.has_data(seen, v.time_us)
    ap.avoid.fences = active(ap.fence, p.FENCE) if (enabled & FENCES) != 0 else 0


@law
def limit_by_fences(ap: Autopilot, vel: Vec2, b: Braking) -> Vec2:
    """``vel`` (NE [m/s]) that keeps FENCE_MARGIN from the circle around home and from the edges of areas."""
    avoid, p, pos = ap.avoid, ap.params.FENCE, horizontal(ap.estimate.pos)
    margin = fences.Margin(margin_of(CIRCLE, p), b)
    if (avoid.fences & CIRCLE) != 0 and ap.home.is_set:
        vel = fences.stay_within_circle(avoid, vel, horizontal(ap.home.pos) - pos, p.RADIUS, margin)
    if (avoid.fences & AREAS) != 0:
        vel = fences.avoid_areas(avoid, ap.fence, vel, pos, margin)
    return vel


@law
def limit_velocity(ap: Autopilot, time_us: int, vel: Vec2, b: Braking) -> Vec2:
    """``vel`` (NE [m/s]) that keeps away from obstacles and fences."""
    avoid, p = ap.avoid, ap.params.AVOID
    velocity.begin(avoid)
    safe = vel
    if avoid.obstacles:
        safe = obstacles.avoid_obstacles(avoid, ap.proximity, safe, ap.estimate.yaw, time_us, p, b)
    if avoid.fences != 0 and ap.estimate.position_ok:
        safe = limit_by_fences(ap, safe, b)
    safe = velocity.with_backing(avoid, safe, p.BACKUP_SPD)
    return velocity.changed_slowly(avoid, vel, safe, time_us, p.ACCEL_MAX, b.dt)


@law
def limit_speed(ap: Autopilot, time_us: int, speed: float, b: Braking) -> float:
    """A speed along the nose [m/s], backwards negative, that keeps away from obstacles and fences."""
    yaw = ap.estimate.yaw
    nose = direction(yaw)
    return dot2(limit_velocity(ap, time_us, nose * speed, b), nose)
