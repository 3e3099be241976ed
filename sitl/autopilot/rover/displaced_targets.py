# SPDX-License-Identifier: BSD-3-Clause
"""The rover's controllers and modes are put elsewhere with it: their targets keep their position beside the vehicle."""

from __future__ import annotations

from ...core.displacement import (
    Displacement,
    faster_ne,
    moved_ne,
    speed_along,
    turned_heading,
    turned_ne,
)
from ...core.kernels import law
from ..displacement import add_to_target, move_autopilot, move_path
from .control.state import PositionState, SpeedState
from .modes.state import CircleState, GuidedState, LoiterState, Modes
from .navigation.state import RoverNav
from .state import Autopilot


@law
def move_position(c: PositionState, d: Displacement) -> None:
    """Path and errors."""
    c.pos_target, c.pos_error = moved_ne(d, c.pos_target), turned_ne(d, c.pos_error)
    c.vel_desired, c.vel_target = faster_ne(d, c.vel_desired), faster_ne(d, c.vel_target)
    c.accel_desired, c.accel_target = turned_ne(d, c.accel_desired), turned_ne(d, c.accel_target)
    c.vel_error, c.vel_derivative = turned_ne(d, c.vel_error), turned_ne(d, c.vel_derivative)
    c.vel_integrator = turned_ne(d, c.vel_integrator)


@law
def add_speed(c: SpeedState, speed: float) -> None:
    """Speed along the nose [m/s] that the vehicle has got in addition."""
    c.forward += speed
    c.desired += speed
    add_to_target(c.loop, speed)
    if c.wheel_ok:
        c.wheel += speed


@law
def move_guided(g: GuidedState, d: Displacement) -> None:
    """GUIDED's set-point."""
    g.pos, g.heading = moved_ne(d, g.pos), turned_heading(d, g.heading)
    g.limit_from = moved_ne(d, g.limit_from)


@law
def move_loiter(state: LoiterState, d: Displacement) -> None:
    """LOITER's position."""
    state.hold_pos, state.heading = moved_ne(d, state.hold_pos), turned_heading(d, state.heading)


@law
def move_circle(c: CircleState, d: Displacement) -> None:
    """CIRCLE's."""
    c.centre, c.target, c.angle = moved_ne(d, c.centre), moved_ne(d, c.target), turned_heading(d, c.angle)


@law
def move_nav(nav: RoverNav, d: Displacement) -> None:
    """What the rover's navigation has besides the shared one."""
    nav.drive.origin = moved_ne(d, nav.drive.origin)
    nav.heading = turned_heading(d, nav.heading)


@law
def move_modes(m: Modes, d: Displacement) -> None:
    """Set-points and positions of the modes."""
    move_guided(m.guided, d)
    move_loiter(m.loiter, d)
    move_circle(m.circle, d)
    m.dock.pos = moved_ne(d, m.dock.pos)
    move_path(m.path, d)
    move_nav(m.nav, d)
    m.simple.first_heading = turned_heading(d, m.simple.first_heading)
    m.simple.heading = turned_heading(d, m.simple.heading)
    m.auto.heading = turned_heading(d, m.auto.heading)


@law
def move(ap: Autopilot, d: Displacement) -> None:
    """Put all of the firmware elsewhere; the origin of the estimate has been moved."""
    move_autopilot(ap, d)
    move_position(ap.control.position, d)
    add_speed(ap.control.speed, speed_along(d, ap.estimate.euler.yaw))
    move_modes(ap.modes, d)
