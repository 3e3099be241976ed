# SPDX-License-Identifier: BSD-3-Clause
"""GUIDED: flies the set-points of a companion computer or ground station.

Set-points are written by the laws of ``guided_setpoints``. Velocity, acceleration and attitude set-points older than
GUID_TIMEOUT stop the vehicle: velocity and acceleration become zero, the attitude level at constant height.
"""

from __future__ import annotations

from ....core.algebra import ZERO, euler_of, horizontal, quat_from_euler
from ....core.kernels import law
from ....core.scalars import constrain
from ....core.vectors import Euler, Vec3
from ...arming_checks import BY_RUDDER
from ...control.shaping import Motion, Motion2
from ...events import GUIDED_TIMEOUT, emit
from ...modes import ACCEPTED
from ..control import altitude, altitude_start, attitude, position, position_ned, throttle_mix
from ..control.state import DT
from ..state import Autopilot, Vehicle
from . import auto_yaw, ground, takeoff
from .mode import CopterMode
from .state import GuidedState, Modes

GUIDED = 4

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
    auto_yaw.set_default(ap, False)
    start_submode(ap, VELOCITY_ACCEL)
    ap.modes.guided.update_us = v.time_us
    return ACCEPTED


@law
def start_submode(ap: Autopilot, submode: int) -> None:
    """Change what kind of set-point is flown, from the present motion."""
    guided = ap.modes.guided
    guided.submode = submode
    guided.paused = False
    guided.timed_out = False
    guided.vel = ZERO
    guided.acc = ZERO
    ground.start_position_control(ap)


@law
def is_old(v: Vehicle) -> bool:
    """Whether the set-point is older than GUID_TIMEOUT."""
    ap = v.autopilot
    return v.time_us - ap.modes.guided.update_us > ap.params.GUID.TIMEOUT * 1e6


@law
def is_stale(v: Vehicle) -> bool:
    """Whether the set-point, of a kind that times out, is too old; tells the shell once."""
    ap = v.autopilot
    guided = ap.modes.guided
    if not is_old(v):
        guided.timed_out = False
        return False
    if not guided.timed_out:
        guided.timed_out = True
        emit(ap.events, v.time_us, GUIDED_TIMEOUT, float(guided.submode), 0.0)
    return True


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    guided = ap.modes.guided
    if (int(ap.params.GUID.OPTIONS) & _NO_PILOT_YAW) == 0:
        auto_yaw.follow_pilot(ap)
    if guided.submode == TAKEOFF:
        takeoff.run(v)
    elif guided.submode == ANGLE:
        run_angle(v)
    elif ground.is_grounded(ap.arming):
        ground.rest(ap)
    else:
        ap.control.motors.desired_spool = ground.UNLIMITED
        if guided.paused:
            ground.brake(ap)
        elif guided.submode == POSITION:
            run_position(v)
        else:
            run_motion(v)
        ground.fly(ap)


@law
def run_position(v: Vehicle) -> None:
    """Fly to a point and stay; the speed limits keep a climbing path straight."""
    ap = v.autopilot
    if is_old(v):
        auto_yaw.stop_turning(ap)
    position_ned.input_pos_ned(ap.control.pos_ne, ap.control.pos_d, ap.modes.guided.pos)


@law
def run_motion(v: Vehicle) -> None:
    """Fly velocity, acceleration, or position with both; the set-point moves on between messages."""
    ap = v.autopilot
    guided = ap.modes.guided
    stale = is_stale(v)
    if stale:
        guided.vel = ZERO
        guided.acc = ZERO
        auto_yaw.stop_turning(ap)
    if guided.submode == ACCEL:
        if stale:
            ground.brake(ap)
        else:
            follow_accel(ap, guided.acc)
        return
    advance(guided, DT)
    if guided.submode == POS_VEL_ACCEL:
        follow_motion(ap, guided)
    else:
        position.input_vel_accel_ne(ap.control.pos_ne, horizontal(guided.vel), horizontal(guided.acc))
        altitude.input_vel_accel_d(ap.control.pos_d, guided.vel.z, guided.acc.z)


@law
def advance(guided: GuidedState, dt: float) -> None:
    """The set-point's own motion during ``dt`` [s]."""
    guided.pos += (guided.vel + 0.5 * guided.acc * dt) * dt
    guided.vel += guided.acc * dt


@law
def follow_accel(ap: Autopilot, acc: Vec3) -> None:
    """Ask the position controllers for an acceleration, NED [m/s^2]."""
    position.input_accel_ne(ap.control.pos_ne, horizontal(acc))
    altitude.input_vel_accel_d(ap.control.pos_d, ap.control.pos_d.vel_desired, acc.z)


@law
def follow_motion(ap: Autopilot, target: GuidedState) -> None:
    """Ask the position controllers to follow a moving point."""
    pos, vel, acc = target.pos, target.vel, target.acc
    position.input_pos_vel_accel_ne(ap.control.pos_ne, Motion2(horizontal(pos), horizontal(vel), horizontal(acc)))
    altitude.input_pos_vel_accel_d(ap.control.pos_d, Motion(pos.z, vel.z, acc.z))


@law
def run_angle(v: Vehicle) -> None:
    """Fly SET_ATTITUDE_TARGET: attitude or rates with a climb rate or a thrust."""
    ap = v.autopilot
    guided = ap.modes.guided
    climb = 0.0
    if not guided.use_thrust:
        climb = constrain(guided.climb_rate, -ap.control.pos_d.speed_down, ap.control.pos_d.speed_up)
    if is_stale(v):
        climb = 0.0
        level_off(ap)
    wants_up = guided.thrust > 0.0 if guided.use_thrust else climb > 0.0
    if ap.arming.armed and wants_up:
        ap.arming.auto_armed = True
    if not ap.arming.armed or not ap.arming.auto_armed or (ap.arming.landed and not wants_up):
        ground.rest(ap)
        return
    ap.control.motors.desired_spool = ground.UNLIMITED
    if ap.arming.landed:
        leave_ground(ap)
        return
    if guided.use_attitude:
        attitude.input_quaternion(ap.control, ap.estimate, ap.params, guided.q, guided.rates)
    else:
        attitude.input_rates(ap.control, ap.estimate, ap.params, guided.rates)
    if guided.use_thrust:
        throttle_mix.set_throttle_out(ap.control, ap.params, guided.thrust, True, 0.0)
    else:
        altitude.input_vel_accel_d(ap.control.pos_d, -climb, 0.0)
        altitude.update_d(ap.control, ap.estimate, ap.params)


@law
def leave_ground(ap: Autopilot) -> None:
    """One tick of a landed vehicle that is asked to climb: it flies as soon as the motors have spooled up."""
    throttle_mix.set_throttle_out(ap.control, ap.params, 0.0, False, 0.0)
    attitude.relax(ap.control, ap.estimate)
    if ap.control.motors.spool_state == ground.IS_UNLIMITED:
        ground.set_landed(ap.arming, False)
        altitude_start.init_d(ap.control, ap.estimate, ap.params)


@law
def level_off(ap: Autopilot) -> None:
    """Replace a stale attitude by level flight at constant height, heading kept."""
    guided = ap.modes.guided
    yaw = euler_of(guided.q).yaw if guided.use_attitude else ap.control.attitude.target_euler.yaw
    guided.q = quat_from_euler(Euler(0.0, 0.0, yaw))
    guided.use_attitude = True
    guided.rates = ZERO
    if guided.use_thrust:
        guided.use_thrust = False
        altitude_start.init_d(ap.control, ap.estimate, ap.params)
    guided.climb_rate = 0.0


@law
def take_off(ap: Autopilot, target_d: float) -> None:
    """Climb to ``target_d`` (NED [m]) before the first set-point."""
    ap.modes.guided.submode = TAKEOFF
    ap.modes.guided.paused = False
    auto_yaw.set_mode(ap, auto_yaw.HOLD)
    takeoff.begin(ap, target_d)


@law
def climbs(modes: Modes) -> bool:
    """Whether a take-off is not done yet."""
    return modes.guided.submode == TAKEOFF and not modes.takeoff.complete


@law
def is_taking_off(v: Vehicle) -> bool:
    """Whether a take-off is not done yet."""
    return climbs(v.autopilot.modes)


@law
def may_arm(v: Vehicle, method: int) -> bool:
    """Whether it may be armed: by stick when GUID_OPTIONS says so."""
    return method != BY_RUDDER or (int(v.autopilot.params.GUID.OPTIONS) & _ARM_BY_STICK) != 0


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
