# SPDX-License-Identifier: BSD-3-Clause
"""Motion of a rover over flat ground: the driven axle does not slide sideways, the body stays level.

The origin of the body, where the IMU is, lies ``rear_axle`` ahead of that axle: it moves sideways when the body turns.
The heading advances by the mean yaw rate of the tick, the position by the mean velocity at the heading half-way, and
the accelerometer shows the very change of velocity, so that an inertial filter sees no error of the integration.
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ..body import GRAVITY, small_rotation
from ..tick import TICK_S

_PER_S = 1.0 / TICK_S


@law
def roll(p, before, yaw_rate):
    """Move on by a tick: from axle speed ``before`` to ``wheels.forward`` [m/s], and to a yaw rate [rad/s]."""
    b, ahead = p.body, float(p.airframe.rear_axle)
    u, r = float(p.wheels.forward), float(b.rates[2])
    mean = 0.5 * (r + yaw_rate)
    dw, _, _, dz = small_rotation(0.0, 0.0, 0.5 * TICK_S * mean)
    w, z = float(b.q[0]), float(b.q[3])
    mw, mz = w * dw - z * dz, w * dz + z * dw
    w, z = mw * dw - mz * dz, mw * dz + mz * dw
    norm = 1.0 / math.sqrt(w * w + z * z)
    w, z = w * norm, z * norm
    b.q[0], b.q[3] = w, z
    c, s = mw * mw - mz * mz, 2.0 * mw * mz  # half-way
    along, across = 0.5 * (before + u), ahead * mean
    b.pos[0] += TICK_S * (c * along - s * across)
    b.pos[1] += TICK_S * (s * along + c * across)
    cn, sn = w * w - z * z, 2.0 * w * z
    across = ahead * yaw_rate
    vn, ve = cn * u - sn * across, sn * u + cn * across
    an, ae = (vn - float(b.vel[0])) * _PER_S, (ve - float(b.vel[1])) * _PER_S
    b.vel[0], b.vel[1] = vn, ve
    b.rates[2], b.rates_mean[2] = yaw_rate, mean
    b.acc_ned[0], b.acc_ned[1] = an, ae
    b.specific_force[0], b.specific_force[1], b.specific_force[2] = c * an + s * ae, c * ae - s * an, -GRAVITY


@law
def hold_back(p):
    """After a solid took away velocity: the axle keeps what is left along the body, the tyres take up the rest, and the
    wheels are held back with the vehicle: motors stall.
    """
    b, o, wheels = p.body, p.obstacles, p.wheels
    w, z = float(b.q[0]), float(b.q[3])
    c, s = w * w - z * z, 2.0 * w * z
    vn, ve = float(b.vel[0]), float(b.vel[1])
    u, across = c * vn + s * ve, float(p.airframe.rear_axle) * float(b.rates[2])
    lost = u - float(wheels.forward)
    wheels.speed[0] += lost
    wheels.speed[1] += lost
    wheels.forward = u
    b.vel[0], b.vel[1] = c * u - s * across, s * u + c * across
    o.impulse[0] += float(b.vel[0]) - vn
    o.impulse[1] += float(b.vel[1]) - ve
