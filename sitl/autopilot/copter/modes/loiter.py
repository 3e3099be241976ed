# SPDX-License-Identifier: BSD-3-Clause
"""LOITER: holds the position; roll and pitch sticks accelerate it, drag and braking bring it to rest again.

The sticks are a horizontal acceleration. The desired velocity follows what a lean that obeys the attitude
controller's shaping would give, less a drag that balances a full stick at LOIT_SPEED; with the sticks
centred for LOIT_BRK_DELAY it brakes with LOIT_BRK_JERK up to LOIT_BRK_ACCEL.
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.scalars import constrain, wrap_pi
from ....core.vectors import Vec2
from ...control.shaping import Motion2, shape_angle, sqrt_controller
from .. import pilot
from ..control import attitude, position, position_start
from . import alt_hold
from .mode import CopterMode

LOITER = 5

DT = 0.0025
_CDEG = math.pi / 18000.0
_LEAN_SHARE = 2.0 / 3.0
"""LOIT_ANG_MAX 0: so much of the lean limit is the pilot's."""
_SPEED_MIN = 0.2  # [m/s]


@law
def angle_max(ap):
    """Lean of a full stick [rad]: LOIT_ANG_MAX, or two thirds of the lean limit."""
    most = math.radians(ap.params.ANGLE_MAX * 0.01)
    if ap.params.PSC.ANGLE_MAX > 0.0:
        most = min(most, math.radians(ap.params.PSC.ANGLE_MAX))
    if ap.params.LOIT.ANG_MAX > 0.0:
        return min(math.radians(ap.params.LOIT.ANG_MAX), most)
    return _LEAN_SHARE * most


@law
def start(v):
    """Enter from the present motion. Returns 0."""
    ap = v.autopilot
    loiter = ap.modes.loiter
    set_limits(ap)
    active = position_start.is_active_ne(ap.control)
    if not active:
        position_start.init_ne(ap)
    target = ap.control.attitude.target_euler
    loiter.predicted_euler[0] = target[0]
    loiter.predicted_euler[1] = target[1]
    acc = position_start.lean_accel(target.roll, target.pitch, ap.estimate.euler[2])
    loiter.predicted_acc[0], loiter.predicted_acc[1] = acc.x, acc.y
    loiter.predicted_rate[0] = 0.0
    loiter.predicted_rate[1] = 0.0
    loiter.brake_acc = 0.0
    loiter.brake_us = v.time_us
    alt_hold.start_vertical(v)
    return 0


@law
def set_limits(ap):
    """Limits of the position correction: LOIT_SPEED, LOIT_ACC_MAX."""
    p = ap.params
    position_start.set_max_speed_accel_ne(ap, max(p.LOIT.SPEED * 0.01, _SPEED_MIN), p.LOIT.ACC_MAX * 0.01)


@law
def read_sticks(v, roll, pitch):
    """Accelerations that the sticks ask for, and that a vehicle which follows them would have."""
    ap = v.autopilot
    p = ap.params
    loiter = ap.modes.loiter
    yaw = float(ap.estimate.euler[2])
    if roll == 0.0 and pitch == 0.0:
        loiter.acc[0] = 0.0
        loiter.acc[1] = 0.0
    else:
        acc = position_start.lean_accel(roll, pitch, yaw)
        loiter.acc[0], loiter.acc[1] = acc.x, acc.y
    tc = float(p.ATC.INPUT_TC)
    wanted = (roll, pitch)
    limits = (p.ATC.ACCEL_R_MAX * _CDEG, p.ATC.ACCEL_P_MAX * _CDEG)
    for k in range(2):
        error = wrap_pi(wanted[k] - loiter.predicted_euler[k])
        rate = shape_angle(error, loiter.predicted_rate[k], tc, limits[k], DT, 0.0, 0.0)
        loiter.predicted_rate[k] = rate
        loiter.predicted_euler[k] = loiter.predicted_euler[k] + rate * DT
    predicted = position_start.lean_accel(loiter.predicted_euler[0], loiter.predicted_euler[1], yaw)
    loiter.predicted_acc[0], loiter.predicted_acc[1] = predicted.x, predicted.y


@law
def advance(v):
    """Move the desired position, velocity and acceleration on by one tick."""
    ap = v.autopilot
    p = ap.params
    loiter = ap.modes.loiter
    ne = ap.control.pos_ne
    most = max(p.LOIT.SPEED * 0.01, _SPEED_MIN)
    vn = ne.vel_desired[0] + loiter.predicted_acc[0] * DT
    ve = ne.vel_desired[1] + loiter.predicted_acc[1] * DT
    an, ae = float(loiter.acc[0]), float(loiter.acc[1])
    speed = math.hypot(vn, ve)
    if an != 0.0 or ae != 0.0:
        loiter.brake_us = v.time_us
    if speed > 1e-9:
        drag = 9.80665 * math.tan(angle_max(ap)) * speed / most
        brake = 0.0
        if v.time_us - loiter.brake_us > p.LOIT.BRK_DELAY * 1e6:
            gain = 0.5 * p.PSC.VELXY.P
            brake = constrain(sqrt_controller(speed, gain, p.LOIT.BRK_JERK * 0.01, DT), 0.0, p.LOIT.BRK_ACCEL * 0.01)
        jerk = p.LOIT.BRK_JERK * 0.01 * DT
        loiter.brake_acc += constrain(brake - loiter.brake_acc, -jerk, jerk)
        slower = min(max(speed - (drag + loiter.brake_acc) * DT, 0.0), most)
        an -= vn / speed * loiter.brake_acc
        ae -= ve / speed * loiter.brake_acc
        vn *= slower / speed
        ve *= slower / speed
    vel = Vec2(vn, ve)
    position.set_pos_vel_accel_ne(ne, Motion2(ne.pos_desired + vel * DT, vel, Vec2(an, ae)))


@law
def run(v):
    """One tick."""
    ap = v.autopilot
    alt_hold.set_limits(ap)
    set_limits(ap)
    most = angle_max(ap)
    limit = min(math.radians(ap.params.ANGLE_MAX * 0.01), most)
    roll, pitch = pilot.lean_angles(ap, most, limit)
    read_sticks(v, roll, pitch)
    climb = alt_hold.climb_rate(ap)
    doing = alt_hold.state(v, climb)
    if doing == alt_hold.STOPPED or doing == alt_hold.LANDED_IDLE:
        attitude.reset_yaw_target(ap)
    if doing == alt_hold.STOPPED or doing == alt_hold.LANDED_IDLE or doing == alt_hold.LANDED_READY:
        position_start.relax_ne(ap)
        ap.modes.loiter.brake_acc = 0.0
        position.update_ne(ap)
        attitude.input_euler_roll_pitch_yaw_rate(ap, 0.0, 0.0, float(ap.modes.pilot.yaw_rate))
    else:
        if ap.arming.landed_maybe != 0:
            position_start.soften_for_landing_ne(ap.control.pos_ne, ap.estimate.pos)
        advance(v)
        position.update_ne(ap)
        attitude.input_thrust_vector_heading_rate(
            ap, position.thrust_vector(ap.control.pos_ne), ap.modes.pilot.yaw_rate
        )
    alt_hold.run_vertical(v, doing, climb)


MODE = CopterMode(
    number=LOITER,
    name="LOITER",
    start=start,
    run=run,
    standard_mode=1,
    climb_stick=True,
    needs_position=True,
)
