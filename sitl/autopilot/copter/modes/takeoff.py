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
from . import ground

_LIFT_SPEED = 0.1
"""Part of the climb speed limit that shows that the vehicle has left the ground."""
_DONE_SPEED = 0.1
"""Part of the climb speed limit below which, next to its end, the take-off is done."""


@law
def begin(v, target_d):
    """Start the take-off of GUIDED and AUTO to ``target_d`` (NED [m])."""
    ap = v.autopilot
    takeoff = ap.modes.takeoff
    takeoff.target_d = target_d
    takeoff.complete = 0
    takeoff.no_nav_d = float(ap.estimate.pos[2]) - ap.params.WP.NAVALT_MIN
    takeoff.no_nav_active = 1 if ap.params.WP.NAVALT_MIN > 0.0 and ap.arming.landed != 0 else 0
    ground.set_waypoint_limits(v)
    altitude_start.init_d(ap)
    position_start.init_ne(ap)


@law
def run(v):
    """One tick of the take-off of GUIDED and AUTO."""
    ap = v.autopilot
    takeoff = ap.modes.takeoff
    motors = ap.control.motors
    if ap.arming.armed == 0 or ap.arming.auto_armed == 0:
        ground.handle(v)
        takeoff.no_nav_d = float(ap.estimate.pos[2]) - ap.params.WP.NAVALT_MIN
        return
    motors.desired_spool = ground.UNLIMITED
    if motors.spool_state != ground.IS_UNLIMITED:
        position_start.relax_ne(ap)
        position.update_ne(ap)
        altitude_start.relax_d(ap, 0.0)
        altitude.update_d(ap)
        attitude.reset_yaw_target(ap)
        level(v)
        return
    if ap.arming.landed != 0:
        position_start.relax_ne(ap)
        position.update_ne(ap)
        throttle = ramp(ap)
        level(v)
        lifted = ap.estimate.vel[2] <= -_LIFT_SPEED * ap.control.pos_d.speed_up
        if lifted or has_thrust(ap, throttle):
            ground.set_landed(v, 0)
        return
    if takeoff.no_nav_active != 0:
        if ap.estimate.pos[2] <= takeoff.no_nav_d:
            takeoff.no_nav_active = 0
        position_start.relax_ne(ap)
    else:
        position.brake_ne(ap.control.pos_ne)
    altitude.input_pos_vel_accel_d(ap.control.pos_d, Motion(takeoff.target_d, 0.0, 0.0))
    ground.fly(v)
    if takeoff.complete == 0 and is_done(ap):
        takeoff.complete = 1
        emit(ap.events, v.time_us, TAKEOFF_COMPLETE, -float(ap.estimate.pos[2]), 0.0)


@law
def level(v):
    """Thrust as the position controller says, nose as it is."""
    ap = v.autopilot
    attitude.input_thrust_vector_heading_rate(ap, position.thrust_vector(ap.control.pos_ne), 0.0)


@law
def ramp(ap):
    """Raise the throttle by one tick of TKOFF_SLEW_TIME, the vertical controller following. Returns it."""
    slew = max(float(ap.params.TKOFF.SLEW_TIME), 0.1)
    throttle = constrain(ap.control.attitude.throttle_in + 0.0025 / slew, 0.0, 1.0)
    throttle_mix.set_throttle_out(ap, throttle, True, 0.0)
    altitude_start.init_d(ap)
    return throttle


@law
def has_thrust(ap, throttle):
    """Nearly full throttle, or accelerating upward with half of the acceleration limit."""
    most = min(float(ap.params.TKOFF.THR_MAX), 0.9)
    return throttle >= most or -ap.estimate.acc_ned[2] >= 0.5 * ap.control.pos_d.accel_max


@law
def is_done(ap):
    """The path is as near to its end as a tenth of the climb speed needs to stop, and as slow."""
    control = ap.control.pos_d
    slow = _DONE_SPEED * control.speed_up
    stop = 0.5 * slow * slow / max(float(control.accel_max), 0.1)
    return control.pos_desired <= ap.modes.takeoff.target_d + stop and -control.vel_desired < slow


@law
def begin_user(v, altitude_m):
    """Start a take-off of ALT_HOLD or LOITER, ``altitude_m`` [m] up."""
    ap = v.autopilot
    takeoff = ap.modes.takeoff
    takeoff.user_active = 1
    takeoff.user_start_d = float(ap.estimate.pos[2])
    takeoff.user_alt = altitude_m
    altitude_start.init_d(ap)


@law
def is_triggered(v, climb):
    """Whether the raised throttle stick starts a take-off: on the ground, motors ready."""
    ap = v.autopilot
    return ap.arming.landed != 0 and climb > 0.0 and ap.control.motors.spool_state == ground.IS_UNLIMITED


@law
def run_user(v, climb):
    """One tick of the vertical part of a take-off in ALT_HOLD and LOITER; ``climb`` from the stick [m/s]."""
    ap = v.autopilot
    takeoff = ap.modes.takeoff
    rise = float(takeoff.user_alt)
    top = float(ap.control.pos_d.speed_up)
    if ap.arming.landed != 0:
        throttle = ramp(ap)
        risen = takeoff.user_start_d - ap.estimate.pos[2]
        fast = -ap.estimate.vel[2] >= constrain(climb, 0.1 * top, 0.5 * top)
        if has_thrust(ap, throttle) or fast or (rise > 0.0 and risen > 0.5 * rise):
            ground.set_landed(v, 0)
            altitude_start.init_d(ap)
        return
    altitude.input_pos_vel_accel_d(ap.control.pos_d, Motion(takeoff.user_start_d - rise, -climb, 0.0))
    altitude.update_d(ap)
    if climb < 0.0 or rise * 0.999 <= takeoff.user_start_d - ap.control.pos_d.pos_desired:
        takeoff.user_active = 0
