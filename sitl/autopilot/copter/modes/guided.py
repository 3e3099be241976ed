# SPDX-License-Identifier: BSD-3-Clause
"""GUIDED: flies the set-points of a companion computer or ground station.

Set-points are written by the laws of ``guided_setpoints``. Velocity, acceleration and attitude set-points older than
GUID_TIMEOUT stop the vehicle: velocity and acceleration become zero, the attitude level at constant height.

A pause (DO_PAUSE_CONTINUE) stops the vehicle and holds it, whatever set-points come meanwhile; the last of them is
flown when it goes on.

A mission's GUIDED_ENABLE flies so, too, within the limits of DO_GUIDED_LIMITS.
"""

from __future__ import annotations

from ....core.algebra import (
    ZERO,
    euler_of,
    horizontal,
    multiply,
    norm,
    norm2,
    normalise,
    quat_from_euler,
    quat_from_rotation_vector,
    rotate,
)
from ....core.kernels import law
from ....core.scalars import constrain
from ....core.vectors import Euler, Vec2, Vec3
from ...arming_checks import ArmingMethod
from ...control.shaping import Motion, Motion2
from ...events import Event, Events, emit
from ...modes import ModeResult
from ...state import Arming, Estimate
from ...terrain.ground import lose_ground
from .. import avoidance, terrain_following
from ..control import altitude, altitude_start, attitude, position, position_ned, throttle_mix
from ..control.attitude_target import limit_rates, rate_max
from ..control.spool import DesiredSpoolState, SpoolState
from ..control.state import DT, Control
from ..parameters import Parameters
from ..state import Vehicle
from . import auto_yaw, ground, takeoff
from .mode import CopterMode
from .state import GuidedState, Modes

GUIDED = 4
GUIDED_NOGPS = 20

GUIDED_TIMEOUT = Event(9)

# What it is doing (``modes.guided.submode``)
TAKEOFF = 0
POSITION = 1
POS_VEL_ACCEL = 2
VELOCITY_ACCEL = 3
ACCEL = 4
ANGLE = 5

# GUID_OPTIONS
_ARM_BY_STICK = 1
_NO_PILOT_YAW = 4  # the yaw stick is ignored


@law
def start(v: Vehicle) -> int:
    """Enter: come to a stop and hold."""
    ap = v.autopilot
    modes, control, est, p = ap.modes, ap.control, ap.estimate, ap.params
    auto_yaw.set_default(modes.auto_yaw, p.WP, False, control.attitude, est)
    start_submode(modes.guided, VELOCITY_ACCEL, control, est, p)
    modes.guided.paused = False
    modes.guided.update_us = v.time_us
    return ModeResult.ACCEPTED


@law
def start_submode(guided: GuidedState, submode: int, control: Control, est: Estimate, p: Parameters) -> None:
    """Change what kind of set-point is flown, from the present motion."""
    guided.submode = submode
    guided.timed_out = False
    guided.vel = ZERO
    guided.acc = ZERO
    ground.start_position_control(control, est, p)


@law
def is_stale(guided: GuidedState, time_us: int, timeout: float) -> bool:
    """Whether the set-point is older than ``timeout`` [s]."""
    return time_us - guided.update_us > timeout * 1e6


@law
def note_timeout(guided: GuidedState, stale: bool, events: Events, time_us: int) -> None:
    """Report to the shell, once, that a set-point of a kind that times out is too old."""
    if stale and not guided.timed_out:
        emit(events, time_us, GUIDED_TIMEOUT, float(guided.submode), 0.0)
    guided.timed_out = stale


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    modes, control, est, p = ap.modes, ap.control, ap.estimate, ap.params
    guided = modes.guided
    if (int(p.GUID.OPTIONS) & _NO_PILOT_YAW) == 0:
        auto_yaw.follow_pilot(modes, control.attitude, est)
    stale = is_stale(guided, v.time_us, p.GUID.TIMEOUT)
    if guided.paused:
        ground.stop_and_hold(ap.arming, control, est, p)
    elif guided.submode == TAKEOFF:
        takeoff.run(v)
    elif guided.submode == ANGLE:
        note_timeout(guided, stale, ap.events, v.time_us)
        run_angle(guided, stale, ap.arming, control, est, p)
    elif ground.is_grounded(ap.arming):
        ground.rest(ap.arming.armed, control, est, p)
    else:
        control.motors.desired_spool = DesiredSpoolState.THROTTLE_UNLIMITED
        if guided.submode != POSITION:
            note_timeout(guided, stale, ap.events, v.time_us)
        if stale:
            auto_yaw.stop_turning(modes.auto_yaw, control.attitude, est)
        follow_setpoint(v, guided, stale, control)
        ground.fly(modes.auto_yaw, control, est, p)


@law
def follow_setpoint(v: Vehicle, guided: GuidedState, stale: bool, control: Control) -> None:
    """Ask the position controllers for the set-point, which moves on between messages; a stale motion stops.

    POSITION: fly to a point and stay; the speed limits keep a climbing path straight.
    """
    if guided.submode == POSITION:
        if v.autopilot.modes.nav.over_ground:
            go_over_ground(v, guided.pos, control)
        else:
            position_ned.input_pos_ned(control.pos_ne, control.pos_d, guided.pos)
        return
    if stale:
        guided.vel = ZERO
        guided.acc = ZERO
    if guided.submode == ACCEL:
        if stale:
            ground.brake(control)
        else:
            position.input_accel_ne(control.pos_ne, horizontal(guided.acc))
            altitude.input_vel_accel_d(control.pos_d, control.pos_d.vel_desired, guided.acc.z)
        return
    advance(guided, DT)
    pos, vel, acc = guided.pos, guided.vel, guided.acc
    if guided.submode == POS_VEL_ACCEL:
        position.input_pos_vel_accel_ne(control.pos_ne, Motion2(horizontal(pos), horizontal(vel), horizontal(acc)))
        altitude.input_pos_vel_accel_d(control.pos_d, Motion(pos.z, vel.z, acc.z))
    else:
        position.input_vel_accel_ne(control.pos_ne, avoidance.limit_velocity(v, horizontal(vel)), horizontal(acc))
        altitude.input_vel_accel_d(control.pos_d, -avoidance.limit_climb(v, -vel.z), acc.z)


@law
def go_over_ground(v: Vehicle, pos: Vec3, control: Control) -> None:
    """Straight to a point above the ground as above a plain, which follows the ground; where nothing is known of it the
    vehicle stops, and it is a failsafe at once."""
    nav, path = v.autopilot.modes.nav, control.pos_d
    path.pos_desired -= nav.ground_d
    path.vel_desired -= nav.ground_vel
    path.accel_desired -= nav.ground_acc
    if nav.ground_lost:
        ground.brake(control)
        lose_ground(v.autopilot.terrain, v.time_us)
    else:
        position_ned.input_pos_ned(control.pos_ne, path, pos)
    terrain_following.follow(v)
    path.pos_desired += nav.ground_d
    path.vel_desired += nav.ground_vel
    path.accel_desired += nav.ground_acc


@law
def advance(guided: GuidedState, dt: float) -> None:
    """The set-point's own motion during ``dt`` [s]."""
    guided.pos += (guided.vel + 0.5 * guided.acc * dt) * dt
    guided.vel += guided.acc * dt


@law
def run_angle(guided: GuidedState, stale: bool, arming: Arming, control: Control, est: Estimate, p: Parameters) -> None:
    """Fly SET_ATTITUDE_TARGET: attitude or rates with a climb rate or a thrust."""
    climb = 0.0
    if not guided.use_thrust:
        climb = constrain(guided.climb_rate, -control.pos_d.speed_down, control.pos_d.speed_up)
    if stale:
        climb = 0.0
        level_off(guided, control, est, p)
    wants_up = guided.thrust > 0.0 if guided.use_thrust else climb > 0.0
    if arming.armed and wants_up:
        arming.auto_armed = True
    if not arming.armed or not arming.auto_armed or (arming.landed and not wants_up):
        ground.rest(arming.armed, control, est, p)
        return
    control.motors.desired_spool = DesiredSpoolState.THROTTLE_UNLIMITED
    if arming.landed:
        leave_ground(arming, control, est, p)
    else:
        fly_angle(guided, climb, control, est, p)


@law
def fly_angle(guided: GuidedState, climb: float, control: Control, est: Estimate, p: Parameters) -> None:
    """One tick of an attitude or rates with a thrust or ``climb`` [m/s] in the air."""
    if guided.use_attitude and norm(guided.rates) > 0.0:
        turning = rotate(guided.q, limit_rates(guided.rates, rate_max(p.ATC)))  # as ArduPilot has it
        attitude.input_quaternion(control, est, p, guided.q, turning)
        guided.q = normalise(multiply(guided.q, quat_from_rotation_vector(turning * DT)))
    elif guided.use_attitude:
        attitude.input_quaternion(control, est, p, guided.q, guided.rates)
    else:
        attitude.input_rates(control, est, p, guided.rates)
    if guided.use_thrust:
        throttle_mix.set_throttle_out(control, p, guided.thrust, True, 0.0)
    else:
        altitude.input_vel_accel_d(control.pos_d, -climb, 0.0)
        altitude.update_d(control, est, p)


@law
def leave_ground(arming: Arming, control: Control, est: Estimate, p: Parameters) -> None:
    """One tick of a landed vehicle that is asked to climb: it flies as soon as the motors have spooled up."""
    throttle_mix.set_throttle_out(control, p, 0.0, False, 0.0)
    attitude.relax(control, est)
    if control.motors.spool_state == SpoolState.THROTTLE_UNLIMITED:
        ground.set_landed(arming, False)
        altitude_start.init_d(control, est, p)


@law
def level_off(guided: GuidedState, control: Control, est: Estimate, p: Parameters) -> None:
    """Replace a stale attitude by level flight at constant height, heading kept."""
    yaw = euler_of(guided.q).yaw if guided.use_attitude else control.attitude.target_euler.yaw
    guided.q = quat_from_euler(Euler(0.0, 0.0, yaw))
    guided.use_attitude = True
    guided.rates = ZERO
    if guided.use_thrust:
        guided.use_thrust = False
        altitude_start.init_d(control, est, p)
    guided.climb_rate = 0.0


@law
def clear_limits(guided: GuidedState) -> None:
    """No limits, until a mission sets some."""
    guided.limit_us = 0
    guided.limit_low = 0.0
    guided.limit_high = 0.0
    guided.limit_distance = 0.0


@law
def begin_limits(guided: GuidedState, time_us: int, pos: Vec2) -> None:
    """Guided within a mission begins now, at ``pos`` NE [m]."""
    guided.limit_since_us = time_us
    guided.limit_from = pos


@law
def is_at_limit(guided: GuidedState, time_us: int, pos: Vec3) -> bool:
    """Guided within a mission: whether its time is over, or ``pos`` (NED [m]) is too low, too high or too far away."""
    if guided.limit_us > 0 and time_us - guided.limit_since_us >= guided.limit_us:
        return True
    if guided.limit_low != 0.0 and -pos.z < guided.limit_low:
        return True
    if guided.limit_high != 0.0 and -pos.z > guided.limit_high:
        return True
    return guided.limit_distance > 0.0 and norm2(horizontal(pos) - guided.limit_from) > guided.limit_distance


@law
def is_taking_off(modes: Modes) -> bool:
    """Whether a take-off is not done yet."""
    return modes.guided.submode == TAKEOFF and not modes.takeoff.complete


@law
def may_arm(p: Parameters, method: int) -> bool:
    """Whether it may be armed: by stick when GUID_OPTIONS says so."""
    return method != ArmingMethod.RUDDER or (int(p.GUID.OPTIONS) & _ARM_BY_STICK) != 0


MODE = CopterMode(
    number=GUIDED,
    name="GUIDED",
    start=start,
    run=run,
    needs_position=True,
    autonomous=True,
    arms_at_any_throttle=True,
    may_arm=may_arm,
    is_taking_off=is_taking_off,
)
