# SPDX-License-Identifier: BSD-3-Clause
"""The copter's avoidance: climb rates, velocities and leans of its modes, kept away from obstacles and fences."""

from __future__ import annotations

import math

from ...core.elementary import sin, sincos
from ...core.kernels import law
from ...core.vectors import Vec2
from ..avoidance import limit, obstacles
from ..avoidance.proximity import Proximity
from ..avoidance.velocity import braking, climb_below
from ..fence.state import MAX_ALT, MIN_ALT
from ..state import Estimate
from .control.attitude import Lean
from .control.state import DT
from .parameters import Parameters
from .pilot import limit_stick
from .state import Vehicle

LEAN_SHARE = 0.75
"""Of the greatest lean, that avoidance may take."""


@law
def show_ground(seen: Proximity, estimate: Estimate, height: float, p: Parameters) -> None:
    """PRX_IGN_GND, PRX_ALT_MIN: the ground is not seen by a sensor ``height`` [m] over it; below 0: it is not known."""
    seen.has_height = p.PRX.IGN_GND == 1.0 and height >= 0.0
    seen.height = height if height >= p.PRX.ALT_MIN else 0.0
    lean = estimate.euler
    sine, cosine = sincos(lean.pitch)
    seen.tilt = Vec2(-sine, cosine * sin(lean.roll))


@law
def watch(v: Vehicle) -> None:
    """Ten times a second: look around, and say what is to be avoided."""
    ap, p = v.autopilot, v.autopilot.params
    height = -1.0
    if v.sensors.rangefinder_count > 0:
        height = float(v.sensors.rangefinder_range[0]) * ap.control.attitude.cos_lean
    if ap.proximity.kind != 0:
        show_ground(ap.proximity, ap.estimate, height, p)
    limit.watch(v, 0.0 <= height < p.AVOID.ALT_MIN)


@law
def limit_climb(v: Vehicle, climb: float) -> float:
    """A climb rate [m/s] that stays FENCE_MARGIN below the greatest height of the fence, and above the least."""
    ap, p = v.autopilot, v.autopilot.params
    if (ap.avoid.fences & (MAX_ALT | MIN_ALT)) == 0:
        return climb
    b = braking(p.PSC.POSZ_P, ap.control.pos_d.accel_max, DT, p.AVOID.BEHAVE)
    height = ap.home.pos.z - ap.estimate.pos.z
    if (ap.avoid.fences & MIN_ALT) != 0:
        climb = -climb_below(-climb, height - p.FENCE.ALT_MIN - p.FENCE.MARGIN, p.AVOID.BACKZ_SPD, b)
    if (ap.avoid.fences & MAX_ALT) != 0:
        climb = climb_below(climb, p.FENCE.ALT_MAX - p.FENCE.MARGIN - height, p.AVOID.BACKZ_SPD, b)
    return climb


@law
def limit_velocity(v: Vehicle, vel: Vec2) -> Vec2:
    """A velocity NE [m/s] that keeps away from obstacles and fences."""
    ap, p = v.autopilot, v.autopilot.params
    if not limit.is_active(ap.avoid):
        return vel
    return limit.limit_velocity(
        ap, v.time_us, vel, braking(p.PSC.POSXY_P, ap.control.pos_ne.accel_max, DT, p.AVOID.BEHAVE)
    )


@law
def limit_lean(v: Vehicle, lean: Lean, lean_max: float) -> Lean:
    """A lean of at most ``lean_max`` [rad], away from obstacles."""
    ap, p = v.autopilot, v.autopilot.params.AVOID
    if not ap.avoid.obstacles or p.ANGLE_MAX <= 0.0:
        return lean
    push = obstacles.push(ap.proximity, p.DIST_MAX, v.time_us)
    away = limit_stick(Vec2(push.roll, push.pitch) * math.radians(p.ANGLE_MAX * 0.01), LEAN_SHARE * lean_max)
    both = limit_stick(Vec2(lean.roll, lean.pitch) + away, lean_max)
    return Lean(both.x, both.y)
