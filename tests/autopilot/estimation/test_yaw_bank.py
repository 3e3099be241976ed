# SPDX-License-Identifier: BSD-3-Clause
"""The bank of yaw filters finds a yaw that the main filter has wrong, from accelerations and velocities."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pytest import approx

from sitl.autopilot.estimation import yaw_bank
from sitl.core.algebra import euler_of, multiply, quat_from_euler, quat_from_rotation_vector, rotate_inverse
from sitl.core.constants import GRAVITY
from sitl.core.scalars import wrap_pi
from sitl.core.vectors import Euler, Vec2, Vec3

DT = 0.0025
ZERO = Vec3(0.0, 0.0, 0.0)


def leaning(yaw: float) -> Euler:
    """Attitude of the body."""
    return Euler(0.1, -0.15, yaw)


def fly(bank: yaw_bank.YawBank, yaw: float, seconds: float, swing: float = 2.0, turn: float = 0.0) -> float:
    """Swing to and fro in the plane with an acceleration [m/s^2], leaning and turning [rad/s]; the yaw at the end."""
    rng = np.random.default_rng(1)
    q, vel = quat_from_euler(leaning(yaw)), np.zeros(2)
    rates = rotate_inverse(q, Vec3(0.0, 0.0, turn))
    for tick in range(1, round(seconds / DT) + 1):
        t = tick * DT
        acc = swing * np.array((math.sin(2.0 * t), 0.7 * math.cos(1.3 * t)))
        vel += DT * acc
        q = multiply(q, quat_from_rotation_vector(DT * rates))
        yaw_bank.advance(bank, rates, rotate_inverse(q, Vec3(acc[0], acc[1], -GRAVITY)), DT)
        if tick % 5 == 0:
            yaw_bank.keep(bank, 2500 * tick)
        if tick % 80 == 0:
            seen = vel + rng.normal(0.0, 0.1, 2)
            yaw_bank.fuse(bank, Vec2(float(seen[0]), float(seen[1])), 2500 * tick)
    return euler_of(q).yaw


@pytest.mark.parametrize("wrong", [0.0, 90.0, 180.0, -135.0])
@pytest.mark.parametrize("turn", [0.0, 0.4])
def test_the_yaw_is_found_wherever_the_main_filter_believes_it(wrong: float, turn: float) -> None:
    bank, yaw = yaw_bank.YawBank(), math.radians(100.0)
    yaw_bank.begin(bank, quat_from_euler(leaning(yaw + math.radians(wrong))), ZERO, ZERO)
    true = fly(bank, yaw, 6.0, turn=turn)
    assert yaw_bank.is_good(bank)
    found = euler_of(yaw_bank.attitude(bank))
    assert abs(wrap_pi(found.yaw - true)) < math.radians(12.0)
    assert sum(float(bank.models[k].weight) for k in range(yaw_bank.MODELS)) == approx(1.0)


def test_at_rest_there_is_no_yaw_to_find() -> None:
    bank = yaw_bank.YawBank()
    yaw_bank.begin(bank, quat_from_euler(leaning(0.0)), ZERO, ZERO)
    fly(bank, 1.0, 6.0, swing=0.0)
    assert not yaw_bank.is_good(bank) and bank.fixes == 30


def test_covariances_stay_symmetric_and_positive() -> None:
    bank = yaw_bank.YawBank()
    yaw_bank.begin(bank, quat_from_euler(leaning(0.0)), ZERO, ZERO)
    fly(bank, -2.0, 10.0, swing=4.0)
    for k in range(yaw_bank.MODELS):
        P = np.array(bank.models[k].P[:])
        assert np.array_equal(P, P.T) and np.linalg.eigvalsh(P).min() > 0.0


def test_the_change_of_velocity_of_a_late_fix() -> None:
    bank = yaw_bank.YawBank()
    for n in range(30):
        bank.change = Vec2(float(n), -float(n))
        yaw_bank.keep(bank, 12_500 * n)
    assert yaw_bank.change_at(bank, 12_500 * 20 + 6_000) == Vec2(20.0, -20.0)
    assert yaw_bank.change_at(bank, 12_500 * 40) == Vec2(29.0, -29.0)
    assert yaw_bank.change_at(bank, 0) == Vec2(10.0, -10.0), "the oldest that is kept"
