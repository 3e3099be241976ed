# SPDX-License-Identifier: BSD-3-Clause
"""Geometry of attitude control: errors split into thrust and heading, and Euler rates against body rates."""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.rotations import quat_multiply
from ....core.scalars import constrain


@law
def angle_per_half_sine(s, c):
    """Angle / sin(angle / 2) for s = sin(angle / 2) >= 0 and c = cos(angle / 2) >= 0; a series while it is
    small.
    """
    s2 = s * s
    if s2 < 0.01:
        return 2.0 + s2 * (1.0 / 3.0 + s2 * (0.15 + s2 * (5.0 / 56.0)))
    return 2.0 * math.atan2(s, c) / s


@law
def split_error(w, x, y, z):
    """Rotation (w, x, y, z) as a turn of the thrust axis about a horizontal body axis, after a turn about it.

    Returns the error (about x, about y, heading) [rad], the angle of the thrust turn [rad] and its
    quaternion's (w, x, y); z is zero. When thrust must turn by 180 degrees heading has no meaning and its
    error is zero.
    """
    n = math.sqrt(w * w + z * z)
    if n < 1e-9:
        s = math.sqrt(x * x + y * y)
        k = math.pi / s if s > 0.0 else 0.0
        return (k * x, k * y, 0.0, math.pi, 0.0, x, y)
    cw, cz = w / n, z / n
    tx, ty = x * cw - y * cz, x * cz + y * cw
    s = math.sqrt(tx * tx + ty * ty)
    k = angle_per_half_sine(s, n)
    if cw < 0.0:
        cw, cz = -cw, -cz
    heading = angle_per_half_sine(abs(cz), cw) * cz
    return (k * tx, k * ty, heading, k * s, n, tx, ty)


@law
def thrust_quaternion(x, y, z, heading):
    """Attitude whose thrust (body -z) points along the NED vector (x, y, z), with ``heading`` [rad] about it.

    The shortest turn from upright is followed by a turn about the body's z axis. A zero vector means upright.
    """
    n = math.sqrt(x * x + y * y + z * z)
    if n < 1e-9:
        x, y, z, n = 0.0, 0.0, -1.0, 1.0
    x, y, z = x / n, y / n, z / n
    # Half-way quaternion between up (0, 0, -1) and the vector: (1 + cos, axis * sin), to be normalised.
    w = 1.0 - z
    m = math.sqrt(w * w + x * x + y * y)
    c, s = math.cos(0.5 * heading), math.sin(0.5 * heading)
    if m < 1e-6:
        return quat_multiply(0.0, 1.0, 0.0, 0.0, c, 0.0, 0.0, s)
    return quat_multiply(w / m, y / m, -x / m, 0.0, c, 0.0, 0.0, s)


@law
def body_rates(roll, pitch, roll_rate, pitch_rate, yaw_rate):
    """(p, q, r) [rad/s] at Euler angles that change with the given rates."""
    sr, cr, sp, cp = math.sin(roll), math.cos(roll), math.sin(pitch), math.cos(pitch)
    return (
        roll_rate - sp * yaw_rate,
        cr * pitch_rate + sr * cp * yaw_rate,
        cr * cp * yaw_rate - sr * pitch_rate,
    )


@law
def euler_rates(roll, pitch, p, q, r):
    """Rates of the Euler angles [rad/s]; within 1 degree of vertical they are those of 1 degree off."""
    sr, cr, sp, cp = math.sin(roll), math.cos(roll), math.sin(pitch), math.cos(pitch)
    cp = max(cp, 0.0175)
    yaw_rate = (sr * q + cr * r) / cp
    return (p + sp * yaw_rate, cr * q - sr * r, yaw_rate)


@law
def euler_accel_limits(roll, pitch, ax, ay, az):
    """Accelerations of the Euler angles [rad/s^2] that keep the body's below (ax, ay, az); 0 in one switches
    it off.
    """
    if ax <= 0.0 or ay <= 0.0 or az <= 0.0:
        return (ax, ay, az)
    sr, cr = constrain(abs(math.sin(roll)), 0.1, 1.0), constrain(abs(math.cos(roll)), 0.1, 1.0)
    sp, cp = constrain(abs(math.sin(pitch)), 0.1, 1.0), constrain(abs(math.cos(pitch)), 0.1, 1.0)
    return (ax, min(ay / cr, az / sr), min(min(ax / sp, ay / (sr * cp)), az / (cr * cp)))
