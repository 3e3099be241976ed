# SPDX-License-Identifier: BSD-3-Clause
"""The free rigid body: one integration step.

Rotation: the rate at mid-step turns the attitude by an exact rotation, and the angular momentum is carried
over in the world frame, so that a torque-free body keeps it to rounding (second order otherwise).
Translation: the force, fixed in the body, acts along the attitude at mid-step (second order).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ...core.algebra import by_component, dot, multiply, quat_norm_squared, rotate, rotate_inverse
from ...core.constants import GRAVITY
from ...core.kernels import law
from ...core.vectors import Quat, Vec3
from .records import Body


class Wrench(NamedTuple):
    """What acts on a body, in its own frame (FRD)."""

    force: Vec3
    """[N]"""
    torque: Vec3
    """About the origin [N m]."""


class Inertia(NamedTuple):
    """What a body resists with."""

    moments: Vec3
    """About body x, y, z [kg m^2]."""
    inverse_moments: Vec3
    """1 / moments."""
    inverse_mass: float
    """[1/kg]"""


@law
def small_rotation(r: Vec3) -> Quat:
    """Quaternion of the rotation vector ``r`` [rad] of up to half a radian, by its power series."""
    s = 0.25 * dot(r, r)
    k = 0.5 * (1.0 - s * (1.0 / 6.0 - s * (1.0 / 120.0 - s / 5040.0)))
    return Quat(1.0 - s * (0.5 - s * (1.0 / 24.0 - s / 720.0)), k * r.x, k * r.y, k * r.z)


@law
def unit(q: Quat) -> Quat:
    """``q``, which is not zero, at length 1."""
    return q * (1.0 / math.sqrt(quat_norm_squared(q)))


@law
def fly(b: Body, wrench: Wrench, inertia: Inertia, dt: float) -> None:
    """Move the free body on by ``dt`` [s] under a wrench and gravity; adds the rates at mid-step to ``rates_mean``."""
    half = 0.5 * dt
    moments, inverse, torque = inertia.moments, inertia.inverse_moments, wrench.torque
    w, q, vel = b.rates, b.q, b.vel
    gyroscopic = Vec3(
        w.y * w.z * (moments.z - moments.y), w.z * w.x * (moments.x - moments.z), w.x * w.y * (moments.y - moments.x)
    )
    rates = w + by_component(half * inverse, torque - gyroscopic)  # at mid-step
    turn = small_rotation(rates * dt)
    b.q = unit(multiply(q, turn))
    # Angular momentum: half the torque in the old frame, the turn of the frame, half in the new one.
    momentum = rotate_inverse(unit(turn), by_component(moments, w) + half * torque)
    b.rates = by_component(inverse, momentum + half * torque)
    b.rates_mean += rates
    # Force along the attitude at mid-step.
    acc = rotate(unit(q + b.q), inertia.inverse_mass * wrench.force)
    acc = Vec3(acc.x, acc.y, acc.z + GRAVITY)
    b.pos += dt * (vel + half * acc)
    b.vel = vel + dt * acc
