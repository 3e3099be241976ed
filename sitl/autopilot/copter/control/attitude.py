# SPDX-License-Identifier: BSD-3-Clause
"""Attitude: from what modes ask for to body-rate targets.

Two steps each tick. *Shaping* moves the target attitude, with limited angular acceleration (ATC_ACCEL_*_MAX) and an
exponential end (ATC_INPUT_TC), towards what was asked; its angular velocity is fed forward (ATC_RATE_FF_ENAB).
*Correction* (``attitude_target.attitude_control``) turns the body to the target. Each ``input_*`` law makes both steps
and is called once a tick. What is asked in numbers that are not finite is ignored: the target comes to
rest where it is.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ....core.algebra import (
    conjugate,
    finite_vector,
    multiply,
    quat_from_euler,
    quat_from_rotation_vector,
    quat_norm_squared,
    tilt_of,
    yaw_of,
)
from ....core.kernels import inlined, law
from ....core.scalars import constrain, finite, wrap_pi
from ....core.vectors import Euler, Quat, Vec3
from ...control.shaping import shape_angle, shape_rate
from ...state import Estimate
from ..parameters import Parameters
from ..parameters.control import Attitude
from . import rate
from .attitude_error import body_rates, euler_accel_limits, euler_rates, split_error, thrust_quaternion
from .attitude_target import (
    CDEG,
    DEG,
    accel_max,
    attitude_control,
    attitude_gains,
    cos_lean,
    limit_rates,
    rate_max,
    set_target,
    turned_by_rate,
)
from .state import DT, AttitudeState, Control


class Lean(NamedTuple):
    """Roll and pitch [rad]."""

    roll: float
    pitch: float


class Heading(NamedTuple):
    """Where the nose shall point, and how fast that turns."""

    angle: float  # [rad]
    rate: float  # [rad/s]
    absolute: bool  # the angle counts; else the rate alone


class Shaping(NamedTuple):
    """How the target attitude may move."""

    enabled: bool  # false: it jumps (ATC_RATE_FF_ENAB)
    time_constant: float  # of the exponential end [s]
    yaw_time_constant: float  # of turn rates [s]
    accel_max: Vec3  # [rad/s^2]; 0: no limit
    rate_max: Vec3  # [rad/s]; 0: no limit


@law
def shape_euler(target: Euler, rate: Vec3, lean: Lean, yaw_rate: float, shaping: Shaping) -> Vec3:
    """Body rates [rad/s] of a target that turns at ``rate``, towards a lean and a turn rate [rad/s]."""
    accel = euler_accel_limits(target, shaping.accel_max)
    rates = euler_rates(target, rate)
    tau = shaping.time_constant
    shaped = Euler(
        shape_angle(wrap_pi(lean.roll - target.roll), rates.roll, tau, accel.roll, DT, 0.0, 0.0),
        shape_angle(wrap_pi(lean.pitch - target.pitch), rates.pitch, tau, accel.pitch, DT, 0.0, 0.0),
        shape_rate(rates.yaw, yaw_rate, accel.yaw, shaping.yaw_time_constant, DT),
    )
    return limit_rates(body_rates(target, shaped), shaping.rate_max)


@inlined
def shape_rotation(error: Vec3, rate: Vec3, rate_ahead: Vec3, shaping: Shaping, yaw_rate_max: float) -> Vec3:
    """Rates [rad/s] of a target towards an attitude ``error`` [rad] away that itself turns at ``rate_ahead``.

    ``yaw_rate_max`` [rad/s] replaces the limit of yaw; 0: it does not.
    """
    tau, accel = shaping.time_constant, shaping.accel_max
    shaped = Vec3(
        shape_angle(error.x, rate.x, tau, accel.x, DT, rate_ahead.x, 0.0),
        shape_angle(error.y, rate.y, tau, accel.y, DT, rate_ahead.y, 0.0),
        shape_angle(error.z, rate.z, tau, accel.z, DT, rate_ahead.z, yaw_rate_max),
    )
    limit = shaping.rate_max
    return limit_rates(shaped, Vec3(limit.x, limit.y, yaw_rate_max if yaw_rate_max > 0.0 else limit.z))


@inlined
def shape_thrust_turn(error: Vec3, rate: Vec3, yaw_rate: float, shaping: Shaping) -> Vec3:
    """Rates [rad/s] of a target whose thrust is ``error`` [rad] away (x, y) while it turns at ``yaw_rate``."""
    tau, accel = shaping.time_constant, shaping.accel_max
    shaped = Vec3(
        shape_angle(error.x, rate.x, tau, accel.x, DT, 0.0, 0.0),
        shape_angle(error.y, rate.y, tau, accel.y, DT, 0.0, 0.0),
        shape_rate(rate.z, yaw_rate, accel.z, shaping.yaw_time_constant, DT),
    )
    return limit_rates(shaped, shaping.rate_max)


@inlined
def shape_rates(rate: Vec3, wanted: Vec3, shaping: Shaping) -> Vec3:
    """Rates [rad/s] of a target that turns at ``rate``, towards the rates ``wanted``."""
    accel = shaping.accel_max
    return Vec3(
        shape_rate(rate.x, wanted.x, accel.x, 0.0, DT),
        shape_rate(rate.y, wanted.y, accel.y, 0.0, DT),
        shape_rate(rate.z, wanted.z, accel.z, shaping.yaw_time_constant, DT),
    )


@inlined
def shaping_limits(p: Parameters) -> Shaping:
    """ATC_RATE_FF_ENAB, ATC_INPUT_TC, PILOT_Y_RATE_TC and the limits of acceleration and rate."""
    return Shaping(p.ATC.RATE_FF_ENAB != 0.0, p.ATC.INPUT_TC, p.PILOT.Y_RATE_TC, accel_max(p.ATC), rate_max(p.ATC))


@inlined
def slew_yaw_max(p: Attitude) -> float:
    """Fastest turn of modes that fly by themselves [rad/s]: ATC_SLEW_YAW, at most ATC_RATE_Y_MAX; 0: no limit."""
    slew, fastest = p.SLEW_YAW * CDEG, p.RATE_Y_MAX * DEG
    return min(slew, fastest) if fastest > 0.0 and slew > 0.0 else slew


@inlined
def limit_turn(rate: float, rate_max: float) -> float:
    """``rate`` within plus and minus ``rate_max``; 0: no limit."""
    return constrain(rate, -rate_max, rate_max) if rate_max > 0.0 else rate


@inlined
def follow_yaw_reset(control: Control, est: Estimate) -> None:
    """When the estimate's heading jumps, the target jumps with it: the vehicle does not turn."""
    attitude = control.attitude
    if attitude.yaw_reset_count == est.reset_yaw_count:
        return
    attitude.yaw_reset_count = est.reset_yaw_count
    if control.tick > 0:
        set_target(attitude, multiply(est.q, attitude.error_q))


@inlined
def advance_target(control: Control, est: Estimate, p: Parameters) -> Shaping:
    """What every input starts with: the target turns on. Returns how it may move."""
    follow_yaw_reset(control, est)
    attitude = control.attitude
    set_target(attitude, turned_by_rate(attitude.target_q, attitude.target_rate, DT))
    return shaping_limits(p)


@inlined
def jump(attitude: AttitudeState, q: Quat, rate: Vec3) -> None:
    """Replace the target and its angular velocity [rad/s]."""
    set_target(attitude, q)
    attitude.target_rate = rate


@inlined
def correct(attitude: AttitudeState, est: Estimate, p: Attitude) -> None:
    """Body-rate targets from the difference between target and estimate."""
    out = attitude_control(est.q, attitude.target_q, attitude.target_rate, est.rates, attitude_gains(p))
    if out.yaw_limited:
        set_target(attitude, out.target)
    attitude.rate_target = out.rate_target
    attitude.error = out.error
    attitude.error_q = out.error_q
    attitude.thrust_error_angle = out.thrust_error_angle
    attitude.cos_lean = cos_lean(est.q)


@law
def hold(attitude: AttitudeState, shaping: Shaping) -> None:
    """Bring the target to rest where it is."""
    rest = Vec3(0.0, 0.0, 0.0)
    rate = attitude.target_rate
    attitude.target_rate = shape_rotation(rest, rate, rest, shaping, 0.0) if shaping.enabled else rest


@law
def input_euler_roll_pitch_yaw_rate(
    control: Control, est: Estimate, p: Parameters, lean: Lean, yaw_rate: float
) -> None:
    """Lean to a roll and a pitch while turning at ``yaw_rate`` [rad/s]."""
    shaping = advance_target(control, est, p)
    attitude = control.attitude
    tilt = tilt_of(attitude.target_q)  # without yaw, which is dear and which shaping does not need
    if not (finite(lean.roll) and finite(lean.pitch) and finite(yaw_rate)):
        lean, yaw_rate = Lean(tilt.roll, tilt.pitch), 0.0
    if shaping.enabled:
        attitude.target_rate = shape_euler(tilt, attitude.target_rate, lean, yaw_rate, shaping)
    else:
        yaw = yaw_of(attitude.target_q) + yaw_rate * DT
        jump(attitude, quat_from_euler(Euler(lean.roll, lean.pitch, yaw)), Vec3(0.0, 0.0, 0.0))
    correct(attitude, est, p.ATC)


@law
def input_thrust_vector_heading(control: Control, est: Estimate, p: Parameters, thrust: Vec3, heading: Heading) -> None:
    """Point thrust along an NED vector and the nose to the angle of ``heading``, which moves at its rate."""
    shaping = advance_target(control, est, p)
    attitude = control.attitude
    if not (finite_vector(thrust) and finite(heading.angle) and finite(heading.rate)):
        hold(attitude, shaping)
    elif shaping.enabled:
        slew = slew_yaw_max(p.ATC)
        ahead = Vec3(0.0, 0.0, limit_turn(heading.rate, slew))
        error = split_error(multiply(conjugate(attitude.target_q), thrust_quaternion(thrust, heading.angle))).error
        attitude.target_rate = shape_rotation(error, attitude.target_rate, ahead, shaping, slew)
    else:
        jump(attitude, thrust_quaternion(thrust, heading.angle), Vec3(0.0, 0.0, 0.0))
    correct(attitude, est, p.ATC)


@law
def input_thrust_vector_heading_rate(
    control: Control, est: Estimate, p: Parameters, thrust: Vec3, heading_rate: float
) -> None:
    """Point thrust along an NED vector while turning about it at ``heading_rate`` [rad/s], ATC_SLEW_YAW or not."""
    shaping = advance_target(control, est, p)
    attitude = control.attitude
    split = split_error(multiply(conjugate(attitude.target_q), thrust_quaternion(thrust, 0.0)))
    if not (finite_vector(thrust) and finite(heading_rate)):
        hold(attitude, shaping)
    elif shaping.enabled:
        attitude.target_rate = shape_thrust_turn(split.error, attitude.target_rate, heading_rate, shaping)
    else:
        q = multiply(attitude.target_q, split.thrust_turn)
        jump(attitude, multiply(q, Quat(1.0, 0.0, 0.0, 0.5 * heading_rate * DT)), Vec3(0.0, 0.0, 0.0))
    correct(attitude, est, p.ATC)


@law
def input_quaternion(control: Control, est: Estimate, p: Parameters, q: Quat, rates: Vec3) -> None:
    """Turn to attitude ``q`` (body to NED), which itself turns at body rates ``rates`` [rad/s]."""
    shaping = advance_target(control, est, p)
    attitude = control.attitude
    n2 = quat_norm_squared(q)
    if not (finite(n2) and finite_vector(rates)) or n2 < 1e-6:
        hold(attitude, shaping)
    elif shaping.enabled:
        error = split_error(multiply(conjugate(attitude.target_q), q / math.sqrt(n2))).error
        attitude.target_rate = shape_rotation(error, attitude.target_rate, rates, shaping, 0.0)
    else:
        jump(attitude, q, rates)
    correct(attitude, est, p.ATC)


@law
def input_rates(control: Control, est: Estimate, p: Parameters, rates: Vec3) -> None:
    """Turn at body rates [rad/s]; the attitude reached on the way is held."""
    shaping = advance_target(control, est, p)
    attitude = control.attitude
    wanted = rates if finite_vector(rates) else Vec3(0.0, 0.0, 0.0)
    if shaping.enabled:
        wanted = shape_rates(attitude.target_rate, wanted, shaping)
    attitude.target_rate = limit_rates(wanted, shaping.rate_max)
    correct(attitude, est, p.ATC)


@law
def relax(control: Control, est: Estimate) -> None:
    """Target := present attitude and rates, integrators zero: nothing pushes while the vehicle stands on the ground."""
    attitude = control.attitude
    jump(attitude, est.q, est.rates)
    attitude.rate_target = est.rates
    attitude.error = Vec3(0.0, 0.0, 0.0)
    attitude.error_q = Quat(1.0, 0.0, 0.0, 0.0)
    attitude.thrust_error_angle = 0.0
    attitude.cos_lean = cos_lean(est.q)
    attitude.yaw_reset_count = est.reset_yaw_count
    rate.reset_filters(control.rate)
    rate.reset_integrators(control.rate)


@law
def reset_yaw_target(attitude: AttitudeState, yaw: float) -> None:
    """Heading target := present heading ``yaw`` [rad], without a turn."""
    turn = wrap_pi(yaw - attitude.target_euler.yaw)
    set_target(attitude, multiply(quat_from_rotation_vector(Vec3(0.0, 0.0, turn)), attitude.target_q))
    rates = euler_rates(attitude.target_euler, attitude.target_rate)
    attitude.target_rate = body_rates(attitude.target_euler, Euler(rates.roll, rates.pitch, 0.0))
