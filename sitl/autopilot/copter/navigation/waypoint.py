# SPDX-License-Identifier: BSD-3-Clause
"""Flies along planned legs: gives the target to the controllers and waits for a vehicle that lags.

For the modes::

    start(ap, time_us)              begin at the planned legs (AUTO: when a command with legs was given)
    advance(ap, time_us) -> int     one tick: moves the target, hands it to the controllers; 1 when reached
    stop(ap)                        forget all legs

and ``request_leg``, ``distance``, ``bearing`` of ``navigation.path``. After ``advance``, ``nav.pos``, ``nav.vel``,
``nav.acc`` hold the target. Corners stay within WPNAV_RADIUS and WPNAV_ACCEL_C.
"""

from __future__ import annotations

import math

from ....core.algebra import dot, horizontal
from ....core.kernels import law
from ....core.vectors import Vec3
from ...control.shaping import Motion, Motion2
from ...navigation import path
from ..control.altitude import set_pos_vel_accel_d
from ..control.altitude_start import init_d_stopping_point, set_max_speed_accel_d
from ..control.position import set_pos_vel_accel_ne
from ..control.position_start import init_ne_stopping_point, set_max_speed_accel_ne

DT = 0.0025
CM = 0.01


@law
def speed_ne(ap):
    """Horizontal speed limit along legs [m/s]."""
    nav = ap.modes.nav
    return nav.speed_ne if nav.speed_ne > 0.0 else max(CM * ap.params.WPNAV.SPEED, 0.1)


@law
def speed_up(ap):
    """Climb speed limit along legs [m/s]."""
    nav = ap.modes.nav
    return nav.speed_up if nav.speed_up > 0.0 else max(CM * ap.params.WPNAV.SPEED_UP, 0.1)


@law
def speed_down(ap):
    """Descent speed limit along legs [m/s]."""
    nav = ap.modes.nav
    return nav.speed_down if nav.speed_down > 0.0 else max(CM * ap.params.WPNAV.SPEED_DN, 0.1)


@law
def set_limits(ap):
    """Give the position controllers the limits of legs."""
    set_max_speed_accel_ne(ap, speed_ne(ap), CM * ap.params.WPNAV.ACCEL)
    set_max_speed_accel_d(ap, speed_down(ap), speed_up(ap), CM * ap.params.WPNAV.ACCEL_Z)


@law
def start(ap, time_us):
    """Begin at the planned legs.

    A leg that continues the one just flown keeps the controllers as they are.
    """
    nav = ap.modes.nav
    set_limits(ap)
    if nav.fresh:
        nav.fresh = False
        init_ne_stopping_point(ap)
        init_d_stopping_point(ap)
        nav.time_scale = 1.0
        nav.pause_scale = 1.0
        nav.pause_rate = 0.0
        nav.pos = nav.current.origin
        nav.vel = Vec3(0.0, 0.0, 0.0)
        nav.acc = Vec3(0.0, 0.0, 0.0)
    nav.active_us = time_us


@law
def stop(ap):
    """Forget all legs."""
    path.stop(ap.modes.nav)
    ap.modes.nav.paused = 0


@law
def corner_accel(ap):
    """Acceleration that corners may need [m/s^2]."""
    return CM * (ap.params.WPNAV.ACCEL_C if ap.params.WPNAV.ACCEL_C > 0.0 else 2.0 * ap.params.WPNAV.ACCEL)


@law
def advance(ap, time_us):
    """One tick along the legs; 1 when the destination is reached (a corner: when the next leg takes over)."""
    nav = ap.modes.nav
    if nav.request_pending != 0 or nav.current.segments < 1:
        return 0
    nav.active_us = time_us
    feasible = path.feasible_time_scale(nav, ap.estimate.pos, ap.estimate.vel, ap.params.PSC.POSXY_P)
    path.scale_time(nav, feasible, CM * ap.params.WPNAV.ACCEL / max(ap.params.WPNAV.JERK, 0.1), DT)
    _scale_pause(ap)
    done = path.move(nav, nav.time_scale * nav.pause_scale * DT, CM * ap.params.WPNAV.RADIUS, corner_accel(ap))
    nav.acc = nav.acc * nav.pause_scale * nav.pause_scale + nav.vel * nav.pause_rate
    nav.vel = nav.vel * nav.pause_scale
    set_pos_vel_accel_ne(ap.control.pos_ne, Motion2(horizontal(nav.pos), horizontal(nav.vel), horizontal(nav.acc)))
    set_pos_vel_accel_d(ap.control.pos_d, Motion(nav.pos.z, nav.vel.z, nav.acc.z))
    if done and not nav.reached:
        if nav.current.fast or _near_end(ap) != 0:
            nav.reached = True
    return int(nav.reached)


@law
def _scale_pause(ap):
    """Path time stops when paused and runs again after,
    with WPNAV_ACCEL and PSC_JERK_XY felt at full speed.
    """
    nav = ap.modes.nav
    wanted = 0.0 if nav.paused != 0 else 1.0
    error = wanted - nav.pause_scale
    if error == 0.0 and nav.pause_rate == 0.0:
        return
    top = speed_ne(ap)
    rate = CM * ap.params.WPNAV.ACCEL / top
    change = max(ap.params.PSC.JERK_XY, 0.1) / top * DT
    aim = min(rate, math.sqrt(2.0 * change / DT * abs(error)))
    aim = aim if error > 0.0 else -aim
    nav.pause_rate += min(max(aim - nav.pause_rate, -change), change)
    nav.pause_scale += nav.pause_rate * DT
    if abs(wanted - nav.pause_scale) < 1e-4 or (wanted - nav.pause_scale) * error < 0.0:
        nav.pause_scale = wanted
        nav.pause_rate = 0.0


@law
def _near_end(ap):
    """1 when the vehicle is within WPNAV_RADIUS of the end of the current leg."""
    nav = ap.modes.nav
    away = nav.current.origin + nav.current.unit * nav.current.length - ap.estimate.pos
    radius = CM * ap.params.WPNAV.RADIUS
    return 1 if dot(away, away) <= radius * radius else 0
