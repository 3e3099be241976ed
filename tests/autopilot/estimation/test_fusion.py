# SPDX-License-Identifier: BSD-3-Clause
"""Scalar fusion against the textbook update, and the way of corrections into state and history."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sitl.autopilot.estimation import fusion, history
from sitl.autopilot.estimation.state import POS, THETA, VEL, Ekf, N
from sitl.core.algebra import IDENTITY, ZERO
from sitl.core.vectors import Vec3


@given(st.integers(0, 10000))
@settings(max_examples=20, deadline=None)
def test_two_scalars_one_after_the_other_are_the_joint_update(seed: int) -> None:
    r = np.random.default_rng(seed)
    ekf = Ekf()
    a = r.normal(size=(N, N))
    P = a @ a.T
    ekf.P[:] = P
    H, z, R = r.normal(size=(2, N)), r.normal(size=2), np.diag([0.3, 0.7])
    H[:, 4] = 0.0
    for k in range(2):
        fusion.clear_row(ekf)
        ekf.h[:] = H[k]
        fusion.correct(ekf, fusion.innovate(ekf, z[k], R[k, k]), fusion.NIS_BAROMETER)
    S = H @ P @ H.T + R
    K = P @ H.T @ np.linalg.inv(S)
    assert np.allclose(ekf.dx, K @ z)
    assert np.allclose(ekf.P, P - K @ S @ K.T)
    # whitened innovations: their sum is the joint normalised innovation squared
    assert ekf.nis_sum[fusion.NIS_BAROMETER] == pytest.approx(z @ np.linalg.solve(S, z))
    assert ekf.nis_count[fusion.NIS_BAROMETER] == 2


def test_injection_moves_state_past_and_keeps_the_output_steady() -> None:
    ekf = Ekf()
    ekf.q, ekf.pos = IDENTITY, Vec3(1.0, 2.0, 3.0)
    for k in range(5):
        ekf.now_us = 100_000 * k
        history.keep(ekf)
    before = np.array(ekf.ring_pos[:5])
    ekf.dx[THETA + 2] = 0.1
    ekf.dx[VEL] = 0.5
    ekf.dx[POS] = 2.0
    fusion.inject(ekf, 1.0)
    assert ekf.q == pytest.approx([np.cos(0.05), 0, 0, np.sin(0.05)])
    assert ekf.pos.x == 3.0 and ekf.vel.x == 0.5
    assert ekf.pos + ekf.lag_pos == (1.0, 2.0, 3.0) and ekf.vel + ekf.lag_vel == ZERO
    assert ekf.ring_pos[:5, 0] - before[:, 0] == pytest.approx([2 - 0.5 * age for age in (0.4, 0.3, 0.2, 0.1, 0)])
    assert not np.any(ekf.dx)


def test_past_states_are_found_between_their_times() -> None:
    ekf = Ekf()
    for k in range(50):  # more than the ring holds
        ekf.now_us, ekf.pos, ekf.vel = 12_500 * k, Vec3(k, 0.0, 0.0), Vec3(0.0, 2 * k, 0.0)
        history.keep(ekf)
    past = history.past_at(ekf, 12_500 * 40 + 2_500)
    assert past.pos == pytest.approx((40.2, 0.0, 0.0)) and past.vel == pytest.approx((0.0, 80.4, 0.0))
    assert history.past_at(ekf, 0).pos.x == 50 - len(ekf.ring_us)  # older than the ring: the oldest
    assert history.past_at(ekf, 10**9).pos.x == 49  # newer than the newest


def test_a_gate_is_in_hundredths_of_the_parameters_deviation() -> None:
    assert fusion.gate_ratio(25.0, 0.0, 1.0, 500.0) == pytest.approx(1.0)
    assert fusion.gate_ratio(25.0, 3.0, 1.0, 500.0) == pytest.approx(0.25)
