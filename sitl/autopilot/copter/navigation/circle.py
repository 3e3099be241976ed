# SPDX-License-Identifier: BSD-3-Clause
"""Circles around a point (NAV_LOITER_TURNS): ArduPilot's CIRCLE_RADIUS and CIRCLE_RATE,
limited by speed and acceleration.
"""

from __future__ import annotations

import math

from ....core.algebra import ZERO, ZERO2, horizontal
from ....core.elementary import atan2, hypot, sincos
from ....core.kernels import law
from ....core.scalars import constrain
from ....core.vectors import Vec3
from ...control.shaping import Motion, Motion2
from ...state import Estimate
from ..control.altitude import set_pos_vel_accel_d
from ..control.position import input_pos_vel_accel_ne
from ..control.state import DT, Control
from ..parameters import Parameters
from .state import CopterNav
from .waypoint import CM, over_ground, speed_ne

ANGULAR_ACCEL_MIN = math.radians(2.0)
"""[rad/s^2]"""


@law
def start(nav: CopterNav, pos: Vec3, yaw: float) -> None:
    """Start circling from ``pos`` (NED [m]), heading ``yaw`` [rad], around ``nav.circle_centre``."""
    away = pos - nav.circle_centre
    if hypot(away.x, away.y) > 0.05:
        nav.circle_angle = atan2(away.y, away.x)
    else:
        nav.circle_angle = yaw - math.pi  # at the centre: back out, looking ahead
    nav.circle_total = 0.0
    nav.circle_reported = 0
    nav.circle_rate = 0.0
    nav.circle_running = True


@law
def set_limits(nav: CopterNav, rate: float, speed_max: float, accel: float) -> None:
    """Turn rate and angular acceleration for ``nav.circle_radius``, negative counter-clockwise.

    ``rate``: wanted [rad/s]; ``speed_max`` [m/s], ``accel`` [m/s^2]: limits of the vehicle.
    """
    wanted = abs(rate)
    radius = abs(nav.circle_radius)
    if radius > 0.0:
        wanted = min(wanted, min(speed_max, math.sqrt(0.5 * accel * radius)) / radius)
        nav.circle_acc = max(accel / radius, ANGULAR_ACCEL_MIN)
    else:
        nav.circle_acc = max(wanted, ANGULAR_ACCEL_MIN)
    nav.circle_top_rate = wanted if nav.circle_radius >= 0.0 else -wanted


@law
def turned(nav: CopterNav) -> float:
    """Turns flown so far, positive whatever the direction."""
    return abs(nav.circle_total) / (2.0 * math.pi)


@law
def advance(nav: CopterNav) -> float:
    """Move the target one tick around the circle; the turns flown so far (positive whatever the direction)."""
    change = nav.circle_acc * DT
    step = constrain(nav.circle_top_rate - nav.circle_rate, -change, change)
    nav.circle_rate += step
    nav.circle_angle += nav.circle_rate * DT
    nav.circle_total += nav.circle_rate * DT
    if nav.circle_angle > math.pi:
        nav.circle_angle -= 2.0 * math.pi
    elif nav.circle_angle < -math.pi:
        nav.circle_angle += 2.0 * math.pi
    radius = abs(nav.circle_radius)
    sine, cosine = sincos(nav.circle_angle)
    n, e = radius * cosine, radius * sine
    centre = nav.circle_centre
    nav.pos = Vec3(centre.x + n, centre.y + e, centre.z)
    nav.vel = ZERO
    nav.acc = ZERO
    return turned(nav)


@law
def follow(nav: CopterNav, control: Control) -> None:
    """Go after the target as if it stood: as recorded, the vehicle flies behind it on a smaller circle."""
    input_pos_vel_accel_ne(control.pos_ne, Motion2(horizontal(nav.pos), ZERO2, ZERO2))


@law
def run(nav: CopterNav, control: Control, est: Estimate, p: Parameters) -> float:
    """One tick around the circle, begun with the first; the turns flown so far."""
    if not nav.circle_running:
        start(nav, est.pos, est.yaw)
        set_limits(nav, math.radians(p.CIRCLE.RATE), speed_ne(nav, p.WPNAV), CM * p.WPNAV.ACCEL)
    turns = advance(nav)
    follow(nav, control)
    set_pos_vel_accel_d(control.pos_d, over_ground(nav, Motion(nav.pos.z, 0.0, 0.0)))
    return turns
