# SPDX-License-Identifier: BSD-3-Clause
"""Motion of a rover over flat ground: the driven axle does not slide sideways, the body stays level.

The origin of the body, where the IMU is, lies ``ahead`` [m] of that axle: it moves sideways when the body turns.
The heading advances by the mean yaw rate of the tick, the position by the mean velocity at the heading half-way, and
the accelerometer shows the very change of velocity, so that an inertial filter sees no error of the integration.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ....core.constants import GRAVITY, TICK_S
from ....core.kernels import law
from ....core.vectors import Quat, Vec2, Vec3
from ..body import small_rotation
from ..records import Body, Obstacles
from .state import Wheels

_PER_S = 1.0 / TICK_S


class Course(NamedTuple):
    """How the driven axle moves over a tick."""

    before: float
    """Forward speed at its beginning [m/s]."""
    after: float
    """The same at its end [m/s]."""
    yaw_rate: float
    """At its end [rad/s]."""


@law
def forward(w: float, z: float) -> Vec2:
    """Where a level body points, north and east, at the quaternion (w, 0, 0, z)."""
    return Vec2(w * w - z * z, 2.0 * w * z)


@law
def over_ground(nose: Vec2, along: float, across: float) -> Vec2:
    """North and east of what is ``along`` the nose and ``across`` it, to the right."""
    return Vec2(nose.x * along - nose.y * across, nose.y * along + nose.x * across)


@law
def roll(body: Body, course: Course, ahead: float) -> None:
    """Move on by a tick."""
    q, rates = body.q, body.rates
    mean = 0.5 * (rates.z + course.yaw_rate)
    half = small_rotation(Vec3(0.0, 0.0, 0.5 * TICK_S * mean))
    mw, mz = q.w * half.w - q.z * half.z, q.w * half.z + q.z * half.w
    w, z = mw * half.w - mz * half.z, mw * half.z + mz * half.w
    norm = 1.0 / math.sqrt(w * w + z * z)
    w, z = w * norm, z * norm
    body.q = Quat(w, q.x, q.y, z)
    nose = forward(mw, mz)  # half-way
    travel = TICK_S * over_ground(nose, 0.5 * (course.before + course.after), ahead * mean)
    vel = over_ground(forward(w, z), course.after, ahead * course.yaw_rate)
    acc = (vel - Vec2(body.vel.x, body.vel.y)) * _PER_S
    body.pos = Vec3(body.pos.x + travel.x, body.pos.y + travel.y, body.pos.z)
    body.vel = Vec3(vel.x, vel.y, body.vel.z)
    body.rates = Vec3(rates.x, rates.y, course.yaw_rate)
    body.rates_mean = Vec3(body.rates_mean.x, body.rates_mean.y, mean)
    body.acc_ned = Vec3(acc.x, acc.y, body.acc_ned.z)
    body.specific_force = Vec3(nose.x * acc.x + nose.y * acc.y, nose.x * acc.y - nose.y * acc.x, -GRAVITY)


@law
def hold_back(body: Body, obstacles: Obstacles, wheels: Wheels, ahead: float) -> None:
    """After a solid took away velocity: the axle keeps what is left along the body, the tyres take up the rest, and the
    wheels are held back with the vehicle: motors stall.
    """
    nose, before = forward(body.q.w, body.q.z), body.vel
    speed = nose.x * before.x + nose.y * before.y
    lost = speed - wheels.forward
    wheels.speed += Vec2(lost, lost)
    wheels.forward = speed
    vel = over_ground(nose, speed, ahead * body.rates.z)
    body.vel = Vec3(vel.x, vel.y, before.z)
    taken = body.vel - before
    obstacles.impulse = Vec3(obstacles.impulse.x + taken.x, obstacles.impulse.y + taken.y, obstacles.impulse.z)
