# SPDX-License-Identifier: BSD-3-Clause
"""Contact with flat ground at pos[2] = 0.

A vehicle that touches stays where it is until its thrust exceeds its weight: Coulomb friction stops it, its
legs level it. Touching with more lean than the airframe's tip angle tips it over: it lies as it fell,
whatever its rotors do.
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.rotations import quat_multiply, quat_normalise, quat_rotate, quat_rotate_inverse
from ..body import GRAVITY, small_rotation
from .state import GROUND_AIRBORNE, GROUND_LYING, GROUND_STANDING

_LEVEL = 1e-5
"""Lean [rad] below which a standing vehicle is at rest."""


@law
def touch(p, time_us):
    """Called in the air after a substep: stop at the ground when it is reached."""
    b, g = p.body, p.ground
    if float(b.pos[2]) < 0.0 or float(b.vel[2]) < 0.0:
        return
    speed = float(b.vel[2])
    if speed > p.airframe.hit_speed:
        g.hit_count += 1
        g.hit_speed = speed
        g.hit_time_us = time_us
    b.pos[2] = 0.0
    b.vel[2] = 0.0
    g.impulse += speed
    b.rates[0], b.rates[1], b.rates[2] = 0.0, 0.0, 0.0
    x, y = float(b.q[1]), float(b.q[2])
    upright = 1.0 - 2.0 * (x * x + y * y)  # cosine of the lean
    if upright < math.cos(float(p.airframe.tip_angle)):
        g.state = GROUND_LYING
    else:
        g.state = GROUND_STANDING


@law
def leaves(p, fx, fy, fz):
    """Whether a standing vehicle takes off under the body force (fx, fy, fz) [N]; if so it is airborne."""
    b = p.body
    _, _, down = quat_rotate(float(b.q[0]), float(b.q[1]), float(b.q[2]), float(b.q[3]), fx, fy, fz)
    if GRAVITY + down * float(p.derived.inverse_mass) < 0.0:
        p.ground.state = GROUND_AIRBORNE
        return True
    return False


@law
def rest(p, fx, fy, fz):
    """One substep on the ground under the body force (fx, fy, fz) [N].

    Returns the specific force [m/s^2] in the body frame.
    """
    b = p.body
    dt, k = float(p.derived.dt), float(p.derived.inverse_mass)
    w, x, y, z = float(b.q[0]), float(b.q[1]), float(b.q[2]), float(b.q[3])
    an, ae, ad = 0.0, 0.0, 0.0
    if p.ground.state == GROUND_STANDING:
        an, ae, ad = quat_rotate(w, x, y, z, k * fx, k * fy, k * fz)
    vn, ve = float(b.vel[0]), float(b.vel[1])
    n, e = vn + dt * an, ve + dt * ae
    speed = math.sqrt(n * n + e * e)
    grip = float(p.airframe.ground_friction) * (GRAVITY + ad) * dt
    if speed <= grip:
        n, e = 0.0, 0.0
    else:
        n, e = n * (1.0 - grip / speed), e * (1.0 - grip / speed)
    b.vel[0], b.vel[1], b.vel[2] = n, e, 0.0
    b.pos[0] += 0.5 * dt * (vn + n)
    b.pos[1] += 0.5 * dt * (ve + e)
    b.pos[2] = 0.0
    sx, sy, sz = quat_rotate_inverse(w, x, y, z, (n - vn) / dt, (e - ve) / dt, -GRAVITY)
    p_rate, q_rate = 0.0, 0.0
    if p.ground.state == GROUND_STANDING:
        down_x, down_y = 2.0 * (x * z - w * y), 2.0 * (y * z + w * x)
        if down_x * down_x + down_y * down_y > _LEVEL * _LEVEL:
            tau = max(float(p.airframe.leg_time_constant), dt)
            p_rate, q_rate = -down_y / tau, down_x / tau
            dw, dx, dy, dz = small_rotation(p_rate * dt, q_rate * dt, 0.0)
            w, x, y, z = quat_multiply(w, x, y, z, dw, dx, dy, dz)
            w, x, y, z = quat_normalise(w, x, y, z)
            b.q[0], b.q[1], b.q[2], b.q[3] = w, x, y, z
    b.rates[0], b.rates[1], b.rates[2] = p_rate, q_rate, 0.0
    b.rates_mean[0] += p_rate
    b.rates_mean[1] += q_rate
    return (sx, sy, sz)


@law
def absorb(p, dt):
    """Upward acceleration [m/s^2] of the legs taking up past impacts during a tick of dt [s]."""
    g = p.ground
    speed = float(g.impulse) * float(p.derived.leg_release)
    if speed < 1e-6:
        speed = float(g.impulse)
    g.impulse -= speed
    return speed / dt
