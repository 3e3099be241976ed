# SPDX-License-Identifier: BSD-3-Clause
"""Covariance laws against dense linear algebra."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sitl.autopilot.estimation import covariance
from sitl.autopilot.estimation.state import BA, BG, BM, POS, THETA, VEL, N
from tests.autopilot.estimation import synthetic_flight as sf


def _random(seed: int):
    r = np.random.default_rng(seed)
    ap = sf.Copter.of(sf.new(), 0).autopilot
    a = r.normal(size=(N, N))
    ap.ekf.P[:] = a @ a.T
    q = r.normal(size=4)
    ap.ekf.q[:] = q / np.linalg.norm(q)
    ap.ekf.step_dv[:] = r.normal(size=3)
    ap.ekf.step_dt = 0.0125
    return ap


def _matrix(q: np.ndarray) -> np.ndarray:
    w, u = q[0], q[1:]
    cross = np.array([[0, -u[2], u[1]], [u[2], 0, -u[0]], [-u[1], u[0], 0]])
    return np.eye(3) + 2 * w * cross + 2 * cross @ cross


@given(st.integers(0, 10000))
@settings(max_examples=20, deadline=None)
def test_prediction_is_f_p_f_transposed_plus_noise(seed: int) -> None:
    ap = _random(seed)
    ekf, dt = ap.ekf, 0.0125
    before, R, a = ekf.P.copy(), _matrix(ekf.q), ekf.step_dv
    F = np.eye(N)
    F[POS : POS + 3, VEL : VEL + 3] = dt * np.eye(3)
    F[THETA : THETA + 3, BG : BG + 3] = -dt * R
    F[VEL : VEL + 3, BA : BA + 3] = -dt * R
    F[VEL : VEL + 3, THETA : THETA + 3] = -np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])
    covariance.predict(ekf, ap.params)
    added = ekf.P - F @ before @ F.T
    assert np.allclose(added, np.diag(np.diag(added)), atol=1e-12)
    noisy = [k for first in (THETA, VEL, BG, BA, BM) for k in range(first, first + 3)]
    assert np.all(np.diag(added)[noisy] > 0)
    assert np.diag(added)[POS : POS + 3] == pytest.approx(0.0, abs=1e-12)
    assert np.array_equal(ekf.P, ekf.P.T)


@given(st.integers(0, 10000), st.floats(-4, 4))
@settings(max_examples=20, deadline=None)
def test_turning_the_frame_keeps_what_is_known(seed: int, angle: float) -> None:
    ekf = _random(seed).ekf
    before = ekf.P.copy()
    T = np.eye(N)
    c, s = np.cos(angle), np.sin(angle)
    for n in (THETA, VEL, POS):
        T[n : n + 2, n : n + 2] = [[c, -s], [s, c]]
    covariance.turn_frame(ekf, angle)
    assert np.allclose(ekf.P, T @ before @ T.T)


def test_clear_forgets_one_state_only() -> None:
    ekf = _random(1).ekf
    before = ekf.P.copy()
    covariance.clear(ekf, POS, 2, 4.0)
    assert ekf.P[POS, POS] == ekf.P[POS + 1, POS + 1] == 4.0
    others = [k for k in range(N) if k not in (POS, POS + 1)]
    assert np.all(ekf.P[POS, others] == 0) and np.all(ekf.P[others, POS] == 0)
    assert np.array_equal(ekf.P[np.ix_(others, others)], before[np.ix_(others, others)])


def test_bound_limits_variances_and_correlations() -> None:
    ekf = _random(2).ekf
    ekf.P[0, 0] = 50.0
    ekf.P[BG, BG] = -1.0
    ekf.P[4, 5] = ekf.P[5, 4] = 1e6
    covariance.bound(ekf)
    d = np.diag(ekf.P)
    high = np.repeat(covariance.MAX_VARIANCE, 3)
    low = np.repeat(covariance.MIN_VARIANCE, 3)
    assert np.all(d <= high) and np.all(d >= low)
    assert np.all(np.abs(ekf.P) <= np.sqrt(np.outer(d, d)) * (1 + 1e-12))
