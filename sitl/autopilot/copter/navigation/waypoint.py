# SPDX-License-Identifier: BSD-3-Clause
"""Flies along planned legs: gives the target to the controllers and waits for a vehicle that lags.

For the modes::

    start(nav, ...)              begin at the planned legs (AUTO: when a command with legs was given)
    advance(nav, ...) -> bool    one tick: moves the target, hands it to the controllers; whether it is reached
    stop(nav)                    forget all legs

and ``request_leg``, ``distance``, ``bearing`` of ``navigation.path``. After ``advance``, ``nav.pos``, ``nav.vel``,
``nav.acc`` hold the target. Corners stay within WPNAV_RADIUS and WPNAV_ACCEL_C.
"""

from __future__ import annotations

import math

from ....core.algebra import ZERO, dot, horizontal
from ....core.kernels import law
from ....core.scalars import constrain
from ....core.vectors import Vec3
from ...control.shaping import Motion, Motion2
from ...navigation import path
from ...navigation.state import STRAIGHT
from ...state import Estimate
from ..control.altitude import input_vel_accel_d, set_pos_vel_accel_d
from ..control.altitude_start import init_d_stopping_point, set_max_speed_accel_d
from ..control.position import brake_ne, set_pos_vel_accel_ne
from ..control.position_ned import input_pos_ned
from ..control.position_start import init_ne_stopping_point, set_max_speed_accel_ne
from ..control.state import DT, Control
from ..parameters import Parameters
from ..parameters.flight_modes import Legs
from . import spline
from .state import CopterNav

CM = 0.01


@law
def speed_ne(nav: CopterNav, p: Legs) -> float:
    """Horizontal speed limit along legs [m/s]."""
    return nav.speed_ne if nav.speed_ne > 0.0 else max(CM * p.SPEED, 0.1)


@law
def speed_up(nav: CopterNav, p: Legs) -> float:
    """Climb speed limit along legs [m/s]."""
    return nav.speed_up if nav.speed_up > 0.0 else max(CM * p.SPEED_UP, 0.1)


@law
def speed_down(nav: CopterNav, p: Legs) -> float:
    """Descent speed limit along legs [m/s]."""
    return nav.speed_down if nav.speed_down > 0.0 else max(CM * p.SPEED_DN, 0.1)


@law
def set_limits(control: Control, nav: CopterNav, p: Parameters) -> None:
    """Give the position controllers the limits of legs."""
    legs = p.WPNAV
    set_max_speed_accel_ne(control.pos_ne, p, speed_ne(nav, legs), CM * legs.ACCEL)
    set_max_speed_accel_d(control.pos_d, p.PSC, speed_down(nav, legs), speed_up(nav, legs), CM * legs.ACCEL_Z)


@law
def start(nav: CopterNav, control: Control, est: Estimate, p: Parameters, time_us: int) -> None:
    """Begin at the planned legs.

    A leg that continues the one just flown keeps the controllers as they are.
    """
    set_limits(control, nav, p)
    if nav.fresh:
        nav.fresh = False
        init_ne_stopping_point(control, est, p)
        init_d_stopping_point(control, est, p)
        nav.time_scale = 1.0
        nav.pause_scale = 1.0
        nav.pause_rate = 0.0
        nav.pos = nav.current.origin
        nav.vel = ZERO
        nav.acc = ZERO
    nav.active_us = time_us


@law
def stop(nav: CopterNav) -> None:
    """Forget all legs."""
    path.stop(nav)
    nav.over_ground = False
    nav.spline.active = False
    nav.paused = False


@law
def corner_accel(p: Legs) -> float:
    """Acceleration that corners may need [m/s^2]."""
    return CM * (p.ACCEL_C if p.ACCEL_C > 0.0 else 2.0 * p.ACCEL)


@law
def advance(nav: CopterNav, control: Control, est: Estimate, p: Parameters, time_us: int) -> bool:
    """One tick along the legs; whether the destination is reached (a corner: when the next leg takes over)."""
    legs, pos, vel = p.WPNAV, est.pos, est.vel
    if nav.request_pending != 0 or nav.current.segments < 1:
        return False
    nav.active_us = time_us
    if nav.over_ground:
        if nav.ground_lost:
            brake_ne(control.pos_ne)
            input_vel_accel_d(control.pos_d, 0.0, 0.0)
            return False
        pos, vel = Vec3(pos.x, pos.y, pos.z - nav.ground_d), Vec3(vel.x, vel.y, vel.z - nav.ground_vel)
    if nav.detour.bend != STRAIGHT:
        steer(nav, control)
        return False
    feasible = path.feasible_time_scale(nav, pos, vel, p.PSC.POSXY_P)
    path.scale_time(nav, feasible, CM * legs.ACCEL / max(legs.JERK, 0.1), DT)
    advance_pause(nav, legs, p.PSC.JERK_XY)
    step = nav.time_scale * nav.pause_scale * DT
    if nav.spline.active:
        part = spline.ACCEL_PART * CM
        done = spline.move(nav, step, max(part * legs.ACCEL, 0.05), max(part * legs.ACCEL_Z, 0.05))
        # ArduPilot's goes on from the slower target: it stops at once, and waits for the end of a pause's ramp.
        nav.spline.speed *= nav.pause_scale
    else:
        done = path.move(nav, step, CM * legs.RADIUS, corner_accel(legs))
    nav.acc = nav.acc * nav.pause_scale * nav.pause_scale + nav.vel * nav.pause_rate
    nav.vel = nav.vel * nav.pause_scale
    follow_target(control, nav, nav.vel.z, nav.acc.z)
    if done and (nav.current.fast or is_near_end(nav, pos, CM * legs.RADIUS)):
        path.arrive(nav)
    return nav.reached


@law
def steer(nav: CopterNav, control: Control) -> None:
    """One tick straight to BendyRuler's target."""
    target = nav.detour.bent_target
    nav.pos = Vec3(target.x, target.y, target.z - nav.ground_d) if nav.over_ground else target
    nav.vel, nav.acc = ZERO, ZERO
    input_pos_ned(control.pos_ne, control.pos_d, target)


@law
def follow_target(control: Control, nav: CopterNav, climb: float, climb_accel: float) -> None:
    """Hand the target to the controllers, which climb with it at ``climb`` [m/s], ``climb_accel`` [m/s^2]."""
    set_pos_vel_accel_ne(control.pos_ne, Motion2(horizontal(nav.pos), horizontal(nav.vel), horizontal(nav.acc)))
    set_pos_vel_accel_d(control.pos_d, over_ground(nav, Motion(nav.pos.z, climb, climb_accel)))


@law
def over_ground(nav: CopterNav, path: Motion) -> Motion:
    """The height of a path, down from the origin [m]: with that of the ground where it is above the ground."""
    if not nav.over_ground:
        return path
    return Motion(path.pos + nav.ground_d, path.vel + nav.ground_vel, path.acc + nav.ground_acc)


@law
def from_origin(nav: CopterNav, point: Vec3) -> Vec3:
    """A position on the way, NED from the origin [m]: its height may be above the ground."""
    return Vec3(point.x, point.y, point.z + nav.ground_d) if nav.over_ground else point


@law
def advance_pause(nav: CopterNav, p: Legs, jerk: float) -> None:
    """Path time stops when paused and runs again after, with WPNAV_ACCEL and ``jerk`` [m/s^3] felt at full speed."""
    wanted = 0.0 if nav.paused else 1.0
    error = wanted - nav.pause_scale
    if error == 0.0 and nav.pause_rate == 0.0:
        return
    speed_max = speed_ne(nav, p)
    change = max(jerk, 0.1) / speed_max * DT
    aim = min(CM * p.ACCEL / speed_max, math.sqrt(2.0 * change / DT * abs(error)))
    aim = aim if error > 0.0 else -aim
    nav.pause_rate += constrain(aim - nav.pause_rate, -change, change)
    nav.pause_scale += nav.pause_rate * DT
    if abs(wanted - nav.pause_scale) < 1e-4 or (wanted - nav.pause_scale) * error < 0.0:
        nav.pause_scale = wanted
        nav.pause_rate = 0.0


@law
def is_near_end(nav: CopterNav, pos: Vec3, radius: float) -> bool:
    """Whether ``pos`` (NED) is within ``radius`` of the end of the current leg [m]."""
    away = nav.current.origin + nav.current.unit * nav.current.length - pos
    return dot(away, away) <= radius * radius
