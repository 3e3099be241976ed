# SPDX-License-Identifier: BSD-3-Clause
"""GUIDED: flies the set-points of a companion computer or ground station.

Set-points are written by the laws of ``guided_setpoints``. Velocity, acceleration and attitude set-points older than
GUID_TIMEOUT stop the vehicle: velocity and acceleration become zero, the attitude level at constant height.
"""

from __future__ import annotations

import math

from ....core.algebra import horizontal, quat_of, vec3_of
from ....core.kernels import law
from ....core.rotations import quat_from_euler, quat_to_euler
from ....core.scalars import constrain
from ...arming_checks import BY_RUDDER
from ...control.shaping import Motion, Motion2
from ...events import GUIDED_TIMEOUT, emit
from ..control import altitude, altitude_start, attitude, position, position_ned, throttle_mix
from . import auto_yaw, ground, takeoff
from .mode import CopterMode

GUIDED = 4

# What it is doing (``modes.guided.submode``)
TAKEOFF = 0
POSITION = 1
POS_VEL_ACCEL = 2
VELOCITY_ACCEL = 3
ACCEL = 4
ANGLE = 5

DT = 0.0025
# GUID_OPTIONS
_ARM_BY_STICK = 1
_NO_PILOT_YAW = 4  # the yaw stick is ignored


@law
def start(v):
    """Enter: come to a stop and hold. Returns 0."""
    auto_yaw.set_default(v, 0)
    start_velocity(v)
    return 0


@law
def start_submode(v, submode):
    """Change what kind of set-point is flown, from the present motion."""
    guided = v.autopilot.modes.guided
    guided.submode = submode
    guided.paused = 0
    guided.timed_out = 0
    for k in range(3):
        guided.vel[k] = 0.0
        guided.acc[k] = 0.0
    ground.start_position_control(v)


@law
def start_velocity(v):
    """Fly velocity set-points, beginning with a stop."""
    start_submode(v, VELOCITY_ACCEL)
    v.autopilot.modes.guided.update_us = v.time_us


@law
def is_old(v):
    """Whether the set-point is older than GUID_TIMEOUT."""
    ap = v.autopilot
    return v.time_us - ap.modes.guided.update_us > ap.params.GUID.TIMEOUT * 1e6


@law
def is_stale(v):
    """Whether the set-point, of a kind that times out, is too old; tells the shell once."""
    ap = v.autopilot
    guided = ap.modes.guided
    if not is_old(v):
        guided.timed_out = 0
        return False
    if guided.timed_out == 0:
        guided.timed_out = 1
        emit(ap.events, v.time_us, GUIDED_TIMEOUT, float(guided.submode), 0.0)
    return True


@law
def run(v):
    """One tick."""
    ap = v.autopilot
    guided = ap.modes.guided
    if (int(ap.params.GUID.OPTIONS) & _NO_PILOT_YAW) == 0:
        auto_yaw.pilot(v)
    if guided.submode == TAKEOFF:
        takeoff.run(v)
    elif guided.submode == ANGLE:
        run_angle(v)
    elif ground.is_grounded(v):
        ground.handle(v)
    else:
        ap.control.motors.desired_spool = ground.UNLIMITED
        if guided.paused != 0:
            position.brake_ne(ap.control.pos_ne)
            altitude.input_vel_accel_d(ap.control.pos_d, 0.0, 0.0)
        elif guided.submode == POSITION:
            run_position(v)
        else:
            run_motion(v)
        ground.fly(v)


@law
def run_position(v):
    """Fly to a point and stay; the speed limits keep a climbing path straight."""
    ap = v.autopilot
    guided = ap.modes.guided
    if is_old(v):
        auto_yaw.stop_turning(v)
    position_ned.input_pos_ned(ap.control.pos_ne, ap.control.pos_d, vec3_of(guided.pos))


@law
def run_motion(v):
    """Fly velocity, acceleration, or position with both; the set-point moves on between messages."""
    ap = v.autopilot
    guided = ap.modes.guided
    if is_stale(v):
        for k in range(3):
            guided.vel[k] = 0.0
            guided.acc[k] = 0.0
        auto_yaw.stop_turning(v)
        if guided.submode == ACCEL:
            position.brake_ne(ap.control.pos_ne)
            altitude.input_vel_accel_d(ap.control.pos_d, 0.0, 0.0)
            return
    acc = vec3_of(guided.acc)
    if guided.submode == ACCEL:
        position.input_accel_ne(ap.control.pos_ne, horizontal(acc))
        altitude.input_vel_accel_d(ap.control.pos_d, ap.control.pos_d.vel_desired, acc.z)
        return
    for k in range(3):
        guided.pos[k] += (guided.vel[k] + 0.5 * guided.acc[k] * DT) * DT
        guided.vel[k] += guided.acc[k] * DT
    vel = vec3_of(guided.vel)
    if guided.submode == POS_VEL_ACCEL:
        pos = vec3_of(guided.pos)
        position.input_pos_vel_accel_ne(ap.control.pos_ne, Motion2(horizontal(pos), horizontal(vel), horizontal(acc)))
        altitude.input_pos_vel_accel_d(ap.control.pos_d, Motion(pos.z, vel.z, acc.z))
    else:
        position.input_vel_accel_ne(ap.control.pos_ne, horizontal(vel), horizontal(acc))
        altitude.input_vel_accel_d(ap.control.pos_d, vel.z, acc.z)


@law
def run_angle(v):
    """Fly SET_ATTITUDE_TARGET: attitude or rates with a climb rate or a thrust."""
    ap = v.autopilot
    guided = ap.modes.guided
    climb = 0.0
    if guided.use_thrust == 0:
        climb = constrain(float(guided.climb_rate), -ap.control.pos_d.speed_down, ap.control.pos_d.speed_up)
    if is_stale(v):
        climb = 0.0
        level_off(v)
    wants_up = guided.thrust > 0.0 if guided.use_thrust != 0 else climb > 0.0
    if ap.arming.armed != 0 and wants_up:
        ap.arming.auto_armed = 1
    if ap.arming.armed == 0 or ap.arming.auto_armed == 0 or (ap.arming.landed != 0 and not wants_up):
        ground.handle(v)
        return
    ap.control.motors.desired_spool = ground.UNLIMITED
    if ap.arming.landed != 0:
        throttle_mix.set_throttle_out(ap, 0.0, False, 0.0)
        attitude.relax(ap)
        if ap.control.motors.spool_state == ground.IS_UNLIMITED:
            ground.set_landed(v, 0)
            altitude_start.init_d(ap)
        return
    if guided.use_attitude != 0:
        attitude.input_quaternion(ap, quat_of(guided.q), vec3_of(guided.rates))
    else:
        attitude.input_rates(ap, vec3_of(guided.rates))
    if guided.use_thrust != 0:
        throttle_mix.set_throttle_out(ap, guided.thrust, True, 0.0)
    else:
        altitude.input_vel_accel_d(ap.control.pos_d, -climb, 0.0)
        altitude.update_d(ap)


@law
def level_off(v):
    """Replace a stale attitude by level flight at constant height, heading kept."""
    ap = v.autopilot
    guided = ap.modes.guided
    if guided.use_attitude != 0:
        _roll, _pitch, yaw = quat_to_euler(
            float(guided.q[0]), float(guided.q[1]), float(guided.q[2]), float(guided.q[3])
        )
    else:
        yaw = float(ap.control.attitude.target_euler[2])
    w, x, y, z = quat_from_euler(0.0, 0.0, yaw)
    guided.q[0], guided.q[1], guided.q[2], guided.q[3] = w, x, y, z
    guided.use_attitude = 1
    for k in range(3):
        guided.rates[k] = 0.0
    if guided.use_thrust != 0:
        guided.use_thrust = 0
        altitude_start.init_d(ap)
    guided.climb_rate = 0.0


@law
def distance(v):
    """Horizontal distance to the target position [m]; 0 when the set-point has none."""
    ap = v.autopilot
    guided = ap.modes.guided
    if guided.submode != POSITION and guided.submode != POS_VEL_ACCEL:
        return 0.0
    return math.hypot(guided.pos[0] - ap.estimate.pos[0], guided.pos[1] - ap.estimate.pos[1])


@law
def take_off(v, target_d):
    """Climb to ``target_d`` (NED [m]) before the first set-point."""
    guided = v.autopilot.modes.guided
    guided.submode = TAKEOFF
    guided.paused = 0
    auto_yaw.set_mode(v, auto_yaw.HOLD)
    takeoff.begin(v, target_d)


@law
def is_taking_off(v):
    """Whether a take-off is not done yet."""
    modes = v.autopilot.modes
    return modes.guided.submode == TAKEOFF and modes.takeoff.complete == 0


@law
def may_arm(v, method):
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
