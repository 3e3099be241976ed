# SPDX-License-Identifier: BSD-3-Clause
"""Yaw without a compass: a bank of filters that know only the IMU and the receiver's velocity (EK3_GSF_*).

Each filter begins with another yaw and estimates horizontal velocity and yaw; how likely its measurements were is its
weight, and the weighted mean is the yaw of the bank once the filters agree. A compass that lies makes the main filter
contradict the receiver. When the failsafe is about to act on that, yaw jumps to the bank's.

The bank runs from when the main filter begins to doubt its measurements, and costs nothing before. Its levelled frame
has gravity down and its x axis at an unknown yaw; since rates turn the body in it, the yaw of each filter is constant.
Source: Alspach and Sorenson, "Nonlinear Bayesian estimation using Gaussian sum approximations", IEEE Transactions on
Automatic Control 17(4), 1972.
"""

from __future__ import annotations

import math

from ...core.algebra import cross, multiply, normalise, quat_from_rotation_vector, rotate, rotate_inverse, yaw_of
from ...core.constants import GRAVITY
from ...core.elementary import atan2, exp, sincos
from ...core.kernels import law
from ...core.records import FloatRows, Floats, Ints, Record, Records, array, repeat
from ...core.scalars import wrap_pi
from ...core.vectors import Quat, Vec2, Vec3
from .strapdown import rotation_in_tick, turned_attitude

MODELS = 5
RING = 20
"""Changes of velocity that are kept for fixes that come late; one each filter step (12.5 ms), 0.25 s in all."""
TILT_GAIN = 0.1
"""How fast the levelled frame follows the specific force, while that is as large as gravity [rad/s by rad]."""
ACC_NOISE, YAW_NOISE = 0.2, 0.01
"""How fast velocity and yaw wander, by the root of time [m/s, rad]."""
SPEED_NOISE = 0.5
"""Of the receiver's velocity, each axis [m/s]."""
FIRST_YAW = math.pi / MODELS
"""Standard deviation of each filter's yaw at the beginning [rad]."""
GOOD_YAW, GOOD_FIXES = math.radians(15.0), 5
"""The yaw is good when its standard deviation has been less for so many fixes in a row."""
LEAST_WEIGHT = 1e-6
ASKED_US = 5_000_000
"""A request for the yaw is answered for so long."""


class YawModel(Record):
    """One of the filters."""

    vel: Vec2  # north and east [m/s]
    yaw: float  # of the levelled frame's x axis [rad]
    weight: float  # 0 .. 1
    P: FloatRows = array(3, 3)  # covariance of velocity and yaw


class YawBank(Record):
    """The bank."""

    runs: bool
    asked_us: int  # when the failsafe last asked for its yaw; 0: it does not
    resets: int  # jumps of the main filter since it was armed (EK3_GSF_RST_MAX)
    fixes: int  # fused since it began to run
    good: int  # of them in a row that left a good yaw
    q: Quat  # body to levelled frame
    gyro_bias: Vec3  # as the main filter had it when the bank began [rad/s]
    acc_bias: Vec3  # [m/s^2]
    rates: Vec3  # of the tick before [rad/s]
    change: Vec2  # of the velocity since it began, levelled frame [m/s]
    fused: Vec2  # the same at the time of the last fix [m/s]
    fused_us: int  # that time
    kept: int  # changes in the ring so far
    past_us: Ints = array(RING, stored="i8")
    past: Floats = array(RING, 2)
    yaw: float  # of the levelled frame's x axis, mean of the filters [rad]
    variance: float  # [rad^2]
    models: Records[YawModel] = repeat(YawModel, MODELS)


@law
def begin(bank: YawBank, q: Quat, gyro_bias: Vec3, acc_bias: Vec3) -> None:
    """Run from now on, at the main filter's attitude ``q``, with its biases."""
    bank.runs = True
    bank.q = multiply(quat_from_rotation_vector(Vec3(0.0, 0.0, -yaw_of(q))), q)
    bank.gyro_bias, bank.acc_bias, bank.rates = gyro_bias, acc_bias, Vec3(0.0, 0.0, 0.0)
    bank.change = Vec2(0.0, 0.0)
    bank.fixes = bank.good = bank.kept = 0


@law
def advance(bank: YawBank, gyro: Vec3, acc: Vec3, dt: float) -> None:
    """A tick of ``dt`` [s]: turn the body in the levelled frame and sum up its change of velocity.

    ``gyro``, ``acc``: rates [rad/s] and specific force [m/s^2] of the body.
    """
    rates, force = gyro - bank.gyro_bias, acc - bank.acc_bias
    turn = rotation_in_tick(rates, bank.rates, dt)
    bank.rates = rates
    size = math.sqrt(force.x * force.x + force.y * force.y + force.z * force.z)
    trust = 1.0 - abs(size - GRAVITY) / GRAVITY
    if trust > 0.0:
        up = rotate_inverse(bank.q, Vec3(0.0, 0.0, -1.0))
        turn += TILT_GAIN * trust * trust * dt / size * cross(force, up)
    bank.q = turned_attitude(bank.q, turn)
    level = rotate(bank.q, force)
    bank.change += dt * Vec2(level.x, level.y)


@law
def keep(bank: YawBank, now_us: int) -> None:
    """Each filter step: keep the change of velocity so far."""
    n = bank.kept % RING
    bank.past_us[n] = now_us
    bank.past[n, 0], bank.past[n, 1] = bank.change.x, bank.change.y
    bank.kept += 1


@law
def change_at(bank: YawBank, when_us: int) -> Vec2:
    """Change of velocity up to a time [m/s]: the last one kept before it, or the oldest."""
    n, first = bank.kept - 1, max(0, bank.kept - RING)
    while n > first and bank.past_us[n % RING] > when_us:
        n -= 1
    k = n % RING
    return Vec2(float(bank.past[k, 0]), float(bank.past[k, 1]))


@law
def start_model(m: YawModel, k: int, vel: Vec2) -> None:
    """Filter ``k`` at the first fix."""
    m.vel, m.yaw, m.weight = vel, wrap_pi(2.0 * math.pi * k / MODELS), 1.0 / MODELS
    for i in range(3):
        for j in range(3):
            m.P[i, j] = 0.0
    m.P[0, 0] = m.P[1, 1] = SPEED_NOISE * SPEED_NOISE
    m.P[2, 2] = FIRST_YAW * FIRST_YAW


@law
def predict(m: YawModel, change: Vec2, dt: float) -> None:
    """Velocity and covariance after a change of velocity in the levelled frame [m/s] within ``dt`` [s]."""
    s, c = sincos(m.yaw)
    P = m.P
    dv = Vec2(c * change.x - s * change.y, s * change.x + c * change.y)
    m.vel += dv
    a, b = -dv.y, dv.x  # by how much yaw turns the change
    P22 = float(P[2, 2])
    P02, P12 = float(P[0, 2]) + a * P22, float(P[1, 2]) + b * P22
    P[0, 0] += a * (P[0, 2] + P02) + ACC_NOISE * ACC_NOISE * dt
    P[0, 1] += b * P[0, 2] + a * P12
    P[1, 1] += b * (P[1, 2] + P12) + ACC_NOISE * ACC_NOISE * dt
    P[0, 2], P[1, 2], P[2, 2] = P02, P12, P22 + YAW_NOISE * YAW_NOISE * dt
    mirror(P)


@law
def mirror(P: FloatRows) -> None:
    """The lower triangle, of the upper one."""
    P[1, 0], P[2, 0], P[2, 1] = P[0, 1], P[0, 2], P[1, 2]


@law
def row(P: FloatRows, i: int) -> Vec3:
    """A row of a covariance."""
    return Vec3(float(P[i, 0]), float(P[i, 1]), float(P[i, 2]))


@law
def correct(m: YawModel, vel: Vec2) -> float:
    """Fuse the receiver's velocity [m/s]; how likely it was."""
    P, r = m.P, SPEED_NOISE * SPEED_NOISE
    row0, row1 = row(P, 0), row(P, 1)
    s00, s01, s11 = row0.x + r, row0.y, row1.y + r
    det = s00 * s11 - s01 * s01
    i00, i01, i11 = s11 / det, -s01 / det, s00 / det
    y = vel - m.vel
    fx, fy = i00 * y.x + i01 * y.y, i01 * y.x + i11 * y.y
    m.vel += Vec2(row0.x * fx + row1.x * fy, row0.y * fx + row1.y * fy)
    m.yaw = wrap_pi(m.yaw + row0.z * fx + row1.z * fy)
    g0, g1 = i00 * row0 + i01 * row1, i01 * row0 + i11 * row1  # rows of S^-1 H P
    P[0, 0] -= row0.x * g0.x + row1.x * g1.x
    P[0, 1] -= row0.x * g0.y + row1.x * g1.y
    P[0, 2] -= row0.x * g0.z + row1.x * g1.z
    P[1, 1] -= row0.y * g0.y + row1.y * g1.y
    P[1, 2] -= row0.y * g0.z + row1.y * g1.z
    P[2, 2] -= row0.z * g0.z + row1.z * g1.z
    mirror(P)
    return exp(-0.5 * (y.x * fx + y.y * fy)) / (2.0 * math.pi * math.sqrt(det))


@law
def combine(bank: YawBank) -> None:
    """Yaw of the bank and its variance."""
    north = east = 0.0
    for k in range(MODELS):
        m = bank.models[k]
        sine, cosine = sincos(m.yaw)
        north += m.weight * cosine
        east += m.weight * sine
    bank.yaw = atan2(east, north)
    bank.variance = 0.0
    for k in range(MODELS):
        m = bank.models[k]
        off = wrap_pi(m.yaw - bank.yaw)
        bank.variance += m.weight * (m.P[2, 2] + off * off)
    bank.good = bank.good + 1 if bank.variance < GOOD_YAW * GOOD_YAW else 0


@law
def fuse(bank: YawBank, vel: Vec2, when_us: int) -> None:
    """Take a velocity of the receiver, north and east [m/s], of ``when_us``."""
    if bank.kept == 0:
        return
    change = change_at(bank, when_us)
    if bank.fixes == 0:
        for k in range(MODELS):
            start_model(bank.models[k], k, vel)
    else:
        total, dt = 0.0, 1e-6 * (when_us - bank.fused_us)
        for k in range(MODELS):
            m = bank.models[k]
            predict(m, change - bank.fused, dt)
            m.weight = max(m.weight * correct(m, vel), LEAST_WEIGHT)
            total += m.weight
        for k in range(MODELS):
            bank.models[k].weight /= total
        combine(bank)
    bank.fixes += 1
    bank.fused, bank.fused_us = change, when_us


@law
def is_good(bank: YawBank) -> bool:
    """Whether the bank's yaw can be relied on."""
    return bank.runs and bank.good >= GOOD_FIXES


@law
def attitude(bank: YawBank) -> Quat:
    """Body to NED, by the bank."""
    return normalise(multiply(quat_from_rotation_vector(Vec3(0.0, 0.0, bank.yaw)), bank.q))
