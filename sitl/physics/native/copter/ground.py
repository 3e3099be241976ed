# SPDX-License-Identifier: BSD-3-Clause
"""Contact with the ground, flat where the vehicle is: at pos.z = 0, or as high as terrain data says.

A vehicle that touches stays where it is until its thrust exceeds its weight: Coulomb friction stops it, its
legs level it. Touching with more lean than the airframe's tip angle tips it over: it lies as it fell,
whatever its rotors do.
"""

from __future__ import annotations

import math

from ....core.algebra import ZERO, multiply, normalise, rotate, rotate_inverse
from ....core.constants import GRAVITY, TICK_S
from ....core.elementary import cos
from ....core.kernels import law
from ....core.vectors import Quat, Vec3
from ....vehicles.properties.multicopter import Legs
from ..body import small_rotation
from ..records import GROUND_LYING, GROUND_STANDING, Body
from .state import Ground

_LEVEL = 1e-5
"""Lean [rad] below which a standing vehicle is at rest."""


@law
def upright(q: Quat) -> float:
    """Cosine of the lean."""
    return 1.0 - 2.0 * (q.x * q.x + q.y * q.y)


@law
def touch(body: Body, ground: Ground, ground_d: float, legs: Legs, time_us: int) -> None:
    """Called in the air after a substep: stop at the ground at ``ground_d`` (down [m]) when it is reached."""
    pos, vel = body.pos, body.vel
    if pos.z < ground_d or vel.z < 0.0:
        return
    if vel.z > legs.hit_speed:
        ground.hit_count += 1
        ground.hit_speed = vel.z
        ground.hit_time_us = time_us
    ground.impulse += vel.z
    body.pos, body.vel, body.rates = Vec3(pos.x, pos.y, ground_d), Vec3(vel.x, vel.y, 0.0), ZERO
    if upright(body.q) < cos(legs.tip_angle):
        ground.state = GROUND_LYING
    else:
        ground.state = GROUND_STANDING


@law
def lifts_off(q: Quat, force: Vec3, inverse_mass: float) -> bool:
    """Whether a standing vehicle of 1 / mass [1/kg] takes off under a force [N], body frame, without gravity."""
    return GRAVITY + rotate(q, force).z * inverse_mass < 0.0


@law
def slide(vel: Vec3, acc: Vec3, friction: float, dt: float) -> Vec3:
    """Velocity [m/s] after ``dt`` [s] on the ground under an acceleration NED [m/s^2] and Coulomb friction."""
    n, e = vel.x + dt * acc.x, vel.y + dt * acc.y
    speed = math.sqrt(n * n + e * e)
    grip = friction * (GRAVITY + acc.z) * dt
    if speed <= grip:
        return ZERO
    return Vec3(n * (1.0 - grip / speed), e * (1.0 - grip / speed), 0.0)


@law
def levelling_rates(q: Quat, time_constant: float) -> Vec3:
    """Body rates [rad/s] at which legs level a lean."""
    down_x, down_y = 2.0 * (q.x * q.z - q.w * q.y), 2.0 * (q.y * q.z + q.w * q.x)
    if down_x * down_x + down_y * down_y > _LEVEL * _LEVEL:
        return Vec3(-down_y / time_constant, down_x / time_constant, 0.0)
    return ZERO


@law
def rest(body: Body, acc: Vec3, stands: bool, ground_d: float, legs: Legs, dt: float) -> Vec3:
    """One substep on the ground of a vehicle that stands, or lies.

    Args:
        body: adds the rates to its ``rates_mean``.
        acc: that its rotors and the air would give it [m/s^2], body frame, without gravity.
        stands: on its legs, which level it; otherwise its rotors do nothing.
        ground_d: down of the ground [m].
        legs: that it has.
        dt: length of the substep [s].

    Returns:
        The specific force [m/s^2], body frame.
    """
    q, before = body.q, body.vel
    vel = slide(before, rotate(q, acc) if stands else ZERO, legs.ground_friction, dt)
    n, e = body.pos.x + 0.5 * dt * (before.x + vel.x), body.pos.y + 0.5 * dt * (before.y + vel.y)
    body.pos, body.vel = Vec3(n, e, ground_d), vel
    body.rates = ZERO
    if stands:
        rates = levelling_rates(q, max(legs.leg_time_constant, dt))
        if rates.x != 0.0 or rates.y != 0.0:
            body.q = normalise(multiply(q, small_rotation(rates * dt)))
        body.rates = rates
        body.rates_mean += rates
    return rotate_inverse(q, Vec3((vel.x - before.x) / dt, (vel.y - before.y) / dt, -GRAVITY))


@law
def absorb(ground: Ground, leg_release: float) -> float:
    """Upward acceleration [m/s^2] of the legs taking up past impacts during a tick."""
    speed = ground.impulse * leg_release
    if speed < 1e-6:
        speed = ground.impulse
    ground.impulse -= speed
    return speed / TICK_S
