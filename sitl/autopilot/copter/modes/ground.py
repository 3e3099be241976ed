# SPDX-License-Identifier: BSD-3-Clause
"""What all modes share on the ground, and the last step of all modes that hold a position."""

from __future__ import annotations

from ....core.kernels import law
from ...events import DISARMED, emit_and_return
from ..control import altitude, altitude_start, attitude, position, position_start
from . import auto_yaw

# Spool states wanted by a mode (control/motors.py)
SHUT_DOWN = 0
GROUND_IDLE = 1
UNLIMITED = 2

# Spool states that the motors are in
IS_SHUT_DOWN = 0
IS_GROUND_IDLE = 1
IS_UNLIMITED = 3


@law
def is_grounded(v):
    """Disarmed, not told to fly since arming, or landed."""
    arming = v.autopilot.arming
    return arming.armed == 0 or arming.auto_armed == 0 or arming.landed != 0


@law
def set_landed(v, landed):
    """Note that the vehicle stands on the ground (1) or flies (0)."""
    arming = v.autopilot.arming
    arming.landed = landed
    arming.landed_ticks = 0
    if landed != 0:
        arming.landed_maybe = 1
    else:
        arming.landed_maybe = 0


@law
def disarm(v, method):
    """Disarm, without asking whether that is safe; ``method``: who (BY_*)."""
    ap = v.autopilot
    arming = ap.arming
    if not arming.armed:
        return
    arming.armed = False
    arming.auto_armed = False
    arming.landed = True
    arming.landed_maybe = True
    arming.landed_ticks = 0
    arming.crash_ticks = 0
    ap.modes.arming_delay = 0
    ap.modes.takeoff.user_active = 0
    ap.modes.auto.started = 0
    ap.control.motors.desired_spool = SHUT_DOWN
    emit_and_return(ap.events, v.time_us, DISARMED, float(method), 0.0)  # the mission goes back to its start


@law
def handle(v):
    """One tick on the ground: motors idle, controllers follow the vehicle, throttle decays to zero."""
    ap = v.autopilot
    motors = ap.control.motors
    motors.desired_spool = GROUND_IDLE if ap.arming.armed != 0 else SHUT_DOWN
    if motors.spool_state == IS_SHUT_DOWN or motors.spool_state == IS_GROUND_IDLE:
        attitude.reset_yaw_target(ap)
    position_start.relax_ne(ap)
    position.update_ne(ap)
    altitude_start.relax_d(ap, 0.0)
    altitude.update_d(ap)
    attitude.input_euler_roll_pitch_yaw_rate(ap, 0.0, 0.0, 0.0)


@law
def fly(v):
    """Position controllers, then the attitude that they ask for with the heading of auto_yaw."""
    ap = v.autopilot
    position.update_ne(ap)
    altitude.update_d(ap)
    auto_yaw.apply(v, position.thrust_vector(ap.control.pos_ne))


@law
def hold(v):
    """One tick of a stop: brake and stay, with the heading of auto_yaw."""
    ap = v.autopilot
    ap.control.motors.desired_spool = UNLIMITED
    position.brake_ne(ap.control.pos_ne)
    altitude.input_vel_accel_d(ap.control.pos_d, 0.0, 0.0)
    fly(v)


@law
def set_waypoint_limits(v):
    """Speed and acceleration limits of GUIDED, RTL and LAND: WPNAV_*."""
    ap = v.autopilot
    p = ap.params
    position_start.set_max_speed_accel_ne(ap, p.WPNAV.SPEED * 0.01, p.WPNAV.ACCEL * 0.01)
    altitude_start.set_max_speed_accel_d(ap, p.WPNAV.SPEED_DN * 0.01, p.WPNAV.SPEED_UP * 0.01, p.WPNAV.ACCEL_Z * 0.01)


@law
def start_position_control(v):
    """Take over position control from whatever flew before, without a jump."""
    ap = v.autopilot
    set_waypoint_limits(v)
    position_start.init_ne(ap)
    altitude_start.init_d(ap)
