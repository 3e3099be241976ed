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
from ....core.constants import GRAVITY
from ....core.elementary import hypot, tan
from ....core.kernels import law
from ....core.scalars import constrain, wrap_pi
from ....core.vectors import Euler, Vec2
from ...avoidance.limit import is_active
from ...control.shaping import Motion2, shape_angle, sqrt_controller
from ...modes import ModeResult
from ...state import Estimate
from .. import avoidance, pilot
from ..control import attitude, position, position_start
from ..control.state import DT, Control, PositionState
from ..parameters import Parameters
from ..parameters.control import Attitude
from ..state import Autopilot, Vehicle
from . import alt_hold
from .mode import CopterMode
from .precision_land import target_motion
from .state import LoiterState

LOITER = 5

_CDEG = math.pi / 18000.0
_LEAN_SHARE = 2.0 / 3.0
"""LOIT_ANG_MAX 0: so much of the lean limit is the pilot's."""
COORDINATED_TURN = 1
"""LOIT_OPTIONS"""
_SPEED_MIN = 0.2  # [m/s]
_RESTS = 0.5
"""Least acceleration asked for by sticks [m/s^2] that takes the vehicle away from a landing target."""


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
        GRAVITY * tan(angle_max(p)),
        0.5 * p.PSC.VELXY.P,
        p.LOIT.BRK_ACCEL * 0.01,
        p.LOIT.BRK_JERK * 0.01,
    )


@law
def start(v: Vehicle) -> int:
    """Enter from the present motion."""
    ap = v.autopilot
    control, est, p = ap.control, ap.estimate, ap.params
    set_limits(control.pos_ne, p)
    if not position_start.is_active_ne(control):
        position_start.init_ne(control, est, p)
    start_prediction(ap.modes.loiter, control.attitude.target_euler, est.yaw)
    ap.modes.loiter.brake_us = v.time_us
    alt_hold.start_vertical(ap.modes.takeoff, control, est, p)
    return ModeResult.ACCEPTED


@law
def start_prediction(loiter: LoiterState, lean: Euler, yaw: float) -> None:
    """The sticks' lean starts from that of the attitude controller [rad]; nothing brakes."""
    loiter.predicted_euler = Vec2(lean.roll, lean.pitch)
    loiter.predicted_acc = position_start.lean_accel(lean.roll, lean.pitch, yaw)
    loiter.predicted_rate = ZERO2
    loiter.brake_acc = 0.0


@law
def set_limits(path: PositionState, p: Parameters) -> None:
    """Limits of the position correction: LOIT_SPEED, LOIT_ACC_MAX."""
    position_start.set_max_speed_accel_ne(path, p, max(p.LOIT.SPEED * 0.01, _SPEED_MIN), p.LOIT.ACC_MAX * 0.01)


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
def turn_with_heading(loiter: LoiterState, vel: Vec2, turn_rate: float) -> None:
    """The velocity [m/s] turns as fast as the heading's target [rad/s] (LOIT_OPTIONS, coordinated turn)."""
    across = Vec2(-vel.y, vel.x) * turn_rate
    loiter.acc += across
    loiter.predicted_acc += across


@law
def advance_path(loiter: LoiterState, path: Motion2, limits: Limits, braking: bool) -> Motion2:
    """The desired motion (NE) one tick later, with drag, and with the brake when the sticks are centred."""
    vel = path.vel + loiter.predicted_acc * DT
    acc = loiter.acc
    speed = hypot(vel.x, vel.y)
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
def kept_away(path: Motion2, moved: Motion2, vel: Vec2) -> Motion2:
    """The desired motion one tick after ``path``, with a velocity that avoids something in place of its own."""
    return Motion2(path.pos + vel * DT, vel, moved.acc)


@law
def is_braking(loiter: LoiterState, time_us: int, delay: float) -> bool:
    """Whether the sticks have been centred for a delay [s]."""
    if loiter.acc.x != 0.0 or loiter.acc.y != 0.0:
        loiter.brake_us = time_us
    return time_us - loiter.brake_us > delay * 1e6


@law
def stand(loiter: LoiterState, yaw_rate: float, control: Control, est: Estimate, p: Parameters) -> None:
    """Horizontal part of one tick on the ground, turning at ``yaw_rate`` [rad/s]."""
    position_start.relax_ne(control, est, p)
    loiter.brake_acc = 0.0
    position.update_ne(control, est, p)
    attitude.input_euler_roll_pitch_yaw_rate(control, est, p, attitude.Lean(0.0, 0.0), yaw_rate)


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    modes, control, est, p = ap.modes, ap.control, ap.estimate, ap.params
    loiter, yaw_rate = modes.loiter, modes.pilot.yaw_rate
    alt_hold.set_limits(control.pos_d, p)
    set_limits(control.pos_ne, p)
    lean_max = angle_max(p)
    lean = pilot.lean_angles(modes.pilot, lean_max, min(math.radians(p.ANGLE_MAX * 0.01), lean_max))
    predict_accel(loiter, lean, est.yaw, p.ATC)
    if int(p.LOIT.OPTIONS) & COORDINATED_TURN:
        vel = position.desired_motion_ne(control.pos_ne).vel
        turn_with_heading(loiter, vel, control.attitude.target_rate.z)
    climb = alt_hold.climb_rate(modes, ap.rc, control.pos_d, p)
    doing = alt_hold.decide(ap.arming, modes.takeoff, control.motors, climb)
    if doing == alt_hold.STOPPED or doing == alt_hold.LANDED_IDLE:
        attitude.reset_yaw_target(control.attitude, est.yaw)
    if doing == alt_hold.STOPPED or doing == alt_hold.LANDED_IDLE or doing == alt_hold.LANDED_READY:
        stand(loiter, yaw_rate, control, est, p)
    else:
        if ap.arming.landed_maybe:
            position_start.soften_for_landing_ne(control.pos_ne, est.pos)
        if hover_over_target(ap):
            position.input_pos_vel_accel_ne(control.pos_ne, target_motion(ap.landing_target, est, p.PLND))
        else:
            fly_by_sticks(v)
        position.update_ne(control, est, p)
        attitude.input_thrust_vector_heading_rate(control, est, p, position.thrust_vector(control.pos_ne), yaw_rate)
    climb = alt_hold.kept_below(v, doing, climb)
    alt_hold.run_vertical(doing, climb, ap.arming, modes.takeoff, control, est, p)


@law
def fly_by_sticks(v: Vehicle) -> None:
    """Horizontal target of one tick in the air, as the sticks ask."""
    ap = v.autopilot
    loiter, path = ap.modes.loiter, position.desired_motion_ne(ap.control.pos_ne)
    braking = is_braking(loiter, v.time_us, ap.params.LOIT.BRK_DELAY)
    moved = advance_path(loiter, path, limits(ap.params), braking)
    if is_active(ap.avoid):
        moved = kept_away(path, moved, avoidance.limit_velocity(v, moved.vel))
    position.set_pos_vel_accel_ne(ap.control.pos_ne, moved)


@law
def hover_over_target(ap: Autopilot) -> bool:
    """Whether it holds over a landing target: a switch allows it, the sticks rest, and the target is seen."""
    loiter, was_there = ap.modes.loiter, ap.modes.loiter.on_target
    if not loiter.seeks_target and not was_there:
        return False
    rests = loiter.acc.x * loiter.acc.x + loiter.acc.y * loiter.acc.y < _RESTS * _RESTS
    loiter.on_target = loiter.seeks_target and rests and ap.landing_target.acquired and not ap.arming.landed_maybe
    if was_there and not loiter.on_target:
        loiter.predicted_acc, loiter.brake_acc = ZERO2, 0.0
    return loiter.on_target


MODE = CopterMode(
    number=LOITER, name="LOITER", start=start, run=run, standard_mode=1, climb_stick=True, needs_position=True
)
