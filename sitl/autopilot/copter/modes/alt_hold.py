# SPDX-License-Identifier: BSD-3-Clause
"""ALT_HOLD: leans and turns as STABILIZE; the throttle stick is a climb rate, in LOITER as well."""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.scalars import constrain
from ...modes import ACCEPTED
from .. import pilot
from ..control import altitude, altitude_start, attitude
from ..control.throttle_mix import lean_limit
from ..state import Autopilot, Vehicle
from . import ground, takeoff
from .mode import CopterMode

ALT_HOLD = 2

# What the vertical part is doing
STOPPED = 0
LANDED_IDLE = 1
LANDED_READY = 2
TAKING_OFF = 3
FLYING = 4


@law
def start(v: Vehicle) -> int:
    """Enter from the present vertical motion."""
    start_vertical(v.autopilot)
    return ACCEPTED


@law
def start_vertical(ap: Autopilot) -> None:
    """Limits of the throttle stick: PILOT_SPEED_UP, PILOT_SPEED_DN, PILOT_ACCEL_Z."""
    set_limits(ap)
    if not altitude_start.is_active_d(ap.control):
        altitude_start.init_d(ap.control, ap.estimate, ap.params)
    ap.modes.takeoff.user_active = False


@law
def set_limits(ap: Autopilot) -> None:
    """Vertical limits of modes that the pilot flies."""
    p = ap.params.PILOT
    altitude_start.set_max_speed_accel_d(
        ap.control.pos_d, ap.params.PSC, pilot.speed_down(p), p.SPEED_UP * 0.01, p.ACCEL_Z * 0.01
    )


@law
def decide(ap: Autopilot, climb: float) -> int:
    """What to do with the throttle stick asking for ``climb`` [m/s]; sets the spool state that this needs."""
    motors = ap.control.motors
    if not ap.arming.armed:
        motors.desired_spool = ground.SHUT_DOWN
        return STOPPED
    if ap.modes.takeoff.user_active or takeoff.is_triggered(ap, climb):
        motors.desired_spool = ground.UNLIMITED
        return TAKING_OFF
    if not ap.arming.auto_armed or ap.arming.landed:
        motors.desired_spool = ground.GROUND_IDLE if climb < 0.0 else ground.UNLIMITED
        if motors.spool_state == ground.IS_GROUND_IDLE or motors.spool_state == ground.IS_SHUT_DOWN:
            return LANDED_IDLE
        return LANDED_READY
    motors.desired_spool = ground.UNLIMITED
    return FLYING


@law
def climb_rate(ap: Autopilot) -> float:
    """Climb rate of the stick within the limits [m/s]."""
    return constrain(pilot.climb_rate(ap), -ap.control.pos_d.speed_down, ap.control.pos_d.speed_up)


@law
def run_vertical(ap: Autopilot, doing: int, climb: float) -> None:
    """Vertical part of one tick; ``climb`` from the stick [m/s]."""
    if doing == TAKING_OFF:
        if not ap.modes.takeoff.user_active:
            takeoff.begin_user(ap, constrain(ap.params.PILOT.TKOFF_ALT * 0.01, 0.0, 10.0))
        if ap.control.motors.spool_state == ground.IS_UNLIMITED:
            takeoff.run_user(ap, climb)
            return
        altitude_start.relax_d(ap.control, ap.estimate, ap.params, 0.0)
    elif doing == FLYING:
        altitude.input_vel_accel_d(ap.control.pos_d, -climb, 0.0)
    else:
        altitude_start.relax_d(ap.control, ap.estimate, ap.params, 0.0)
    altitude.update_d(ap.control, ap.estimate, ap.params)


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    set_limits(ap)
    climb = climb_rate(ap)
    doing = decide(ap, climb)
    if doing in (STOPPED, LANDED_IDLE):
        attitude.reset_yaw_target(ap.control.attitude, ap.estimate.euler.yaw)
    lean_max = math.radians(ap.params.ANGLE_MAX * 0.01)
    lean = pilot.lean_angles(ap.modes.pilot, lean_max, min(lean_max, lean_limit(ap.control.attitude)))
    attitude.input_euler_roll_pitch_yaw_rate(ap.control, ap.estimate, ap.params, lean, ap.modes.pilot.yaw_rate)
    run_vertical(ap, doing, climb)


MODE = CopterMode(number=ALT_HOLD, name="ALT_HOLD", start=start, run=run, standard_mode=4, climb_stick=True)
