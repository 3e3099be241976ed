# SPDX-License-Identifier: BSD-3-Clause
"""Geometry of attitude control: errors split into thrust and heading, and Euler rates against body rates."""

from __future__ import annotations

import math
from typing import NamedTuple

from ....core.algebra import multiply, norm, quat_about_down
from ....core.elementary import atan2, sincos
from ....core.kernels import inlined, law
from ....core.scalars import constrain
from ....core.vectors import Euler, Quat, Vec3


class SplitError(NamedTuple):
    """A rotation as a turn of the thrust axis about a horizontal body axis, after a turn about the thrust axis."""

    error: Vec3  # turn of the thrust about x and y, turn of the heading about z [rad]
    thrust_angle: float  # of the thrust turn [rad]
    thrust_turn: Quat  # the thrust turn alone


@inlined
def angle_per_half_sine(s: float, c: float) -> float:
    """Angle / sin(angle / 2) for s = sin(angle / 2) >= 0, c = cos(angle / 2) >= 0; a series while it is small."""
    s2 = s * s
    if s2 < 0.01:
        return 2.0 + s2 * (1.0 / 3.0 + s2 * (0.15 + s2 * (5.0 / 56.0)))
    return 2.0 * atan2(s, c) / s


@inlined
def split_error(q: Quat) -> SplitError:
    """Thrust and heading parts of a rotation. When thrust turns by 180 degrees heading has no meaning: no error."""
    n = math.sqrt(q.w * q.w + q.z * q.z)
    if n < 1e-9:
        s = math.sqrt(q.x * q.x + q.y * q.y)
        k = math.pi / s if s > 0.0 else 0.0
        return SplitError(Vec3(k * q.x, k * q.y, 0.0), math.pi, Quat(0.0, q.x, q.y, 0.0))
    cw, cz = q.w / n, q.z / n
    tx, ty = q.x * cw - q.y * cz, q.x * cz + q.y * cw
    s = math.sqrt(tx * tx + ty * ty)
    k = angle_per_half_sine(s, n)
    if cw < 0.0:
        cw, cz = -cw, -cz
    heading = angle_per_half_sine(abs(cz), cw) * cz
    return SplitError(Vec3(k * tx, k * ty, heading), k * s, Quat(n, tx, ty, 0.0))


@inlined
def thrust_quaternion(thrust: Vec3, heading: float) -> Quat:
    """Attitude whose thrust (body -z) points along the NED vector ``thrust``, with ``heading`` [rad] about it.

    The shortest turn from upright is followed by a turn about the body's z axis. A zero vector means upright.
    """
    n = norm(thrust)
    u = thrust / n if n >= 1e-9 else Vec3(0.0, 0.0, -1.0)
    # Half-way quaternion between up (0, 0, -1) and the vector: (1 + cos, axis * sin), to be normalised.
    w = 1.0 - u.z
    m = math.sqrt(w * w + u.x * u.x + u.y * u.y)
    turn = quat_about_down(heading)
    if m < 1e-6:
        return multiply(Quat(0.0, 1.0, 0.0, 0.0), turn)
    return multiply(Quat(w / m, u.y / m, -u.x / m, 0.0), turn)


@law
def body_rates(euler: Euler, rates: Euler) -> Vec3:
    """Body rates [rad/s] at Euler angles that change with ``rates`` [rad/s]."""
    sr, cr = sincos(euler.roll)
    sp, cp = sincos(euler.pitch)
    return Vec3(
        rates.roll - sp * rates.yaw,
        cr * rates.pitch + sr * cp * rates.yaw,
        cr * cp * rates.yaw - sr * rates.pitch,
    )


@law
def euler_rates(euler: Euler, rates: Vec3) -> Euler:
    """Rates of the Euler angles [rad/s] at body rates; within 1 degree of vertical they are those of 1 degree off."""
    sr, cr = sincos(euler.roll)
    sp, cp = sincos(euler.pitch)
    cp = max(cp, 0.0175)
    yaw_rate = (sr * rates.y + cr * rates.z) / cp
    return Euler(rates.x + sp * yaw_rate, cr * rates.y - sr * rates.z, yaw_rate)


@law
def euler_accel_limits(euler: Euler, limit: Vec3) -> Euler:
    """Accelerations of the Euler angles [rad/s^2] that keep the body's below ``limit``; 0 in one switches it off."""
    if limit.x <= 0.0 or limit.y <= 0.0 or limit.z <= 0.0:
        return Euler(limit.x, limit.y, limit.z)
    sr, cr = sincos(euler.roll)
    sp, cp = sincos(euler.pitch)
    sr, cr = constrain(abs(sr), 0.1, 1.0), constrain(abs(cr), 0.1, 1.0)
    sp, cp = constrain(abs(sp), 0.1, 1.0), constrain(abs(cp), 0.1, 1.0)
    return Euler(
        limit.x,
        min(limit.y / cr, limit.z / sr),
        min(min(limit.x / sp, limit.y / (sr * cp)), limit.z / (cr * cp)),
    )
