# SPDX-License-Identifier: BSD-3-Clause
"""BRAKE: stops as fast as possible and holds its position; the sticks have no effect."""

from __future__ import annotations

from ....core.elementary import hypot
from ....core.kernels import law
from ...modes import ModeResult
from ..control import altitude_start, position_start
from ..state import Vehicle
from . import ground
from .mode import CopterMode, never_arms

BRAKE = 17

DECELERATION = 7.5
"""[m/s^2] (ArduPilot's)."""
SPEED_D = 2.5
"""Least climb and descent limit [m/s] (ArduPilot's)."""


@law
def start(v: Vehicle) -> int:
    """Enter."""
    ap = v.autopilot
    control, est, p = ap.control, ap.estimate, ap.params
    vel = est.vel
    position_start.set_max_speed_accel_ne(control.pos_ne, p, max(hypot(vel.x, vel.y), 0.1), DECELERATION)
    position_start.init_ne(control, est, p)
    down, up = max(SPEED_D, vel.z), max(SPEED_D, -vel.z)
    altitude_start.set_max_speed_accel_d(control.pos_d, p.PSC, down, up, DECELERATION)
    altitude_start.init_d(control, est, p)
    return ModeResult.ACCEPTED


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    ground.stop_and_hold(ap.arming, ap.control, ap.estimate, ap.params)


MODE = CopterMode(
    number=BRAKE, name="BRAKE", start=start, run=run, needs_position=True, autonomous=True, may_arm=never_arms
)
