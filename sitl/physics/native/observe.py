# SPDX-License-Identifier: BSD-3-Clause
"""What an IMU feels of a body that another engine has moved: from its change of velocity and attitude over a tick.

The mean rate turns the old attitude exactly into the new one and the mean specific force gives exactly the change of
velocity, so that an inertial filter sees no error of the integration.
"""

from __future__ import annotations

from ...core.algebra import ZERO, conjugate, multiply, norm, rotate_inverse
from ...core.constants import GRAVITY, TICK_S
from ...core.elementary import atan2
from ...core.kernels import law
from ...core.vectors import Quat, Vec3
from .body import unit
from .obstacles import show
from .records import Body, Motion, Obstacles

_PER_S = 1.0 / TICK_S


@law
def note(body: Body, motion: Motion) -> None:
    """Before the engine moves the body: keep velocity and attitude."""
    motion.vel, motion.q = body.vel, body.q
    motion.contact = ZERO


@law
def mean_rates(before: Quat, after: Quat) -> Vec3:
    """Body rates [rad/s] that turn one attitude into another, of the same sign, within a tick."""
    turn = multiply(conjugate(before), after)
    axis = Vec3(turn.x, turn.y, turn.z)
    sine = norm(axis)
    k = 2.0 * _PER_S
    if sine > 1e-6:
        k = 2.0 * atan2(sine, turn.w) / sine * _PER_S
    return k * axis


@law
def observe(body: Body, motion: Motion, obstacles: Obstacles) -> None:
    """After it: write the body's rates_mean, acc_ned and specific_force."""
    before, after = motion.q, body.q
    if before.w * after.w + before.x * after.x + before.y * after.y + before.z * after.z < 0.0:
        after = -after  # the same attitude under the other sign
    body.rates_mean = mean_rates(before, after)
    acc = _PER_S * (body.vel - motion.vel - motion.contact)
    body.acc_ned = acc
    body.specific_force = rotate_inverse(unit(before + after), Vec3(acc.x, acc.y, acc.z - GRAVITY))
    obstacles.impulse += motion.contact
    show(obstacles, body)
