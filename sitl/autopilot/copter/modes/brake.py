# SPDX-License-Identifier: BSD-3-Clause
"""BRAKE: stops as fast as is sensible and holds; the sticks do nothing."""

from __future__ import annotations

import math

from ....core.kernels import law
from ..control import altitude, altitude_start, attitude, position, position_start
from . import ground
from .mode import CopterMode, never_arms

BRAKE = 17

DECELERATION = 7.5
"""[m/s^2] (ArduPilot's)."""
SPEED_D = 2.5
"""Least climb and descent limit [m/s] (ArduPilot's)."""


@law
def start(v):
    """Enter. Returns 0."""
    ap = v.autopilot
    vn, ve, vd = float(ap.estimate.vel[0]), float(ap.estimate.vel[1]), float(ap.estimate.vel[2])
    position_start.set_max_speed_accel_ne(ap, max(math.hypot(vn, ve), 0.1), DECELERATION)
    position_start.init_ne(ap)
    altitude_start.set_max_speed_accel_d(ap, max(SPEED_D, vd), max(SPEED_D, -vd), DECELERATION)
    altitude_start.init_d(ap)
    return 0


@law
def run(v):
    """One tick."""
    ap = v.autopilot
    if ground.is_grounded(v):
        ground.handle(v)
    else:
        ap.control.motors.desired_spool = ground.UNLIMITED
        position.brake_ne(ap.control.pos_ne)
        altitude.input_vel_accel_d(ap.control.pos_d, 0.0, 0.0)
        position.update_ne(ap)
        altitude.update_d(ap)
        attitude.input_thrust_vector_heading_rate(ap, position.thrust_vector(ap.control.pos_ne), 0.0)


MODE = CopterMode(
    number=BRAKE,
    name="BRAKE",
    start=start,
    run=run,
    needs_position=True,
    autonomous=True,
    may_arm=never_arms,
)
