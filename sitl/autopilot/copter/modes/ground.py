# SPDX-License-Identifier: BSD-3-Clause
"""What all modes share: on the ground, disarming, and the last step of those that hold a position."""

from __future__ import annotations

from ....core.kernels import law
from ....core.mavlink import MavSeverity
from ... import arming_checks
from ...events import emit_and_return
from ...fence.checks import switch_on_disarming
from ...state import Arming, Estimate
from ..control import altitude, altitude_start, attitude, position, position_start
from ..control.spool import DesiredSpoolState, SpoolState
from ..control.state import Control, MotorsState
from ..parameters import Parameters
from ..state import Vehicle
from . import auto_yaw, autotune_gains
from .state import AutoYaw

DISARMED = arming_checks.DISARMED.saying(MavSeverity.INFO, "Disarming motors")


@law
def is_grounded(arming: Arming) -> bool:
    """Disarmed, not commanded to fly since arming, or landed."""
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
    landed = ap.arming.landed
    ap.arming.armed = False
    ap.arming.auto_armed = False
    set_landed(ap.arming, True)
    ap.arming.crash_ticks = 0
    ap.modes.arming_delay = False
    ap.modes.takeoff.user_active = False
    ap.modes.auto.started = False
    ap.control.motors.desired_spool = DesiredSpoolState.SHUT_DOWN
    switch_on_disarming(ap.fence, int(ap.params.FENCE.AUTOENABLE), ap.events, v.time_us)
    autotune_gains.settle(v, landed)
    emit_and_return(ap.events, v.time_us, DISARMED, float(method), 0.0)  # the mission goes back to its start


@law
def spool_by_stick(arming: Arming, throttle_zero: bool, motors: MotorsState) -> bool:
    """The motors' wanted state where the throttle stick drives them; whether they are off or idle, and push nothing."""
    if not arming.armed:
        motors.desired_spool = DesiredSpoolState.SHUT_DOWN
    else:
        motors.desired_spool = DesiredSpoolState.GROUND_IDLE if throttle_zero else DesiredSpoolState.THROTTLE_UNLIMITED
    if motors.spool_state == SpoolState.SHUT_DOWN or motors.spool_state == SpoolState.GROUND_IDLE:
        return True
    if motors.spool_state == SpoolState.THROTTLE_UNLIMITED and not motors.limit_throttle_lower and arming.landed:
        set_landed(arming, False)
    return False


@law
def rest(armed: bool, control: Control, est: Estimate, p: Parameters) -> None:
    """One tick on the ground: motors idle, controllers follow the vehicle, throttle decays to zero."""
    motors = control.motors
    motors.desired_spool = DesiredSpoolState.GROUND_IDLE if armed else DesiredSpoolState.SHUT_DOWN
    if motors.spool_state == SpoolState.SHUT_DOWN or motors.spool_state == SpoolState.GROUND_IDLE:
        attitude.reset_yaw_target(control.attitude, est.yaw)
    position_start.relax_ne(control, est, p)
    position.update_ne(control, est, p)
    altitude_start.relax_d(control, est, p, 0.0)
    altitude.update_d(control, est, p)
    attitude.input_euler_roll_pitch_yaw_rate(control, est, p, attitude.Lean(0.0, 0.0), 0.0)


@law
def fly(yaw: AutoYaw, control: Control, est: Estimate, p: Parameters) -> None:
    """Position controllers, then the attitude that they ask for with the heading of auto_yaw."""
    position.update_ne(control, est, p)
    altitude.update_d(control, est, p)
    auto_yaw.point(yaw, position.thrust_vector(control.pos_ne), control, est, p)


@law
def brake(control: Control) -> None:
    """Ask the position controllers to come to a stop and stay."""
    position.brake_ne(control.pos_ne)
    altitude.input_vel_accel_d(control.pos_d, 0.0, 0.0)


@law
def hold(yaw: AutoYaw, control: Control, est: Estimate, p: Parameters) -> None:
    """One tick of a stop, with the heading of auto_yaw."""
    control.motors.desired_spool = DesiredSpoolState.THROTTLE_UNLIMITED
    brake(control)
    fly(yaw, control, est, p)


@law
def set_waypoint_limits(control: Control, p: Parameters) -> None:
    """Speed and acceleration limits of GUIDED, RTL and LAND: WPNAV_*."""
    legs = p.WPNAV
    position_start.set_max_speed_accel_ne(control.pos_ne, p, legs.SPEED * 0.01, legs.ACCEL * 0.01)
    down, up = legs.SPEED_DN * 0.01, legs.SPEED_UP * 0.01
    altitude_start.set_max_speed_accel_d(control.pos_d, p.PSC, down, up, legs.ACCEL_Z * 0.01)


@law
def start_position_control(control: Control, est: Estimate, p: Parameters) -> None:
    """Take over position control from whatever flew before, without a jump."""
    set_waypoint_limits(control, p)
    position_start.init_ne(control, est, p)
    altitude_start.init_d(control, est, p)


@law
def continue_position_control(control: Control, est: Estimate, p: Parameters) -> None:
    """Go on with position control, which starts anew only where the mode before did not have it."""
    if not position_start.is_active_ne(control):
        position_start.init_ne(control, est, p)
    if not altitude_start.is_active_d(control):
        altitude_start.init_d(control, est, p)


@law
def stop_and_hold(arming: Arming, control: Control, est: Estimate, p: Parameters) -> None:
    """One tick: come to a stop and hold, the heading, too."""
    if is_grounded(arming):
        rest(arming.armed, control, est, p)
        return
    control.motors.desired_spool = DesiredSpoolState.THROTTLE_UNLIMITED
    brake(control)
    position.update_ne(control, est, p)
    altitude.update_d(control, est, p)
    attitude.input_thrust_vector_heading_rate(control, est, p, position.thrust_vector(control.pos_ne), 0.0)
