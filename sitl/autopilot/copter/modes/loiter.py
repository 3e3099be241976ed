# SPDX-License-Identifier: BSD-3-Clause
"""LOITER: holds the position; roll and pitch sticks accelerate it, drag and braking bring it to rest again.

The sticks are a horizontal acceleration. The desired velocity follows what a lean that obeys the attitude
controller's shaping would give, less a drag that balances a full stick at LOIT_SPEED; with the sticks
centred for LOIT_BRK_DELAY it brakes with LOIT_BRK_JERK up to LOIT_BRK_ACCEL.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ....core.algebra import ZERO2
from ....core.kernels import law
from ....core.scalars import constrain, wrap_pi
from ....core.vectors import Vec2
from ...control.shaping import Motion2, shape_angle, sqrt_controller
from ...modes import ACCEPTED
from .. import pilot
from ..control import attitude, position, position_start
from ..control.state import DT, GRAVITY
from ..parameters import Parameters
from ..parameters.control import Attitude
from ..state import Autopilot, Vehicle
from . import alt_hold
from .mode import CopterMode
from .state import LoiterState

LOITER = 5

_CDEG = math.pi / 18000.0
_LEAN_SHARE = 2.0 / 3.0
"""LOIT_ANG_MAX 0: so much of the lean limit is the pilot's."""
_SPEED_MIN = 0.2  # [m/s]


class Limits(NamedTuple):
    """How LOITER moves."""

    speed_max: float  # [m/s]
    accel_full: float  # of a full stick [m/s^2]
    brake_gain: float  # from speed to deceleration [1/s]
    brake_accel: float  # [m/s^2]
    brake_jerk: float  # [m/s^3]


@law
def angle_max(p: Parameters) -> float:
    """Lean of a full stick [rad]: LOIT_ANG_MAX, or two thirds of the lean limit."""
    lean_max = math.radians(p.ANGLE_MAX * 0.01)
    if p.PSC.ANGLE_MAX > 0.0:
        lean_max = min(lean_max, math.radians(p.PSC.ANGLE_MAX))
    if p.LOIT.ANG_MAX > 0.0:
        return min(math.radians(p.LOIT.ANG_MAX), lean_max)
    return _LEAN_SHARE * lean_max


@law
def limits(p: Parameters) -> Limits:
    """LOIT_*."""
    return Limits(
        max(p.LOIT.SPEED * 0.01, _SPEED_MIN),
        GRAVITY * math.tan(angle_max(p)),
        0.5 * p.PSC.VELXY.P,
        p.LOIT.BRK_ACCEL * 0.01,
        p.LOIT.BRK_JERK * 0.01,
    )


@law
def start(v: Vehicle) -> int:
    """Enter from the present motion."""
    ap = v.autopilot
    loiter = ap.modes.loiter
    set_limits(ap)
    if not position_start.is_active_ne(ap.control):
        position_start.init_ne(ap.control, ap.estimate, ap.params)
    target = ap.control.attitude.target_euler
    loiter.predicted_euler = Vec2(target.roll, target.pitch)
    loiter.predicted_acc = position_start.lean_accel(target.roll, target.pitch, ap.estimate.euler.yaw)
    loiter.predicted_rate = ZERO2
    loiter.brake_acc = 0.0
    loiter.brake_us = v.time_us
    alt_hold.start_vertical(ap)
    return ACCEPTED


@law
def set_limits(ap: Autopilot) -> None:
    """Limits of the position correction: LOIT_SPEED, LOIT_ACC_MAX."""
    p = ap.params.LOIT
    position_start.set_max_speed_accel_ne(
        ap.control.pos_ne, ap.params, max(p.SPEED * 0.01, _SPEED_MIN), p.ACC_MAX * 0.01
    )


@law
def predict_accel(loiter: LoiterState, lean: attitude.Lean, yaw: float, p: Attitude) -> None:
    """Accelerations that the sticks (``lean``) ask for, and that a vehicle which follows them would have."""
    loiter.acc = (
        ZERO2 if lean.roll == 0.0 and lean.pitch == 0.0 else position_start.lean_accel(lean.roll, lean.pitch, yaw)
    )
    now, rate = loiter.predicted_euler, loiter.predicted_rate
    rate = Vec2(
        shape_angle(wrap_pi(lean.roll - now.x), rate.x, p.INPUT_TC, p.ACCEL_R_MAX * _CDEG, DT, 0.0, 0.0),
        shape_angle(wrap_pi(lean.pitch - now.y), rate.y, p.INPUT_TC, p.ACCEL_P_MAX * _CDEG, DT, 0.0, 0.0),
    )
    loiter.predicted_rate = rate
    loiter.predicted_euler += rate * DT
    loiter.predicted_acc = position_start.lean_accel(loiter.predicted_euler.x, loiter.predicted_euler.y, yaw)


@law
def advance_path(loiter: LoiterState, path: Motion2, limits: Limits, braking: bool) -> Motion2:
    """The desired motion (NE) one tick later, with drag, and with the brake when the sticks are centred."""
    vel = path.vel + loiter.predicted_acc * DT
    acc = loiter.acc
    speed = math.hypot(vel.x, vel.y)
    if speed > 1e-9:
        drag = limits.accel_full * speed / limits.speed_max
        brake = 0.0
        if braking:
            brake = sqrt_controller(speed, limits.brake_gain, limits.brake_jerk, DT)
            brake = constrain(brake, 0.0, limits.brake_accel)
        step_max = limits.brake_jerk * DT
        loiter.brake_acc += constrain(brake - loiter.brake_acc, -step_max, step_max)
        slower = min(max(speed - (drag + loiter.brake_acc) * DT, 0.0), limits.speed_max)
        acc -= vel / speed * loiter.brake_acc
        vel *= slower / speed
    return Motion2(path.pos + vel * DT, vel, acc)


@law
def advance(v: Vehicle) -> None:
    """Move the desired position, velocity and acceleration on by one tick."""
    ap = v.autopilot
    loiter = ap.modes.loiter
    path = ap.control.pos_ne
    if loiter.acc.x != 0.0 or loiter.acc.y != 0.0:
        loiter.brake_us = v.time_us
    braking = v.time_us - loiter.brake_us > ap.params.LOIT.BRK_DELAY * 1e6
    moved = advance_path(loiter, position.desired_motion_ne(path), limits(ap.params), braking)
    position.set_pos_vel_accel_ne(path, moved)


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    yaw_rate = ap.modes.pilot.yaw_rate
    alt_hold.set_limits(ap)
    set_limits(ap)
    lean_max = angle_max(ap.params)
    lean = pilot.lean_angles(ap.modes.pilot, lean_max, min(math.radians(ap.params.ANGLE_MAX * 0.01), lean_max))
    predict_accel(ap.modes.loiter, lean, ap.estimate.euler.yaw, ap.params.ATC)
    climb = alt_hold.climb_rate(ap)
    doing = alt_hold.decide(ap, climb)
    if doing == alt_hold.STOPPED or doing == alt_hold.LANDED_IDLE:
        attitude.reset_yaw_target(ap.control.attitude, ap.estimate.euler.yaw)
    if doing == alt_hold.STOPPED or doing == alt_hold.LANDED_IDLE or doing == alt_hold.LANDED_READY:
        position_start.relax_ne(ap.control, ap.estimate, ap.params)
        ap.modes.loiter.brake_acc = 0.0
        position.update_ne(ap.control, ap.estimate, ap.params)
        attitude.input_euler_roll_pitch_yaw_rate(ap.control, ap.estimate, ap.params, attitude.Lean(0.0, 0.0), yaw_rate)
    else:
        if ap.arming.landed_maybe:
            position_start.soften_for_landing_ne(ap.control.pos_ne, ap.estimate.pos)
        advance(v)
        position.update_ne(ap.control, ap.estimate, ap.params)
        attitude.input_thrust_vector_heading_rate(
            ap.control, ap.estimate, ap.params, position.thrust_vector(ap.control.pos_ne), yaw_rate
        )
    alt_hold.run_vertical(ap, doing, climb)


MODE = CopterMode(
    number=LOITER, name="LOITER", start=start, run=run, standard_mode=1, climb_stick=True, needs_position=True
)
