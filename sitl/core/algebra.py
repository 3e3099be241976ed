# SPDX-License-Identifier: BSD-3-Clause
"""Laws on vectors, quaternions and Euler angles.

Hamilton quaternions (w, x, y, z) turn body (FRD) into NED; Euler angles are roll, pitch, yaw (Z-Y-X), in radians. Sums
are taken in the order of the components.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from .elementary import asin, atan2, sincos
from .kernels import inlined, law
from .records import Floats
from .scalars import constrain
from .vectors import Euler, Quat, Vec2, Vec3

IDENTITY = Quat(1.0, 0.0, 0.0, 0.0)
ZERO2 = Vec2(0.0, 0.0)
ZERO = Vec3(0.0, 0.0, 0.0)


@inlined
def dot(a: Vec3, b: Vec3) -> float:
    """Scalar product, in the product of the vectors' units."""
    return a.x * b.x + a.y * b.y + a.z * b.z


@inlined
def cross(a: Vec3, b: Vec3) -> Vec3:
    """Vector product, in the product of the vectors' units and in their frame."""
    return Vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)


@inlined
def norm(v: Vec3) -> float:
    """Length, in the vector's unit."""
    return math.sqrt(v.x * v.x + v.y * v.y + v.z * v.z)


@inlined
def by_component(a: Vec3, b: Vec3) -> Vec3:
    """Product of each component with the other's."""
    return Vec3(a.x * b.x, a.y * b.y, a.z * b.z)


@inlined
def limit_components(v: Vec3, limit: float) -> Vec3:
    """Each component limited to [-limit, limit]."""
    return Vec3(constrain(v.x, -limit, limit), constrain(v.y, -limit, limit), constrain(v.z, -limit, limit))


@inlined
def vector_at(numbers: Floats, first: int) -> Vec3:
    """Three numbers of an array, from ``first`` on."""
    return Vec3(numbers[first], numbers[first + 1], numbers[first + 2])


@inlined
def row_vector(rows: Floats, k: int) -> Vec3:
    """Row ``k`` of an array of shape (rows, 3)."""
    return Vec3(rows[k, 0], rows[k, 1], rows[k, 2])


@inlined
def set_row_vector(rows: Floats, k: int, v: Vec3) -> None:
    """Write row ``k`` of an array of three columns."""
    rows[k, 0], rows[k, 1], rows[k, 2] = v.x, v.y, v.z


@inlined
def finite_vector(v: Vec3) -> bool:
    """Whether all components are finite."""
    return v.x - v.x == 0.0 and v.y - v.y == 0.0 and v.z - v.z == 0.0


@inlined
def finite2(v: Vec2) -> bool:
    """Whether both components are finite."""
    return v.x - v.x == 0.0 and v.y - v.y == 0.0


@inlined
def horizontal(v: Vec3) -> Vec2:
    """North and east of an NED vector."""
    return Vec2(v.x, v.y)


@inlined
def with_down(v: Vec2, down: float) -> Vec3:
    """An NED vector from north and east, and down."""
    return Vec3(v.x, v.y, down)


@inlined
def dot2(a: Vec2, b: Vec2) -> float:
    """Scalar product in the plane, in the product of the vectors' units."""
    return a.x * b.x + a.y * b.y


@inlined
def cross2(a: Vec2, b: Vec2) -> float:
    """Vector product in the plane: positive when ``b`` lies clockwise of ``a``, seen from above (NED)."""
    return a.x * b.y - a.y * b.x


@inlined
def norm2(v: Vec2) -> float:
    """Length in the plane, in the vector's unit."""
    return math.sqrt(v.x * v.x + v.y * v.y)


@law
def direction(angle: float) -> Vec2:
    """Unit vector ``angle`` [rad] from north towards east."""
    sine, cosine = sincos(angle)
    return Vec2(cosine, sine)


@inlined
def turned(v: Vec2, angle: float) -> Vec2:
    """``v`` turned by ``angle`` [rad] from north towards east."""
    s, c = sincos(angle)
    return Vec2(v.x * c - v.y * s, v.x * s + v.y * c)


@inlined
def limit_length(v: Vec2, length_max: float) -> Vec2:
    """``v`` shortened to at most ``length_max``, in its unit and frame."""
    n2 = v.x * v.x + v.y * v.y
    if n2 <= length_max * length_max:
        return v
    return v * (length_max / math.sqrt(n2))


@inlined
def multiply(a: Quat, b: Quat) -> Quat:
    """Hamilton product a b of quaternions: first the rotation b, then a."""
    return Quat(
        a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
        a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
        a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
        a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
    )


@inlined
def conjugate(q: Quat) -> Quat:
    """The opposite rotation of a unit quaternion."""
    return Quat(q.w, -q.x, -q.y, -q.z)


@inlined
def quat_norm_squared(q: Quat) -> float:
    """Square of the length of a quaternion; 1 for a rotation."""
    return q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z


@inlined
def normalise(q: Quat) -> Quat:
    """Unit quaternion; the identity for a zero one."""
    n = math.sqrt(quat_norm_squared(q))
    if n < 1e-12:
        return Quat(1.0, 0.0, 0.0, 0.0)
    return q / n


@inlined
def rotate(q: Quat, v: Vec3) -> Vec3:
    """``v`` turned by ``q``: from body to NED."""
    tx = 2.0 * (q.y * v.z - q.z * v.y)
    ty = 2.0 * (q.z * v.x - q.x * v.z)
    tz = 2.0 * (q.x * v.y - q.y * v.x)
    return Vec3(
        v.x + q.w * tx + q.y * tz - q.z * ty,
        v.y + q.w * ty + q.z * tx - q.x * tz,
        v.z + q.w * tz + q.x * ty - q.y * tx,
    )


@inlined
def rotate_inverse(q: Quat, v: Vec3) -> Vec3:
    """``v`` turned back by ``q``: from NED to body."""
    return rotate(conjugate(q), v)


@law
def quat_from_rotation_vector(r: Vec3) -> Quat:
    """Rotation by |r| radians about r."""
    angle = norm(r)
    if angle < 1e-9:
        return normalise(Quat(1.0, 0.5 * r.x, 0.5 * r.y, 0.5 * r.z))
    sine, cosine = sincos(0.5 * angle)
    s = sine / angle
    return Quat(cosine, s * r.x, s * r.y, s * r.z)


@law
def quat_about_down(angle: float) -> Quat:
    """Rotation by ``angle`` [rad] about down, from north towards east."""
    sine, cosine = sincos(0.5 * angle)
    return Quat(cosine, 0.0, 0.0, sine)


@law
def quat_from_euler(e: Euler) -> Quat:
    """Rotation of Euler angles [rad]."""
    sr, cr = sincos(0.5 * e.roll)
    sp, cp = sincos(0.5 * e.pitch)
    sy, cy = sincos(0.5 * e.yaw)
    return Quat(
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    )


@law
def euler_of(q: Quat) -> Euler:
    """Euler angles [rad] of a rotation, pitch in [-pi/2, pi/2]."""
    tilt = tilt_of(q)
    return Euler(tilt.roll, tilt.pitch, yaw_of(q))


@inlined
def tilt_of(q: Quat) -> Euler:
    """Roll and pitch [rad] of a rotation, the first two of its Euler angles; yaw 0."""
    s = 2.0 * (q.w * q.y - q.z * q.x)
    if s > 1.0:
        s = 1.0
    elif s < -1.0:
        s = -1.0
    roll = atan2(2.0 * (q.w * q.x + q.y * q.z), 1.0 - 2.0 * (q.x * q.x + q.y * q.y))
    return Euler(roll, asin(s), 0.0)


@law
def yaw_of(q: Quat) -> float:
    """Yaw [rad] of a rotation, the third of its Euler angles."""
    return atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))


class Matrix3(NamedTuple):
    """A matrix of three rows."""

    x: Vec3
    y: Vec3
    z: Vec3


@inlined
def rotation_matrix(q: Quat) -> Matrix3:
    """The matrix that turns from body into NED, as the unit quaternion ``q`` does."""
    w, x, y, z = q.w, q.x, q.y, q.z
    return Matrix3(
        Vec3(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),
        Vec3(2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)),
        Vec3(2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)),
    )


@inlined
def scaled(m: Matrix3, k: float) -> Matrix3:
    """``k`` times a matrix, shape (3, 3)."""
    return Matrix3(m.x * k, m.y * k, m.z * k)


@inlined
def apply(m: Matrix3, v: Vec3) -> Vec3:
    """Matrix times vector, in the matrix's frame."""
    return Vec3(dot(m.x, v), dot(m.y, v), dot(m.z, v))
