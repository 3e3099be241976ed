# SPDX-License-Identifier: BSD-3-Clause
"""Rotations: Hamilton quaternions (w, x, y, z), body (FRD) to NED, and Euler angles (roll, pitch, yaw; Z-Y-X, radians).

Quaternions and vectors are tuples of floats: a law takes components and returns components, so nothing is allocated.
"""

from __future__ import annotations

import math

from .kernels import law


@law
def quat_multiply(aw, ax, ay, az, bw, bx, by, bz):
    """Hamilton product a * b: first rotate by b, then by a."""
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )


@law
def quat_normalise(w, x, y, z):
    """Unit quaternion; the identity for a zero one."""
    n = math.sqrt(w * w + x * x + y * y + z * z)
    if n < 1e-12:
        return (1.0, 0.0, 0.0, 0.0)
    return (w / n, x / n, y / n, z / n)


@law
def quat_rotate(w, x, y, z, vx, vy, vz):
    """Vector from body to NED."""
    tx = 2.0 * (y * vz - z * vy)
    ty = 2.0 * (z * vx - x * vz)
    tz = 2.0 * (x * vy - y * vx)
    return (
        vx + w * tx + y * tz - z * ty,
        vy + w * ty + z * tx - x * tz,
        vz + w * tz + x * ty - y * tx,
    )


@law
def quat_rotate_inverse(w, x, y, z, vx, vy, vz):
    """Vector from NED to body."""
    return quat_rotate(w, -x, -y, -z, vx, vy, vz)


@law
def quat_from_rotation_vector(rx, ry, rz):
    """Quaternion of a rotation by |r| radians about r."""
    angle = math.sqrt(rx * rx + ry * ry + rz * rz)
    if angle < 1e-9:
        return quat_normalise(1.0, 0.5 * rx, 0.5 * ry, 0.5 * rz)
    s = math.sin(0.5 * angle) / angle
    return (math.cos(0.5 * angle), s * rx, s * ry, s * rz)


@law
def quat_from_euler(roll, pitch, yaw):
    """Quaternion of Z-Y-X Euler angles [rad]."""
    cr, sr = math.cos(0.5 * roll), math.sin(0.5 * roll)
    cp, sp = math.cos(0.5 * pitch), math.sin(0.5 * pitch)
    cy, sy = math.cos(0.5 * yaw), math.sin(0.5 * yaw)
    return (
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    )


@law
def quat_to_euler(w, x, y, z):
    """(roll, pitch, yaw) [rad], pitch in [-pi/2, pi/2]."""
    s = 2.0 * (w * y - z * x)
    if s > 1.0:
        s = 1.0
    elif s < -1.0:
        s = -1.0
    return (
        math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)),
        math.asin(s),
        math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)),
    )
