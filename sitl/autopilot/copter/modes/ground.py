# SPDX-License-Identifier: BSD-3-Clause
"""What all modes share: on the ground, disarming, and the last step of those that hold a position."""

from __future__ import annotations

from ....core.kernels import law
from ...events import DISARMED, emit_and_return
from ...state import Arming
from ..control import altitude, altitude_start, attitude, position, position_start
from ..state import Autopilot, Vehicle
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
def is_grounded(arming: Arming) -> bool:
    """Disarmed, not told to fly since arming, or landed."""
    return not arming.armed or not arming.auto_armed or arming.landed


@law
def set_landed(arming: Arming, landed: bool) -> None:
    """Note that the vehicle stands on the ground, or flies."""
    arming.landed = landed
    arming.landed_maybe = landed
    arming.landed_ticks = 0


@law
def disarm(v: Vehicle, method: int) -> None:
    """Disarm, without asking whether that is safe; ``method``: who (BY_*)."""
    ap = v.autopilot
    if not ap.arming.armed:
        return
    ap.arming.armed = False
    ap.arming.auto_armed = False
    set_landed(ap.arming, True)
    ap.arming.crash_ticks = 0
    ap.modes.arming_delay = False
    ap.modes.takeoff.user_active = False
    ap.modes.auto.started = False
    ap.control.motors.desired_spool = SHUT_DOWN
    emit_and_return(ap.events, v.time_us, DISARMED, float(method), 0.0)  # the mission goes back to its start


@law
def rest(ap: Autopilot) -> None:
    """One tick on the ground: motors idle, controllers follow the vehicle, throttle decays to zero."""
    motors = ap.control.motors
    motors.desired_spool = GROUND_IDLE if ap.arming.armed else SHUT_DOWN
    if motors.spool_state == IS_SHUT_DOWN or motors.spool_state == IS_GROUND_IDLE:
        attitude.reset_yaw_target(ap.control.attitude, ap.estimate.euler.yaw)
    position_start.relax_ne(ap.control, ap.estimate, ap.params)
    position.update_ne(ap.control, ap.estimate, ap.params)
    altitude_start.relax_d(ap.control, ap.estimate, ap.params, 0.0)
    altitude.update_d(ap.control, ap.estimate, ap.params)
    attitude.input_euler_roll_pitch_yaw_rate(ap.control, ap.estimate, ap.params, attitude.Lean(0.0, 0.0), 0.0)


@law
def fly(ap: Autopilot) -> None:
    """Position controllers, then the attitude that they ask for with the heading of auto_yaw."""
    position.update_ne(ap.control, ap.estimate, ap.params)
    altitude.update_d(ap.control, ap.estimate, ap.params)
    auto_yaw.point(ap, position.thrust_vector(ap.control.pos_ne))


@law
def brake(ap: Autopilot) -> None:
    """Ask the position controllers to come to a stop and stay."""
    position.brake_ne(ap.control.pos_ne)
    altitude.input_vel_accel_d(ap.control.pos_d, 0.0, 0.0)


@law
def hold(ap: Autopilot) -> None:
    """One tick of a stop, with the heading of auto_yaw."""
    ap.control.motors.desired_spool = UNLIMITED
    brake(ap)
    fly(ap)


@law
def set_waypoint_limits(ap: Autopilot) -> None:
    """Speed and acceleration limits of GUIDED, RTL and LAND: WPNAV_*."""
    p = ap.params.WPNAV
    position_start.set_max_speed_accel_ne(ap.control.pos_ne, ap.params, p.SPEED * 0.01, p.ACCEL * 0.01)
    altitude_start.set_max_speed_accel_d(
        ap.control.pos_d, ap.params.PSC, p.SPEED_DN * 0.01, p.SPEED_UP * 0.01, p.ACCEL_Z * 0.01
    )


@law
def start_position_control(ap: Autopilot) -> None:
    """Take over position control from whatever flew before, without a jump."""
    set_waypoint_limits(ap)
    position_start.init_ne(ap.control, ap.estimate, ap.params)
    altitude_start.init_d(ap.control, ap.estimate, ap.params)


@law
def continue_position_control(ap: Autopilot) -> None:
    """Go on with position control, which starts anew only where the mode before did not have it."""
    if not position_start.is_active_ne(ap.control):
        position_start.init_ne(ap.control, ap.estimate, ap.params)
    if not altitude_start.is_active_d(ap.control):
        altitude_start.init_d(ap.control, ap.estimate, ap.params)
