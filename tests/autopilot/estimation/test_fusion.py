# SPDX-License-Identifier: BSD-3-Clause
"""Scalar fusion against the textbook update, and the way of corrections into state and history."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sitl.autopilot.estimation import fusion, history
from sitl.autopilot.estimation.state import POS, THETA, VEL, N
from tests.autopilot.estimation import synthetic_flight as sf


@given(st.integers(0, 10000))
@settings(max_examples=20, deadline=None)
def test_two_scalars_one_after_the_other_are_the_joint_update(seed: int) -> None:
    r = np.random.default_rng(seed)
    ekf = sf.Copter.of(sf.new(), 0).autopilot.ekf
    a = r.normal(size=(N, N))
    P = a @ a.T
    ekf.P[:] = P
    H, z, R = r.normal(size=(2, N)), r.normal(size=2), np.diag([0.3, 0.7])
    H[:, 4] = 0.0
    for k in range(2):
        fusion.clear_row(ekf)
        ekf.h[:] = H[k]
        innovation, s = fusion.innovate(ekf, z[k], R[k, k])
        fusion.correct(ekf, innovation, s, fusion.NIS_BAROMETER)
    S = H @ P @ H.T + R
    K = P @ H.T @ np.linalg.inv(S)
    assert np.allclose(ekf.dx, K @ z)
    assert np.allclose(ekf.P, P - K @ S @ K.T)
    # whitened innovations: their sum is the joint normalised innovation squared
    assert ekf.nis_sum[fusion.NIS_BAROMETER] == pytest.approx(z @ np.linalg.solve(S, z))
    assert ekf.nis_count[fusion.NIS_BAROMETER] == 2


def test_injection_moves_state_past_and_keeps_the_output_steady(ap) -> None:
    ekf = ap.ekf
    ekf.q[0] = 1.0
    ekf.pos[:] = (1.0, 2.0, 3.0)
    for k in range(5):
        history.keep(ekf, 100_000 * k)
    before = ekf.ring_pos[:5].copy()
    ekf.dx[THETA + 2] = 0.1
    ekf.dx[VEL] = 0.5
    ekf.dx[POS] = 2.0
    fusion.inject(ekf, 1.0, 400_000)
    assert ekf.q == pytest.approx([np.cos(0.05), 0, 0, np.sin(0.05)])
    assert ekf.pos[0] == 3.0 and ekf.vel[0] == 0.5
    assert ekf.pos[0] + ekf.lag_pos[0] == 1.0 and ekf.vel[0] + ekf.lag_vel[0] == 0.0
    assert ekf.ring_pos[:5, 0] - before[:, 0] == pytest.approx([2 - 0.5 * age for age in (0.4, 0.3, 0.2, 0.1, 0)])
    assert not np.any(ekf.dx)


def test_past_states_are_found_between_their_times(ap) -> None:
    ekf = ap.ekf
    for k in range(50):  # more than the ring holds
        ekf.pos[0] = k
        history.keep(ekf, 12_500 * k)
    a, b, share = history.slot_at(ekf, 12_500 * 40 + 2_500)
    assert ekf.ring_pos[a, 0] + share * (ekf.ring_pos[b, 0] - ekf.ring_pos[a, 0]) == pytest.approx(40.2)
    a, b, share = history.slot_at(ekf, 0)  # older than the ring: the oldest
    assert ekf.ring_pos[a, 0] == 50 - len(ekf.ring_us) and share == 0.0
    a, b, share = history.slot_at(ekf, 10**9)  # newer than the newest
    assert ekf.ring_pos[a, 0] == 49


def test_a_gate_is_in_hundredths_of_the_parameters_deviation() -> None:
    assert fusion.gate_ratio(25.0, 0.0, 1.0, 500.0) == pytest.approx(1.0)
    assert fusion.gate_ratio(25.0, 3.0, 1.0, 500.0) == pytest.approx(0.25)
