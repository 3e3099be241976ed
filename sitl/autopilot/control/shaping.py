# SPDX-License-Identifier: BSD-3-Clause
"""Square-root controllers and jerk-limited shaping of targets (kinematic input shaping), on a line and in the plane.

The square-root controller is linear near zero and follows the constant-deceleration curve v = sqrt(2 a x)
further out. Shaping laws return the new acceleration; ``advance*`` integrates position and velocity by one
period. Units are the caller's as long as they agree (m, m/s, m/s^2, m/s^3, s; or rad).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ...core.algebra import dot2, limit_length, norm2
from ...core.kernels import inlined, law
from ...core.scalars import constrain, sign
from ...core.vectors import Vec2, Vec3


class Motion(NamedTuple):
    """Of a point on a line."""

    pos: float
    vel: float
    acc: float


class Motion2(NamedTuple):
    """Of a point in the plane."""

    pos: Vec2
    vel: Vec2
    acc: Vec2


class Limits(NamedTuple):
    """Of the shaping on a line; minima are negative."""

    vel_min: float  # both 0: no limit of speed
    vel_max: float
    acc_min: float
    acc_max: float
    jerk_max: float


class Limits2(NamedTuple):
    """Of the shaping in the plane: lengths."""

    vel_max: float  # 0: no limit
    acc_max: float
    jerk_max: float


@inlined
def sqrt_gain(error: float, p: float, accel_max: float) -> float:
    """Correction rate per unit of ``error`` >= 0: p, or less where the rate must stay able to stop.

    ``accel_max`` is the second derivative that may be used, 0: no limit; ``p`` [1/s] 0: the square-root law alone.
    """
    if accel_max <= 0.0:
        return p
    if p <= 0.0:
        return math.sqrt(2.0 * accel_max / error) if error > 1e-12 else 0.0
    linear = accel_max / (p * p)
    if error <= linear:
        return p
    return math.sqrt(2.0 * accel_max * (error - 0.5 * linear)) / error


@inlined
def sqrt_controller(error: float, p: float, accel_max: float, dt: float) -> float:
    """Rate that takes ``error`` to zero; with ``dt`` > 0 it never passes zero within one period."""
    gain = sqrt_gain(abs(error), p, accel_max)
    if dt > 0.0 and gain * dt > 1.0:
        gain = 1.0 / dt
    return error * gain


@inlined
def sqrt_controller_2d(error: Vec2, p: float, accel_max: float, dt: float) -> Vec2:
    """The same along the direction of an error in the plane."""
    gain = sqrt_gain(norm2(error), p, accel_max)
    if dt > 0.0 and gain * dt > 1.0:
        gain = 1.0 / dt
    return error * gain


@inlined
def inverse_sqrt_controller(rate: float, p: float, accel_max: float) -> float:
    """Error at which ``sqrt_controller(error, p, accel_max, 0)`` gives ``rate``: also the distance needed to stop."""
    if accel_max <= 0.0:
        return rate / p if p > 0.0 else 0.0
    if p <= 0.0:
        return sign(rate) * rate * rate / (2.0 * accel_max)
    if abs(rate) <= accel_max / p:
        return rate / p
    return sign(rate) * (0.5 * accel_max / (p * p) + rate * rate / (2.0 * accel_max))


@law
def limit_accel(vel: Vec2, acc: Vec2, acc_max: float) -> Vec2:
    """Acceleration of at most ``acc_max`` (<= 0: no limit); what lies along the velocity is given up first.

    Keeping the part across the velocity keeps the path round a bend; only the speed along it suffers.
    """
    if acc_max <= 0.0 or dot2(acc, acc) <= acc_max * acc_max:
        return acc
    speed = norm2(vel)
    if speed < 1e-9:
        return limit_length(acc, acc_max)
    u = vel / speed
    along = acc.x * u.x + acc.y * u.y
    across = acc.y * u.x - acc.x * u.y
    if abs(across) >= acc_max:
        across = sign(across) * acc_max
        along = 0.0
    else:
        rest = math.sqrt(acc_max * acc_max - across * across)
        along = constrain(along, -rest, rest)
    return Vec2(u.x * along - u.y * across, u.y * along + u.x * across)


@inlined
def shape_accel(target: float, acc: float, jerk_max: float, dt: float) -> float:
    """Acceleration moved towards ``target`` by at most ``jerk_max * dt`` (jerk 0: at once)."""
    if jerk_max <= 0.0:
        return target
    return acc + constrain(target - acc, -jerk_max * dt, jerk_max * dt)


@inlined
def shape_accel_2d(target: Vec2, acc: Vec2, jerk_max: float, dt: float) -> Vec2:
    """The same in the plane."""
    if jerk_max <= 0.0:
        return target
    return acc + limit_length(target - acc, jerk_max * dt)


@inlined
def shape_vel_accel(target_vel: float, target_acc: float, now: Motion, limits: Limits, dt: float) -> float:
    """New acceleration that brings the velocity to ``target_vel``, which itself accelerates with ``target_acc``.

    The limits of acceleration hold for the correction.
    """
    error = target_vel - now.vel
    gain = limits.jerk_max / (limits.acc_max if error > 0.0 else -limits.acc_min)
    wanted = constrain(sqrt_controller(error, gain, limits.jerk_max, dt), limits.acc_min, limits.acc_max)
    return shape_accel(wanted + target_acc, now.acc, limits.jerk_max, dt)


@inlined
def shape_vel_accel_2d(target_vel: Vec2, target_acc: Vec2, now: Motion2, limits: Limits2, dt: float) -> Vec2:
    """The same in the plane: one limit for the length of the correction, so that velocities change along a line."""
    wanted = sqrt_controller_2d(target_vel - now.vel, limits.jerk_max / limits.acc_max, limits.jerk_max, dt)
    wanted = limit_length(wanted, limits.acc_max)
    return shape_accel_2d(wanted + target_acc, now.acc, limits.jerk_max, dt)


@inlined
def shape_pos_vel_accel(target: Motion, now: Motion, limits: Limits, dt: float) -> float:
    """New acceleration that brings a point onto a moving one.

    Half of the acceleration shapes the approach; the other half is left for the jerk limit and for corrections.
    The limits of speed hold for the correction.
    """
    error = target.pos - now.pos
    braking = -limits.acc_min if error > 0.0 else limits.acc_max
    vel = sqrt_controller(error, 0.5 * limits.jerk_max / braking, 0.5 * braking, dt)
    if limits.vel_min < 0.0 or limits.vel_max > 0.0:
        vel = constrain(vel, limits.vel_min, limits.vel_max)
    return shape_vel_accel(vel + target.vel, target.acc, now, limits, dt)


@inlined
def shape_pos_vel_accel_2d(target: Motion2, now: Motion2, limits: Limits2, dt: float) -> Vec2:
    """The same in the plane."""
    p = 0.5 * limits.jerk_max / limits.acc_max
    vel = sqrt_controller_2d(target.pos - now.pos, p, 0.5 * limits.acc_max, dt)
    if limits.vel_max > 0.0:
        vel = limit_length(vel, limits.vel_max)
    return shape_vel_accel_2d(vel + target.vel, target.acc, now, limits, dt)


@inlined
def advance(now: Motion, dt: float, limit: float, pos_error: float, vel_error: float) -> Motion:
    """The motion after ``dt`` at constant acceleration.

    ``limit`` (-1, 0, 1) is the direction in which the actuators are used up: a target that already runs ahead
    in that direction waits.
    """
    dp = now.vel * dt + 0.5 * now.acc * dt * dt
    if dp * limit > 0.0 and pos_error * limit > 0.0:
        dp = 0.0
    dv = now.acc * dt
    if dv * limit > 0.0 and vel_error * limit > 0.0:
        dv = 0.0
    return Motion(now.pos + dp, now.vel + dv, now.acc)


@inlined
def advance_2d(now: Motion2, dt: float, limit: Vec2, pos_error: Vec2, vel_error: Vec2) -> Motion2:
    """The same in the plane; ``limit`` points where the actuators are used up, zero when they are not."""
    dp = now.vel * dt + 0.5 * now.acc * dt * dt
    if dot2(dp, limit) > 0.0 and dot2(pos_error, limit) > 0.0:
        dp = Vec2(0.0, 0.0)
    dv = now.acc * dt
    if dot2(dv, limit) > 0.0 and dot2(vel_error, limit) > 0.0 and dot2(now.vel, limit) >= 0.0:
        dv = Vec2(0.0, 0.0)
    return Motion2(now.pos + dp, now.vel + dv, now.acc)


@inlined
def shape_rate(rate: float, desired: float, accel_max: float, time_constant: float, dt: float) -> float:
    """Angular velocity moved towards ``desired``: exponentially if a time constant is given, at most ``accel_max``."""
    if time_constant > 0.0:
        desired = rate + (desired - rate) * min(dt / max(time_constant, 0.01), 1.0)
    if accel_max > 0.0:
        desired = constrain(desired, rate - accel_max * dt, rate + accel_max * dt)
    return desired


@inlined
def shape_angle(
    error: float, rate: float, time_constant: float, accel_max: float, dt: float, rate_ahead: float, rate_max: float
) -> float:
    """New angular velocity [rad/s] of a target ``error`` [rad] away, ending in an exponential decay.

    ``rate_ahead`` is the speed of the goal itself; ``rate_max`` <= 0 means no limit (ATC_INPUT_TC, ATC_ACCEL_*_MAX).
    """
    desired = rate_ahead + sqrt_controller(error, 1.0 / max(time_constant, 0.01), accel_max, dt)
    if rate_max > 0.0:
        desired = constrain(desired, -rate_max, rate_max)
    return shape_rate(rate, desired, accel_max, 0.0, dt)


@law
def kinematic_limit(direction: Vec3, horizontal_max: float, up_max: float, down_max: float) -> float:
    """Length of the longest vector along a unit vector (z down) within horizontal and vertical limits."""
    horizontal = math.sqrt(direction.x * direction.x + direction.y * direction.y)
    longest = 1e9
    if horizontal > 1e-9:
        longest = horizontal_max / horizontal
    if direction.z > 1e-9:
        longest = min(longest, down_max / direction.z)
    elif direction.z < -1e-9:
        longest = min(longest, up_max / -direction.z)
    return longest
