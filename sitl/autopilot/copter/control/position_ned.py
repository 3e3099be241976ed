# SPDX-License-Identifier: BSD-3-Clause
"""Horizontal and vertical position together: straight to a point, as GUIDED flies it."""

from __future__ import annotations

import math

from ....core.algebra import finite_vector, horizontal, norm, with_down
from ....core.kernels import law
from ....core.vectors import Vec2, Vec3
from ...control.shaping import Motion, Motion2, kinematic_limit
from .altitude import advance_d, input_vel_accel_d, shape_pos_d
from .position import advance_ne, brake_ne, shape_pos_ne
from .state import AltitudeState, PositionState


@law
def input_pos_ned(ne: PositionState, d: AltitudeState, target: Vec3) -> None:
    """Go to a point, NED [m], in a straight line: speed limits of both cascades hold along it."""
    if not finite_vector(target):
        brake_ne(ne)
        input_vel_accel_d(d, 0.0, 0.0)
        return
    advance_ne(ne)
    advance_d(d)
    offset = target - with_down(ne.pos_desired, d.pos_desired)
    length = norm(offset)
    speed_ne, speed_d = 0.0, 0.0
    if length > 1e-9:
        unit = offset / length
        speed = kinematic_limit(unit, ne.speed_max, d.speed_up, d.speed_down)
        speed_ne = speed * math.sqrt(unit.x * unit.x + unit.y * unit.y)
        speed_d = speed * abs(unit.z)
    rest = Vec2(0.0, 0.0)
    shape_pos_ne(ne, Motion2(horizontal(target), rest, rest), speed_ne)
    shape_pos_d(d, Motion(target.z, 0.0, 0.0), speed_d, speed_d)
