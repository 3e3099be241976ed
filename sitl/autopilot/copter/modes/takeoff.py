# SPDX-License-Identifier: BSD-3-Clause
"""Take-off: by command in GUIDED and AUTO, by the throttle stick or by command in ALT_HOLD and LOITER.

The throttle rises from zero to full within TKOFF_SLEW_TIME until the vehicle moves, then the vertical
controller takes over.
"""

from __future__ import annotations

from ....core.kernels import law
from ....core.scalars import constrain
from ...control.shaping import Motion
from ...events import Event, emit
from ...fence.checks import switch_after_takeoff
from ...state import Estimate
from ..control import altitude, altitude_start, attitude, position, position_start, throttle_mix
from ..control.spool import DesiredSpoolState, SpoolState
from ..control.state import DT, AltitudeState, Control
from ..parameters import Parameters
from ..state import Vehicle
from . import ground
from .state import AutoYaw, TakeoffState

_LIFT_SPEED = 0.1
"""Part of the climb speed limit that shows that the vehicle has left the ground."""
_DONE_SPEED = 0.1
"""Part of the climb speed limit below which, next to its end, the take-off is done."""

TAKEOFF_COMPLETE = Event(5)


@law
def begin(takeoff: TakeoffState, target_d: float, landed: bool, control: Control, est: Estimate, p: Parameters) -> None:
    """Start the take-off of GUIDED and AUTO to ``target_d`` (NED [m])."""
    takeoff.target_d = target_d
    takeoff.complete = False
    takeoff.no_nav_d = est.pos.z - p.WP.NAVALT_MIN
    takeoff.no_nav_active = p.WP.NAVALT_MIN > 0.0 and landed
    ground.set_waypoint_limits(control, p)
    altitude_start.init_d(control, est, p)
    position_start.init_ne(control, est, p)


@law
def run(v: Vehicle) -> None:
    """One tick of the take-off of GUIDED and AUTO."""
    ap = v.autopilot
    takeoff, control, est, p = ap.modes.takeoff, ap.control, ap.estimate, ap.params
    if not ap.arming.armed or not ap.arming.auto_armed:
        ground.rest(ap.arming.armed, control, est, p)
        takeoff.no_nav_d = est.pos.z - p.WP.NAVALT_MIN
        return
    control.motors.desired_spool = DesiredSpoolState.THROTTLE_UNLIMITED
    if control.motors.spool_state != SpoolState.THROTTLE_UNLIMITED:
        spool_up(control, est, p)
    elif ap.arming.landed:
        if lift_off(control, est, p):
            ground.set_landed(ap.arming, False)
    else:
        climb(takeoff, ap.modes.auto_yaw, control, est, p)
        if not takeoff.complete and is_done(control.pos_d, takeoff.target_d):
            takeoff.complete = True
            emit(ap.events, v.time_us, TAKEOFF_COMPLETE, -est.pos.z, 0.0)
            switch_after_takeoff(ap.fence, p.FENCE, int(p.FENCE.AUTOENABLE), ap.events, v.time_us)


@law
def spool_up(control: Control, est: Estimate, p: Parameters) -> None:
    """One tick while the motors spool up."""
    position_start.relax_ne(control, est, p)
    position.update_ne(control, est, p)
    altitude_start.relax_d(control, est, p, 0.0)
    altitude.update_d(control, est, p)
    attitude.reset_yaw_target(control.attitude, est.yaw)
    keep_heading(control, est, p)


@law
def lift_off(control: Control, est: Estimate, p: Parameters) -> bool:
    """One tick of raising the throttle on the ground; whether the vehicle has left it."""
    position_start.relax_ne(control, est, p)
    position.update_ne(control, est, p)
    throttle = raise_throttle(control, est, p)
    keep_heading(control, est, p)
    lifted = est.vel.z <= -_LIFT_SPEED * control.pos_d.speed_up
    return lifted or has_thrust(throttle, est.acc_ned.z, control.pos_d.accel_max, p.TKOFF.THR_MAX)


@law
def climb(takeoff: TakeoffState, yaw: AutoYaw, control: Control, est: Estimate, p: Parameters) -> None:
    """One tick in the air; below WP_NAVALT_MIN the vehicle is left to drift."""
    if takeoff.no_nav_active:
        if est.pos.z <= takeoff.no_nav_d:
            takeoff.no_nav_active = False
        position_start.relax_ne(control, est, p)
    else:
        position.brake_ne(control.pos_ne)
    altitude.input_pos_vel_accel_d(control.pos_d, Motion(takeoff.target_d, 0.0, 0.0))
    ground.fly(yaw, control, est, p)


@law
def keep_heading(control: Control, est: Estimate, p: Parameters) -> None:
    """Thrust as the position controller says, nose as it is."""
    attitude.input_thrust_vector_heading_rate(control, est, p, position.thrust_vector(control.pos_ne), 0.0)


@law
def raise_throttle(control: Control, est: Estimate, p: Parameters) -> float:
    """Raise the throttle by one tick of TKOFF_SLEW_TIME, the vertical controller following; the throttle 0 .. 1."""
    slew_time = max(p.TKOFF.SLEW_TIME, 0.1)
    throttle = constrain(control.attitude.throttle_in + DT / slew_time, 0.0, 1.0)
    throttle_mix.set_throttle_out(control, p, throttle, True, 0.0)
    altitude_start.init_d(control, est, p)
    return throttle


@law
def has_thrust(throttle: float, accel_d: float, accel_max: float, throttle_max: float) -> bool:
    """Nearly full throttle (0 .. 1), or accelerating (down [m/s^2]) upward with half of the acceleration limit."""
    return throttle >= min(throttle_max, 0.9) or -accel_d >= 0.5 * accel_max


@law
def is_done(path: AltitudeState, target_d: float) -> bool:
    """The path is as near to its end (NED [m]) as a tenth of the climb speed needs to stop, and as slow."""
    slow = _DONE_SPEED * path.speed_up
    stop = 0.5 * slow * slow / max(path.accel_max, 0.1)
    return path.pos_desired <= target_d + stop and -path.vel_desired < slow


@law
def begin_user(takeoff: TakeoffState, height: float, control: Control, est: Estimate, p: Parameters) -> None:
    """Start a take-off of ALT_HOLD or LOITER, ``height`` [m] up."""
    takeoff.user_active = True
    takeoff.user_start_d = est.pos.z
    takeoff.user_alt = height
    altitude_start.init_d(control, est, p)


@law
def lift_off_user(takeoff: TakeoffState, climb: float, control: Control, est: Estimate, p: Parameters) -> bool:
    """One tick on the ground in ALT_HOLD and LOITER, ``climb`` of the stick [m/s]; whether the vehicle has left it."""
    throttle = raise_throttle(control, est, p)
    risen = takeoff.user_start_d - est.pos.z
    top = control.pos_d.speed_up
    if has_thrust(throttle, est.acc_ned.z, control.pos_d.accel_max, p.TKOFF.THR_MAX):
        return True
    if -est.vel.z >= constrain(climb, 0.1 * top, 0.5 * top):
        return True
    return takeoff.user_alt > 0.0 and risen > 0.5 * takeoff.user_alt


@law
def climb_user(takeoff: TakeoffState, climb: float, control: Control, est: Estimate, p: Parameters) -> None:
    """One tick of the climb in ALT_HOLD and LOITER, ``climb`` from the stick [m/s]."""
    rise = takeoff.user_alt
    altitude.input_pos_vel_accel_d(control.pos_d, Motion(takeoff.user_start_d - rise, -climb, 0.0))
    altitude.update_d(control, est, p)
    if climb < 0.0 or rise * 0.999 <= takeoff.user_start_d - control.pos_d.pos_desired:
        takeoff.user_active = False
