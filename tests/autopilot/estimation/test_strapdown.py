# SPDX-License-Identifier: BSD-3-Clause
"""Strapdown navigation on motions with known answers, and the border against broken samples."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.estimation import strapdown
from sitl.autopilot.estimation.state import Ekf
from sitl.core.algebra import IDENTITY
from sitl.core.vectors import Vec3
from tests.autopilot.estimation import synthetic_flight as sf


def test_truth_in_truth_out() -> None:
    """Perfect samples of a minute's flight with turns: attitude to 0.001 degree, position to 5 cm."""
    truth = sf.fly(30.0, 2.0)
    ekf = Ekf()
    ekf.q, ekf.pos, ekf.vel = truth.q[0], truth.pos[0], truth.vel[0]
    for k in range(1, len(truth.t)):
        ekf.good_gyro, ekf.good_acc = truth.rates[k], truth.force[k]
        strapdown.advance(ekf, sf.DT)
    assert math.degrees(sf.attitude_error(np.array([ekf.q]), truth.q[-1:])[0]) < 1e-3
    assert np.linalg.norm(ekf.q) == pytest.approx(1.0, abs=1e-12)
    assert ekf.vel == pytest.approx(truth.vel[-1], abs=5e-3)
    assert ekf.pos == pytest.approx(truth.pos[-1], abs=5e-2)


def test_bias_is_taken_off() -> None:
    ekf = Ekf()
    ekf.q = IDENTITY
    ekf.gyro_bias = ekf.good_gyro = Vec3(0.1, -0.2, 0.3)
    ekf.acc_bias = Vec3(0.1, 0.2, 0.3)
    ekf.good_acc = Vec3(0.1, 0.2, 0.3 - strapdown.GRAVITY)
    for _ in range(100):
        strapdown.advance(ekf, sf.DT)
    assert ekf.q == pytest.approx([1, 0, 0, 0])
    assert ekf.vel == pytest.approx([0, 0, 0], abs=1e-12)


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), -float("inf"), 1e30])
@pytest.mark.parametrize("name", ["gyro", "acc"])
def test_a_broken_sample_is_replaced_by_the_last_good_one(bad: float, name: str) -> None:
    good = {"gyro": Vec3(0.1, 0.2, 0.3), "acc": Vec3(0.0, 0.0, -9.8)}
    ekf = Ekf()
    strapdown.read_imu(ekf, **good)
    strapdown.read_imu(ekf, **{**good, name: good[name].replace(y=bad)})
    assert ekf.bad_imu == 1
    assert ekf.good_gyro == pytest.approx([0.1, 0.2, 0.3])
    assert ekf.good_acc == pytest.approx([0, 0, -9.8])


@given(st.floats(-3.1, 3.1), st.floats(-1.5, 1.5))
def test_tilt_from_specific_force(roll: float, pitch: float) -> None:
    f = Vec3(math.sin(pitch), -math.sin(roll) * math.cos(pitch), -math.cos(roll) * math.cos(pitch))
    assert strapdown.tilt_from_acc(f) == pytest.approx((roll, pitch, 0.0), abs=1e-9)
