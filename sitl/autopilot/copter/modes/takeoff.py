# SPDX-License-Identifier: BSD-3-Clause
"""Take-off: by command in GUIDED and AUTO, by the throttle stick or by command in ALT_HOLD and LOITER.

The throttle rises from zero to full within TKOFF_SLEW_TIME until the vehicle moves, then the vertical
controller takes over.
"""

from __future__ import annotations

from ....core.kernels import law
from ....core.scalars import constrain
from ...control.shaping import Motion
from ...events import TAKEOFF_COMPLETE, emit
from ..control import altitude, altitude_start, attitude, position, position_start, throttle_mix
from ..control.state import DT, AltitudeState
from ..state import Autopilot, Vehicle
from . import ground

_LIFT_SPEED = 0.1
"""Part of the climb speed limit that shows that the vehicle has left the ground."""
_DONE_SPEED = 0.1
"""Part of the climb speed limit below which, next to its end, the take-off is done."""


@law
def begin(ap: Autopilot, target_d: float) -> None:
    """Start the take-off of GUIDED and AUTO to ``target_d`` (NED [m])."""
    takeoff = ap.modes.takeoff
    takeoff.target_d = target_d
    takeoff.complete = False
    takeoff.no_nav_d = ap.estimate.pos.z - ap.params.WP.NAVALT_MIN
    takeoff.no_nav_active = ap.params.WP.NAVALT_MIN > 0.0 and ap.arming.landed
    ground.set_waypoint_limits(ap)
    altitude_start.init_d(ap.control, ap.estimate, ap.params)
    position_start.init_ne(ap.control, ap.estimate, ap.params)


@law
def run(v: Vehicle) -> None:
    """One tick of the take-off of GUIDED and AUTO."""
    ap = v.autopilot
    takeoff = ap.modes.takeoff
    if not ap.arming.armed or not ap.arming.auto_armed:
        ground.rest(ap)
        takeoff.no_nav_d = ap.estimate.pos.z - ap.params.WP.NAVALT_MIN
        return
    ap.control.motors.desired_spool = ground.UNLIMITED
    if ap.control.motors.spool_state != ground.IS_UNLIMITED:
        spool_up(ap)
    elif ap.arming.landed:
        lift_off(ap)
    else:
        climb(ap)
        if not takeoff.complete and is_done(ap.control.pos_d, takeoff.target_d):
            takeoff.complete = True
            emit(ap.events, v.time_us, TAKEOFF_COMPLETE, -ap.estimate.pos.z, 0.0)


@law
def spool_up(ap: Autopilot) -> None:
    """One tick while the motors spool up."""
    position_start.relax_ne(ap.control, ap.estimate, ap.params)
    position.update_ne(ap.control, ap.estimate, ap.params)
    altitude_start.relax_d(ap.control, ap.estimate, ap.params, 0.0)
    altitude.update_d(ap.control, ap.estimate, ap.params)
    attitude.reset_yaw_target(ap.control.attitude, ap.estimate.euler.yaw)
    keep_heading(ap)


@law
def lift_off(ap: Autopilot) -> None:
    """One tick of raising the throttle on the ground."""
    position_start.relax_ne(ap.control, ap.estimate, ap.params)
    position.update_ne(ap.control, ap.estimate, ap.params)
    throttle = raise_throttle(ap)
    keep_heading(ap)
    lifted = ap.estimate.vel.z <= -_LIFT_SPEED * ap.control.pos_d.speed_up
    if lifted or has_thrust(ap, throttle):
        ground.set_landed(ap.arming, False)


@law
def climb(ap: Autopilot) -> None:
    """One tick in the air; below WP_NAVALT_MIN the vehicle is left to drift."""
    takeoff = ap.modes.takeoff
    if takeoff.no_nav_active:
        if ap.estimate.pos.z <= takeoff.no_nav_d:
            takeoff.no_nav_active = False
        position_start.relax_ne(ap.control, ap.estimate, ap.params)
    else:
        position.brake_ne(ap.control.pos_ne)
    altitude.input_pos_vel_accel_d(ap.control.pos_d, Motion(takeoff.target_d, 0.0, 0.0))
    ground.fly(ap)


@law
def keep_heading(ap: Autopilot) -> None:
    """Thrust as the position controller says, nose as it is."""
    attitude.input_thrust_vector_heading_rate(
        ap.control, ap.estimate, ap.params, position.thrust_vector(ap.control.pos_ne), 0.0
    )


@law
def raise_throttle(ap: Autopilot) -> float:
    """Raise the throttle by one tick of TKOFF_SLEW_TIME, the vertical controller following; the throttle 0 .. 1."""
    slew_time = max(ap.params.TKOFF.SLEW_TIME, 0.1)
    throttle = constrain(ap.control.attitude.throttle_in + DT / slew_time, 0.0, 1.0)
    throttle_mix.set_throttle_out(ap.control, ap.params, throttle, True, 0.0)
    altitude_start.init_d(ap.control, ap.estimate, ap.params)
    return throttle


@law
def has_thrust(ap: Autopilot, throttle: float) -> bool:
    """Nearly full throttle, or accelerating upward with half of the acceleration limit."""
    full = min(ap.params.TKOFF.THR_MAX, 0.9)
    return throttle >= full or -ap.estimate.acc_ned.z >= 0.5 * ap.control.pos_d.accel_max


@law
def is_done(path: AltitudeState, target_d: float) -> bool:
    """The path is as near to its end (NED [m]) as a tenth of the climb speed needs to stop, and as slow."""
    slow = _DONE_SPEED * path.speed_up
    stop = 0.5 * slow * slow / max(path.accel_max, 0.1)
    return path.pos_desired <= target_d + stop and -path.vel_desired < slow


@law
def begin_user(ap: Autopilot, height: float) -> None:
    """Start a take-off of ALT_HOLD or LOITER, ``height`` [m] up."""
    takeoff = ap.modes.takeoff
    takeoff.user_active = True
    takeoff.user_start_d = ap.estimate.pos.z
    takeoff.user_alt = height
    altitude_start.init_d(ap.control, ap.estimate, ap.params)


@law
def is_triggered(ap: Autopilot, climb: float) -> bool:
    """Whether the raised throttle stick (``climb`` [m/s]) starts a take-off: on the ground, motors ready."""
    return ap.arming.landed and climb > 0.0 and ap.control.motors.spool_state == ground.IS_UNLIMITED


@law
def run_user(ap: Autopilot, climb: float) -> None:
    """One tick of the vertical part of a take-off in ALT_HOLD and LOITER; ``climb`` from the stick [m/s]."""
    takeoff = ap.modes.takeoff
    rise = takeoff.user_alt
    top = ap.control.pos_d.speed_up
    if ap.arming.landed:
        throttle = raise_throttle(ap)
        risen = takeoff.user_start_d - ap.estimate.pos.z
        fast = -ap.estimate.vel.z >= constrain(climb, 0.1 * top, 0.5 * top)
        if has_thrust(ap, throttle) or fast or (rise > 0.0 and risen > 0.5 * rise):
            ground.set_landed(ap.arming, False)
            altitude_start.init_d(ap.control, ap.estimate, ap.params)
        return
    altitude.input_pos_vel_accel_d(ap.control.pos_d, Motion(takeoff.user_start_d - rise, -climb, 0.0))
    altitude.update_d(ap.control, ap.estimate, ap.params)
    if climb < 0.0 or rise * 0.999 <= takeoff.user_start_d - ap.control.pos_d.pos_desired:
        takeoff.user_active = False
