# SPDX-License-Identifier: BSD-3-Clause
"""A descent to the ground: fast down to LAND_ALT_LOW and then at LAND_SPEED."""

from __future__ import annotations

import math

from ....core.algebra import ZERO2, turned
from ....core.kernels import law
from ....core.scalars import constrain
from ....core.vectors import Vec2
from ...control.shaping import sqrt_controller
from ...state import Estimate
from .. import pilot
from ..control import altitude, attitude, position, position_start
from ..control.state import DT, AltitudeState, Control
from ..parameters import Parameters
from ..parameters.flight_modes import Land
from . import auto_yaw, ground
from .state import LandState, Modes, PilotState

_REPOSITION_ACCEL = 0.5
"""The pilot's full stick is WPNAV_ACCEL times this many seconds of speed."""


@law
def begin(modes: Modes, time_us: int, control: Control, est: Estimate, p: Parameters) -> None:
    """Prepare a descent from the present motion."""
    ground.set_waypoint_limits(control, p)
    ground.continue_position_control(control, est, p)
    modes.land.start_us = time_us
    modes.land.pause = False
    modes.land.with_position = True
    modes.land.repositioned = False
    modes.land.stage, modes.land.tries = 0, 0
    auto_yaw.set_mode(modes.auto_yaw, auto_yaw.HOLD, control.attitude, est)


@law
def descend(modes: Modes, height: float, landed_maybe: bool, control: Control, est: Estimate, p: Parameters) -> None:
    """One tick of a landing with position control from ``height`` above home [m].

    The sticks move the landing position (LAND_REPOSITION).
    """
    vel = stick_velocity(modes.pilot, est.yaw, p)
    if landed_maybe:
        position_start.soften_for_landing_ne(control.pos_ne, est.pos)
    position.input_vel_accel_ne(control.pos_ne, vel, ZERO2)
    sink(control.pos_d, modes.land, height, landed_maybe, p)
    ground.fly(modes.auto_yaw, control, est, p)


@law
def descend_blind(
    modes: Modes, height: float, landed_maybe: bool, control: Control, est: Estimate, p: Parameters
) -> None:
    """One tick of a landing without a position, from ``height`` above home [m]: the sticks lean the vehicle."""
    lean = attitude.Lean(0.0, 0.0)
    if p.LAND.REPOSITION != 0.0:
        lean_max = math.radians(p.ANGLE_MAX * 0.01)
        lean = pilot.lean_angles(modes.pilot, lean_max, lean_max)
    sink(control.pos_d, modes.land, height, landed_maybe, p)
    altitude.update_d(control, est, p)
    attitude.input_euler_roll_pitch_yaw_rate(control, est, p, lean, modes.pilot.yaw_rate)


@law
def sink_rate(height: float, limits: AltitudeState, p: Land, pos_p: float) -> float:
    """Descent [m/s] at a height above home [m]: fast above LAND_ALT_LOW, then LAND_SPEED.

    ``pos_p``: gain of the position loop [1/s].
    """
    slow = abs(p.SPEED) * 0.01
    fast = p.SPEED_HIGH * 0.01
    if fast <= 0.0:
        fast = limits.speed_down
    fast = max(fast, slow)
    return constrain(sqrt_controller(height - height_low(p), pos_p, limits.accel_max, DT), slow, fast)


@law
def height_low(p: Land) -> float:
    """LAND_ALT_LOW, at least a metre [m]."""
    return max(p.ALT_LOW * 0.01, 1.0)


@law
def sink(path: AltitudeState, land: LandState, height: float, landed_maybe: bool, p: Parameters) -> None:
    """Descent of this tick, from ``height`` above home [m]."""
    if land.pause:
        altitude.land_at_rate_d(path, 0.0, False)
        return
    near_ground = height < height_low(p.LAND) or landed_maybe
    altitude.land_at_rate_d(path, sink_rate(height, path, p.LAND, p.PSC.POSZ_P), near_ground)


@law
def stick_velocity(sticks: PilotState, yaw: float, p: Parameters) -> Vec2:
    """North and east [m/s] that the sticks ask for at heading ``yaw`` [rad]; zero without LAND_REPOSITION."""
    if p.LAND.REPOSITION == 0.0 or (sticks.roll == 0.0 and sticks.pitch == 0.0):
        return Vec2(0.0, 0.0)
    speed_max = p.WPNAV.ACCEL * 0.01 * _REPOSITION_ACCEL
    forward_right = pilot.limit_stick(Vec2(-sticks.pitch * speed_max, sticks.roll * speed_max), speed_max)
    return turned(forward_right, yaw)
