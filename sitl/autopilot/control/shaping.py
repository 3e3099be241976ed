# SPDX-License-Identifier: BSD-3-Clause
"""Square-root controllers and jerk-limited shaping of targets (kinematic input shaping), in one and two
dimensions.

The square-root controller is linear near zero and follows the constant-deceleration curve v = sqrt(2 a x)
further out. Shaping laws return the new acceleration; ``advance*`` integrates position and velocity by one
period. Units are the caller's as long as they agree (m, m/s, m/s^2, m/s^3, s; or rad).
"""

from __future__ import annotations

import math

from ...core.kernels import law
from ...core.scalars import constrain, sign


@law
def sqrt_gain(error, p, limit):
    """Correction rate per unit of ``error`` >= 0: p, or less where the rate must stay able to stop within
    ``limit``.

    ``limit`` is the second derivative that may be used, 0 for none; ``p`` [1/s] is 0 for the square-root law
    alone.
    """
    if limit <= 0.0:
        return p
    if p <= 0.0:
        return math.sqrt(2.0 * limit / error) if error > 1e-12 else 0.0
    linear = limit / (p * p)
    if error <= linear:
        return p
    return math.sqrt(2.0 * limit * (error - 0.5 * linear)) / error


@law
def sqrt_controller(error, p, limit, dt):
    """Rate that takes ``error`` to zero; with ``dt`` > 0 it never passes zero within one period."""
    size = abs(error)
    gain = sqrt_gain(size, p, limit)
    if dt > 0.0 and gain * dt > 1.0:
        gain = 1.0 / dt
    return error * gain


@law
def sqrt_controller_2d(ex, ey, p, limit, dt):
    """The same along the direction of a two-dimensional error."""
    gain = sqrt_gain(math.sqrt(ex * ex + ey * ey), p, limit)
    if dt > 0.0 and gain * dt > 1.0:
        gain = 1.0 / dt
    return (ex * gain, ey * gain)


@law
def inverse_sqrt_controller(rate, p, limit):
    """Error at which ``sqrt_controller(error, p, limit, 0)`` gives ``rate``: also the distance needed to
    stop.
    """
    if limit <= 0.0:
        return rate / p if p > 0.0 else 0.0
    if p <= 0.0:
        return sign(rate) * rate * rate / (2.0 * limit)
    if abs(rate) <= limit / p:
        return rate / p
    return sign(rate) * (0.5 * limit / (p * p) + rate * rate / (2.0 * limit))


@law
def limit_length(x, y, most):
    """(x, y) shortened to length ``most``."""
    n2 = x * x + y * y
    if n2 <= most * most:
        return (x, y)
    k = most / math.sqrt(n2)
    return (x * k, y * k)


@law
def limit_accel(vx, vy, ax, ay, most):
    """Acceleration limited to length ``most`` (<= 0: not at all), giving up what lies along the velocity
    first.

    Keeping the part across the velocity keeps the path round a bend; only the speed along it suffers.
    """
    if most <= 0.0 or ax * ax + ay * ay <= most * most:
        return (ax, ay)
    speed = math.sqrt(vx * vx + vy * vy)
    if speed < 1e-9:
        return limit_length(ax, ay, most)
    ux, uy = vx / speed, vy / speed
    along = ax * ux + ay * uy
    across = ay * ux - ax * uy
    if abs(across) >= most:
        across = sign(across) * most
        along = 0.0
    else:
        room = math.sqrt(most * most - across * across)
        along = constrain(along, -room, room)
    return (ux * along - uy * across, uy * along + ux * across)


@law
def limit_accel_braking(vx, vy, ax, ay, most):
    """The same, but what slows down comes first: for shaped targets.

    A point that passes its goal at speed then brakes, where ``limit_accel`` would circle it for ever.
    """
    speed = math.sqrt(vx * vx + vy * vy)
    if most <= 0.0 or ax * ax + ay * ay <= most * most or speed < 1e-9:
        return limit_accel(vx, vy, ax, ay, most)
    ux, uy = vx / speed, vy / speed
    along = ax * ux + ay * uy
    if along >= 0.0:
        return limit_accel(vx, vy, ax, ay, most)
    along = max(along, -most)
    room = math.sqrt(max(most * most - along * along, 0.0))
    across = constrain(ay * ux - ax * uy, -room, room)
    return (ux * along - uy * across, uy * along + ux * across)


@law
def shape_accel(target, accel, jerk, dt):
    """Acceleration moved towards ``target`` by at most ``jerk * dt`` (jerk 0: at once)."""
    if jerk <= 0.0:
        return target
    return accel + constrain(target - accel, -jerk * dt, jerk * dt)


@law
def shape_accel_2d(tx, ty, ax, ay, jerk, dt):
    """The same for a two-dimensional acceleration."""
    if jerk <= 0.0:
        return (tx, ty)
    dx, dy = limit_length(tx - ax, ty - ay, jerk * dt)
    return (ax + dx, ay + dy)


@law
def shape_vel_accel(v_in, a_in, v, a, a_min, a_max, jerk, dt, limit_total):
    """New acceleration that brings velocity ``v`` to ``v_in`` (which itself accelerates with ``a_in``).

    ``a_min`` < 0 < ``a_max`` limit the correction, and the whole as well when ``limit_total`` != 0.
    """
    error = v_in - v
    gain = jerk / (a_max if error > 0.0 else -a_min)
    target = constrain(sqrt_controller(error, gain, jerk, dt), a_min, a_max) + a_in
    if limit_total != 0:
        target = constrain(target, a_min, a_max)
    return shape_accel(target, a, jerk, dt)


@law
def shape_vel_accel_2d(vx_in, vy_in, ax_in, ay_in, vx, vy, ax, ay, a_max, jerk, dt, limit_total):
    """The same horizontally: one limit for the length of the acceleration, of which braking takes its part first."""
    tx, ty = sqrt_controller_2d(vx_in - vx, vy_in - vy, jerk / a_max, jerk, dt)
    tx, ty = limit_accel_braking(vx, vy, tx, ty, a_max)
    tx, ty = tx + ax_in, ty + ay_in
    if limit_total != 0:
        tx, ty = limit_accel_braking(vx, vy, tx, ty, a_max)
    return shape_accel_2d(tx, ty, ax, ay, jerk, dt)


@law
def shape_pos_vel_accel(p_in, v_in, a_in, p, v, a, v_min, v_max, a_min, a_max, jerk, dt, limit_total):
    """New acceleration that brings position ``p`` onto the moving point (p_in, v_in, a_in).

    Half of the acceleration shapes the approach; the other half is left for the jerk limit and for
    corrections. ``v_min`` <= 0 <= ``v_max`` limit the speed of the correction (both 0: no limit), and the
    whole speed as well when ``limit_total`` != 0.
    """
    error = p_in - p
    braking = -a_min if error > 0.0 else a_max
    target = sqrt_controller(error, 0.5 * jerk / braking, 0.5 * braking, dt)
    limited = v_min < 0.0 or v_max > 0.0
    if limited:
        target = constrain(target, v_min, v_max)
    target += v_in
    if limited and limit_total != 0:
        target = constrain(target, v_min, v_max)
    return shape_vel_accel(target, a_in, v, a, a_min, a_max, jerk, dt, limit_total)


@law
def shape_pos_vel_accel_2d(
    px_in, py_in, vx_in, vy_in, ax_in, ay_in, px, py, vx, vy, ax, ay, v_max, a_max, jerk, dt, limit_total
):
    """The same horizontally."""
    tx, ty = sqrt_controller_2d(px_in - px, py_in - py, 0.5 * jerk / a_max, 0.5 * a_max, dt)
    if v_max > 0.0:
        tx, ty = limit_length(tx, ty, v_max)
    tx, ty = tx + vx_in, ty + vy_in
    if v_max > 0.0 and limit_total != 0:
        tx, ty = limit_length(tx, ty, v_max)
    return shape_vel_accel_2d(tx, ty, ax_in, ay_in, vx, vy, ax, ay, a_max, jerk, dt, limit_total)


@law
def advance(p, v, a, dt, limit, p_error, v_error):
    """(position, velocity) after ``dt`` at constant acceleration.

    ``limit`` (-1, 0, 1) is the direction in which the actuators are used up: a target that already runs ahead
    in that direction waits.
    """
    dp = v * dt + 0.5 * a * dt * dt
    if dp * limit > 0.0 and p_error * limit > 0.0:
        dp = 0.0
    dv = a * dt
    if dv * limit > 0.0 and v_error * limit > 0.0:
        dv = 0.0
    return (p + dp, v + dv)


@law
def advance_2d(px, py, vx, vy, ax, ay, dt, lx, ly, pex, pey, vex, vey):
    """(px, py, vx, vy) after ``dt``; (lx, ly) points where the lean is used up, (0, 0) when it is not."""
    dpx, dpy = vx * dt + 0.5 * ax * dt * dt, vy * dt + 0.5 * ay * dt * dt
    if dpx * lx + dpy * ly > 0.0 and pex * lx + pey * ly > 0.0:
        dpx, dpy = 0.0, 0.0
    dvx, dvy = ax * dt, ay * dt
    if dvx * lx + dvy * ly > 0.0 and vex * lx + vey * ly > 0.0 and vx * lx + vy * ly >= 0.0:
        dvx, dvy = 0.0, 0.0
    return (px + dpx, py + dpy, vx + dvx, vy + dvy)


@law
def shape_rate(rate, desired, accel_max, time_constant, dt):
    """Angular velocity moved towards ``desired``: exponentially if a time constant is given, at most
    ``accel_max``.
    """
    if time_constant > 0.0:
        desired = rate + (desired - rate) * min(dt / max(time_constant, 0.01), 1.0)
    if accel_max > 0.0:
        desired = constrain(desired, rate - accel_max * dt, rate + accel_max * dt)
    return desired


@law
def shape_angle(error, time_constant, accel_max, rate, rate_ahead, rate_max, dt):
    """New angular velocity [rad/s] of a target ``error`` [rad] away, ending in an exponential decay.

    ``rate_ahead`` is the speed of the goal itself; ``rate_max`` <= 0 means no limit (ATC_INPUT_TC,
    ATC_ACCEL_*_MAX).
    """
    desired = rate_ahead + sqrt_controller(error, 1.0 / max(time_constant, 0.01), accel_max, dt)
    if rate_max > 0.0:
        desired = constrain(desired, -rate_max, rate_max)
    return shape_rate(rate, desired, accel_max, 0.0, dt)


@law
def kinematic_limit(x, y, z, most_xy, most_up, most_down):
    """Length of the longest vector along the unit vector (x, y, z; z down) within horizontal and vertical
    limits.
    """
    horizontal = math.sqrt(x * x + y * y)
    most = 1e9
    if horizontal > 1e-9:
        most = most_xy / horizontal
    if z > 1e-9:
        most = min(most, most_down / z)
    elif z < -1e-9:
        most = min(most, most_up / -z)
    return most
