# SPDX-License-Identifier: BSD-3-Clause
"""The free rigid body: one integration step.

Rotation: the rate at mid-step turns the attitude by an exact rotation, and the angular momentum is carried
over in the world frame, so that a torque-free body keeps it to rounding (second order otherwise).
Translation: the force, fixed in the body, acts along the attitude at mid-step (second order).
"""

from __future__ import annotations

import math

from ...core.kernels import law
from ...core.rotations import quat_multiply, quat_rotate, quat_rotate_inverse

GRAVITY = 9.80665
"""Standard gravity [m/s^2]."""


@law
def small_rotation(x, y, z):
    """Quaternion of the rotation vector (x, y, z) [rad] of up to half a radian, by its power series."""
    s = 0.25 * (x * x + y * y + z * z)
    k = 0.5 * (1.0 - s * (1.0 / 6.0 - s * (1.0 / 120.0 - s / 5040.0)))
    return (1.0 - s * (0.5 - s * (1.0 / 24.0 - s / 720.0)), k * x, k * y, k * z)


@law
def fly(p, fx, fy, fz, mx, my, mz):
    """Move the free body on by a substep under a force and a torque in its own frame; adds to rates_mean."""
    b, inertia, inverse = p.body, p.airframe.inertia, p.derived.inverse_inertia
    dt = float(p.derived.dt)
    ix, iy, iz = inertia.x, inertia.y, inertia.z
    jx, jy, jz = float(inverse[0]), float(inverse[1]), float(inverse[2])
    wx, wy, wz = float(b.rates[0]), float(b.rates[1]), float(b.rates[2])
    half = 0.5 * dt
    # Rates at mid-step.
    ux = wx + half * jx * (mx - wy * wz * (iz - iy))
    uy = wy + half * jy * (my - wz * wx * (ix - iz))
    uz = wz + half * jz * (mz - wx * wy * (iy - ix))
    dw, dx, dy, dz = small_rotation(ux * dt, uy * dt, uz * dt)
    w, x, y, z = float(b.q[0]), float(b.q[1]), float(b.q[2]), float(b.q[3])
    nw, nx, ny, nz = quat_multiply(w, x, y, z, dw, dx, dy, dz)
    norm = 1.0 / math.sqrt(nw * nw + nx * nx + ny * ny + nz * nz)
    nw, nx, ny, nz = nw * norm, nx * norm, ny * norm, nz * norm
    b.q[0], b.q[1], b.q[2], b.q[3] = nw, nx, ny, nz
    # Angular momentum: half the torque in the old frame, the turn of the frame, half in the new one.
    norm = 1.0 / math.sqrt(dw * dw + dx * dx + dy * dy + dz * dz)
    lx, ly, lz = ix * wx + half * mx, iy * wy + half * my, iz * wz + half * mz
    lx, ly, lz = quat_rotate_inverse(dw * norm, dx * norm, dy * norm, dz * norm, lx, ly, lz)
    b.rates[0], b.rates[1], b.rates[2] = jx * (lx + half * mx), jy * (ly + half * my), jz * (lz + half * mz)
    b.rates_mean[0] += ux
    b.rates_mean[1] += uy
    b.rates_mean[2] += uz
    # Force along the attitude at mid-step.
    w, x, y, z = w + nw, x + nx, y + ny, z + nz
    norm = 1.0 / math.sqrt(w * w + x * x + y * y + z * z)
    k = float(p.derived.inverse_mass)
    ax, ay, az = quat_rotate(w * norm, x * norm, y * norm, z * norm, k * fx, k * fy, k * fz)
    az += GRAVITY
    vx, vy, vz = float(b.vel[0]), float(b.vel[1]), float(b.vel[2])
    b.pos[0] += dt * (vx + half * ax)
    b.pos[1] += dt * (vy + half * ay)
    b.pos[2] += dt * (vz + half * az)
    b.vel[0], b.vel[1], b.vel[2] = vx + dt * ax, vy + dt * ay, vz + dt * az
