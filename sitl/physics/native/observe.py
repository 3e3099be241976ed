# SPDX-License-Identifier: BSD-3-Clause
"""What an IMU feels of a body that another engine has moved: from its change of velocity and attitude over a tick.

The mean rate turns the old attitude exactly into the new one and the mean specific force gives exactly the change of
velocity, so that an inertial filter sees no error of the integration.
"""

from __future__ import annotations

import math

from ...core.kernels import law
from ...core.rotations import quat_multiply, quat_rotate_inverse
from .body import GRAVITY
from .obstacles import show
from .tick import TICK_S

_PER_S = 1.0 / TICK_S


@law
def note(p):
    """Before the engine moves the body: keep velocity and attitude."""
    b, m = p.body, p.motion
    for j in range(3):
        m.vel[j] = b.vel[j]
        m.contact[j] = 0.0
    for j in range(4):
        m.q[j] = b.q[j]


@law
def observe(p):
    """After it: write the body's rates_mean, acc_ned and specific_force."""
    b, m, o = p.body, p.motion, p.obstacles
    w0, x0, y0, z0 = float(m.q[0]), float(m.q[1]), float(m.q[2]), float(m.q[3])
    w, x, y, z = float(b.q[0]), float(b.q[1]), float(b.q[2]), float(b.q[3])
    if w0 * w + x0 * x + y0 * y + z0 * z < 0.0:  # the same attitude under the other sign
        w, x, y, z = -w, -x, -y, -z
    dw, dx, dy, dz = quat_multiply(w0, -x0, -y0, -z0, w, x, y, z)
    sine = math.sqrt(dx * dx + dy * dy + dz * dz)
    k = 2.0 * _PER_S
    if sine > 1e-6:
        k = 2.0 * math.atan2(sine, dw) / sine * _PER_S
    b.rates_mean[0], b.rates_mean[1], b.rates_mean[2] = k * dx, k * dy, k * dz
    n = _PER_S * (float(b.vel[0]) - float(m.vel[0]) - float(m.contact[0]))
    e = _PER_S * (float(b.vel[1]) - float(m.vel[1]) - float(m.contact[1]))
    d = _PER_S * (float(b.vel[2]) - float(m.vel[2]) - float(m.contact[2]))
    b.acc_ned[0], b.acc_ned[1], b.acc_ned[2] = n, e, d
    w, x, y, z = w0 + w, x0 + x, y0 + y, z0 + z
    norm = 1.0 / math.sqrt(w * w + x * x + y * y + z * z)
    fx, fy, fz = quat_rotate_inverse(w * norm, x * norm, y * norm, z * norm, n, e, d - GRAVITY)
    b.specific_force[0], b.specific_force[1], b.specific_force[2] = fx, fy, fz
    for j in range(3):
        o.impulse[j] += m.contact[j]
    show(p)
