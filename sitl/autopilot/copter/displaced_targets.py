# SPDX-License-Identifier: BSD-3-Clause
"""The copter's controllers and modes are put elsewhere with it: their targets keep their position beside the
vehicle."""

from __future__ import annotations

from ...core.displacement import (
    Displacement,
    faster_ne,
    moved,
    moved_ne,
    on_the_ground,
    turned,
    turned_attitude,
    turned_heading,
    turned_ne,
)
from ...core.kernels import law
from ..displacement import add_to_target, move_autopilot, move_path
from .control.state import AltitudeState, AttitudeState, PositionState
from .modes.autotune_gains import YAW
from .modes.state import AutotuneState, GuidedState, LoiterState, Modes
from .navigation.state import CopterNav
from .state import Autopilot


@law
def move_attitude(a: AttitudeState, d: Displacement) -> None:
    """The attitude asked for."""
    a.target_q = turned_attitude(d, a.target_q)


@law
def move_position(c: PositionState, d: Displacement) -> None:
    """Horizontal path and errors."""
    c.pos_desired, c.pos_error = moved_ne(d, c.pos_desired), turned_ne(d, c.pos_error)
    c.vel_desired, c.vel_target = faster_ne(d, c.vel_desired), faster_ne(d, c.vel_target)
    c.accel_desired, c.accel_target = turned_ne(d, c.accel_desired), turned_ne(d, c.accel_target)
    c.limit, c.vel_error = turned_ne(d, c.limit), turned_ne(d, c.vel_error)
    c.vel_derivative, c.vel_integrator = turned_ne(d, c.vel_derivative), turned_ne(d, c.vel_integrator)


@law
def move_altitude(c: AltitudeState, d: Displacement) -> None:
    """Vertical path."""
    c.pos_desired += d.shift.z
    c.vel_desired += d.velocity.z
    c.vel_target += d.velocity.z
    add_to_target(c.vel, d.velocity.z)


@law
def move_guided(g: GuidedState, d: Displacement) -> None:
    """GUIDED's set-point."""
    g.pos, g.vel, g.acc, g.q = moved(d, g.pos), turned(d, g.vel), turned(d, g.acc), turned_attitude(d, g.q)
    g.limit_from = moved_ne(d, g.limit_from)


@law
def move_loiter(state: LoiterState, d: Displacement) -> None:
    """LOITER's stick."""
    state.acc, state.predicted_acc = turned_ne(d, state.acc), turned_ne(d, state.predicted_acc)


@law
def move_autotune(t: AutotuneState, d: Displacement) -> None:
    """The position and heading that AUTOTUNE holds, and the heading from which a twitch in yaw began."""
    t.hold_pos, t.heading = moved_ne(d, t.hold_pos), turned_heading(d, t.heading)
    if t.axis >= YAW:
        t.start_angle += -d.angle if t.backwards else d.angle


@law
def move_circle(nav: CopterNav, d: Displacement) -> None:
    """A circle under way."""
    nav.circle_centre = moved(d, nav.circle_centre)
    nav.circle_angle = turned_heading(d, nav.circle_angle)


@law
def move_modes(m: Modes, d: Displacement) -> None:
    """Set-points and positions of the modes."""
    yaw, takeoff = m.auto_yaw, m.takeoff
    yaw.yaw, yaw.look_ahead = turned_heading(d, yaw.yaw), turned_heading(d, yaw.look_ahead)
    yaw.roi = moved(on_the_ground(d), yaw.roi)
    takeoff.target_d += d.shift.z
    takeoff.no_nav_d += d.shift.z
    takeoff.user_start_d += d.shift.z
    move_guided(m.guided, d)
    move_loiter(m.loiter, d)
    m.poshold.wind = turned_ne(d, m.poshold.wind)
    m.flowhold.against_wind = turned_ne(d, m.flowhold.against_wind)
    move_autotune(m.autotune, d)
    m.flip.level = turned_attitude(d, m.flip.level)
    simple = m.simple
    simple.heading = turned_heading(d, simple.heading)
    simple.heading_from_home = turned_heading(d, simple.heading_from_home)
    m.rtl.home = moved_ne(d, m.rtl.home)
    move_path(m.path, d)
    m.throw.target_d += d.shift.z
    m.zigzag.a, m.zigzag.b = moved_ne(d, m.zigzag.a), moved_ne(d, m.zigzag.b)
    m.landing.acc = turned(d, m.landing.acc)
    move_circle(m.nav, d)


@law
def move(ap: Autopilot, d: Displacement) -> None:
    """Put all of the firmware elsewhere; the origin of the estimate has been moved."""
    move_autopilot(ap, d)
    move_attitude(ap.control.attitude, d)
    move_position(ap.control.pos_ne, d)
    move_altitude(ap.control.pos_d, d)
    ap.control.vibration.pos += d.shift.z
    ap.control.vibration.vel += d.velocity.z
    move_modes(ap.modes, d)
