# SPDX-License-Identifier: BSD-3-Clause
"""ALT_HOLD: leans and turns as STABILIZE; the throttle stick is a climb rate, in LOITER as well."""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.scalars import constrain
from ...modes import ModeResult
from ...state import Arming, Estimate, Radio
from .. import avoidance, pilot
from ..control import altitude, altitude_start, attitude
from ..control.spool import DesiredSpoolState, SpoolState
from ..control.state import AltitudeState, Control, MotorsState
from ..control.throttle_mix import lean_limit
from ..parameters import Parameters
from ..state import Vehicle
from . import ground, takeoff
from .mode import CopterMode
from .state import Modes, TakeoffState

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
    ap = v.autopilot
    start_vertical(ap.modes.takeoff, ap.control, ap.estimate, ap.params)
    return ModeResult.ACCEPTED


@law
def start_vertical(takeoff: TakeoffState, control: Control, est: Estimate, p: Parameters) -> None:
    """Go on with the present vertical motion, within the limits of the throttle stick."""
    set_limits(control.pos_d, p)
    if not altitude_start.is_active_d(control):
        altitude_start.init_d(control, est, p)
    takeoff.user_active = False


@law
def set_limits(path: AltitudeState, p: Parameters) -> None:
    """Limits of the throttle stick: PILOT_SPEED_UP, PILOT_SPEED_DN, PILOT_ACCEL_Z."""
    down, up = pilot.speed_down(p.PILOT), p.PILOT.SPEED_UP * 0.01
    altitude_start.set_max_speed_accel_d(path, p.PSC, down, up, p.PILOT.ACCEL_Z * 0.01)


@law
def decide(arming: Arming, takeoff: TakeoffState, motors: MotorsState, climb: float) -> int:
    """What to do with the throttle stick asking for ``climb`` [m/s]; sets the spool state that this needs."""
    if not arming.armed:
        motors.desired_spool = DesiredSpoolState.SHUT_DOWN
        return STOPPED
    triggered = arming.landed and climb > 0.0 and motors.spool_state == SpoolState.THROTTLE_UNLIMITED
    if takeoff.user_active or triggered:
        motors.desired_spool = DesiredSpoolState.THROTTLE_UNLIMITED
        return TAKING_OFF
    if not arming.auto_armed or arming.landed:
        motors.desired_spool = DesiredSpoolState.GROUND_IDLE if climb < 0.0 else DesiredSpoolState.THROTTLE_UNLIMITED
        if motors.spool_state == SpoolState.GROUND_IDLE or motors.spool_state == SpoolState.SHUT_DOWN:
            return LANDED_IDLE
        return LANDED_READY
    motors.desired_spool = DesiredSpoolState.THROTTLE_UNLIMITED
    return FLYING


@law
def climb_rate(modes: Modes, rc: Radio, limits: AltitudeState, p: Parameters) -> float:
    """Climb rate of the stick within the limits [m/s]."""
    return constrain(pilot.climb_rate(modes, rc, p), -limits.speed_down, limits.speed_up)


@law
def kept_below(v: Vehicle, doing: int, climb: float) -> float:
    """The climb rate [m/s] of a vehicle that flies, below the ceiling of the fence."""
    return avoidance.limit_climb(v, climb) if doing == FLYING else climb


@law
def run_vertical(
    doing: int, climb: float, arming: Arming, state: TakeoffState, control: Control, est: Estimate, p: Parameters
) -> None:
    """Vertical part of one tick, also in a take-off; ``climb`` from the stick [m/s]."""
    if doing == TAKING_OFF:
        if not state.user_active:
            takeoff.begin_user(state, constrain(p.PILOT.TKOFF_ALT * 0.01, 0.0, 10.0), control, est, p)
        if control.motors.spool_state != SpoolState.THROTTLE_UNLIMITED:
            altitude_start.relax_d(control, est, p, 0.0)
            altitude.update_d(control, est, p)
        elif not arming.landed:
            takeoff.climb_user(state, climb, control, est, p)
        elif takeoff.lift_off_user(state, climb, control, est, p):
            ground.set_landed(arming, False)
            altitude_start.init_d(control, est, p)
        return
    if doing == FLYING:
        altitude.input_vel_accel_d(control.pos_d, -climb, 0.0)
    else:
        altitude_start.relax_d(control, est, p, 0.0)
    altitude.update_d(control, est, p)


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    modes, control, est, p = ap.modes, ap.control, ap.estimate, ap.params
    set_limits(control.pos_d, p)
    climb = climb_rate(modes, ap.rc, control.pos_d, p)
    doing = decide(ap.arming, modes.takeoff, control.motors, climb)
    if doing in (STOPPED, LANDED_IDLE):
        attitude.reset_yaw_target(control.attitude, est.yaw)
    lean_max = math.radians(p.ANGLE_MAX * 0.01)
    lean = pilot.lean_angles(modes.pilot, lean_max, min(lean_max, lean_limit(control.attitude)))
    if doing == FLYING:
        lean = avoidance.limit_lean(v, lean, lean_max)
    attitude.input_euler_roll_pitch_yaw_rate(control, est, p, lean, modes.pilot.yaw_rate)
    climb = kept_below(v, doing, climb)
    run_vertical(doing, climb, ap.arming, modes.takeoff, control, est, p)


MODE = CopterMode(number=ALT_HOLD, name="ALT_HOLD", start=start, run=run, standard_mode=4, climb_stick=True)
