# SPDX-License-Identifier: BSD-3-Clause
"""Circles around a point (NAV_LOITER_TURNS): ArduPilot's CIRCLE_RADIUS and CIRCLE_RATE,
limited by speed and acceleration.
"""

from __future__ import annotations

import math

from ....core.algebra import horizontal
from ....core.kernels import law
from ....core.vectors import Vec3
from ...control.shaping import Motion, Motion2
from ..control.altitude import set_pos_vel_accel_d
from ..control.position import set_pos_vel_accel_ne
from .waypoint import CM, DT, speed_ne

SLOWEST_ACCELERATION = math.radians(2.0)
"""Least angular acceleration [rad/s^2]."""


@law
def start(ap):
    """Start circling from where the vehicle is, seen from ``nav.circle_centre``;
    ``nav.circle_radius`` < 0 is counter-clockwise.
    """
    nav = ap.modes.nav
    n = ap.estimate.pos[0] - nav.circle_centre[0]
    e = ap.estimate.pos[1] - nav.circle_centre[1]
    if math.hypot(n, e) > 0.05:
        nav.circle_angle = math.atan2(e, n)
    else:
        nav.circle_angle = ap.estimate.euler[2] - math.pi  # at the centre: back out, looking ahead
    nav.circle_total = 0.0
    nav.circle_rate = 0.0
    wanted = abs(math.radians(ap.params.CIRCLE.RATE))
    radius = abs(nav.circle_radius)
    if radius > 0.0:
        acceleration = CM * ap.params.WPNAV.ACCEL
        top = min(speed_ne(ap), math.sqrt(0.5 * acceleration * radius)) / radius
        wanted = min(wanted, top)
        nav.circle_acc = max(acceleration / radius, SLOWEST_ACCELERATION)
    else:
        nav.circle_acc = max(wanted, SLOWEST_ACCELERATION)
    nav.circle_top_rate = wanted if nav.circle_radius >= 0.0 else -wanted
    nav.circle_running = 1


@law
def advance(ap):
    """One tick around the circle; returns the turns flown so far (positive whatever the direction)."""
    nav = ap.modes.nav
    change = nav.circle_acc * DT
    acc = min(max(nav.circle_top_rate - nav.circle_rate, -change), change)
    nav.circle_rate += acc
    nav.circle_angle += nav.circle_rate * DT
    nav.circle_total += nav.circle_rate * DT
    if nav.circle_angle > math.pi:
        nav.circle_angle -= 2.0 * math.pi
    elif nav.circle_angle < -math.pi:
        nav.circle_angle += 2.0 * math.pi
    radius = abs(nav.circle_radius)
    c = radius * math.cos(nav.circle_angle)
    s = radius * math.sin(nav.circle_angle)
    rate = nav.circle_rate
    nav.pos = Vec3(nav.circle_centre[0] + c, nav.circle_centre[1] + s, nav.circle_centre[2])
    nav.vel = Vec3(-s * rate, c * rate, 0.0)
    nav.acc = Vec3(-c * rate * rate - s * acc / DT, -s * rate * rate + c * acc / DT, 0.0)
    set_pos_vel_accel_ne(ap.control.pos_ne, Motion2(horizontal(nav.pos), horizontal(nav.vel), horizontal(nav.acc)))
    set_pos_vel_accel_d(ap.control.pos_d, Motion(nav.pos.z, 0.0, 0.0))
    return abs(nav.circle_total) / (2.0 * math.pi)
