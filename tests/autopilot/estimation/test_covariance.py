# SPDX-License-Identifier: BSD-3-Clause
"""Covariance laws against dense linear algebra."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sitl.autopilot.estimation import covariance
from sitl.autopilot.estimation.state import BA, BG, BM, POS, THETA, VEL, N
from sitl.autopilot.params.estimator import Ekf3
from sitl.core.vectors import Quat, Vec3


def _random(r: np.random.Generator) -> np.ndarray:
    a = r.normal(size=(N, N))
    return a @ a.T


def _matrix(q: np.ndarray) -> np.ndarray:
    w, u = q[0], q[1:]
    cross = np.array([[0, -u[2], u[1]], [u[2], 0, -u[0]], [-u[1], u[0], 0]])
    return np.eye(3) + 2 * w * cross + 2 * cross @ cross


@given(st.integers(0, 10000))
@settings(max_examples=20, deadline=None)
def test_prediction_is_f_p_f_transposed_plus_noise(seed: int) -> None:
    r, dt = np.random.default_rng(seed), 0.0125
    P, q, a = _random(r), r.normal(size=4), r.normal(size=3)
    q /= np.linalg.norm(q)
    before, R = P.copy(), _matrix(q)
    F = np.eye(N)
    F[POS : POS + 3, VEL : VEL + 3] = dt * np.eye(3)
    F[THETA : THETA + 3, BG : BG + 3] = -dt * R
    F[VEL : VEL + 3, BA : BA + 3] = -dt * R
    F[VEL : VEL + 3, THETA : THETA + 3] = -np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])
    params = Ekf3()
    for name in params.fields:
        params[name] = 1.0
    covariance.predict(P, Quat(*q), Vec3(*a), dt, params)
    added = P - F @ before @ F.T
    assert np.allclose(added, np.diag(np.diag(added)), atol=1e-12)
    noisy = [k for first in (THETA, VEL, BG, BA, BM) for k in range(first, first + 3)]
    assert np.all(np.diag(added)[noisy] > 0)
    assert np.diag(added)[POS : POS + 3] == pytest.approx(0.0, abs=1e-12)
    assert np.array_equal(P, P.T)


@given(st.integers(0, 10000), st.floats(-4, 4))
@settings(max_examples=20, deadline=None)
def test_turning_the_frame_keeps_what_is_known(seed: int, angle: float) -> None:
    P = _random(np.random.default_rng(seed))
    before = P.copy()
    T = np.eye(N)
    c, s = np.cos(angle), np.sin(angle)
    for n in (THETA, VEL, POS):
        T[n : n + 2, n : n + 2] = [[c, -s], [s, c]]
    covariance.turn_frame(P, angle)
    assert np.allclose(P, T @ before @ T.T)


def test_clear_forgets_one_state_only() -> None:
    P = _random(np.random.default_rng(1))
    before = P.copy()
    covariance.clear(P, POS, 2, 4.0)
    assert P[POS, POS] == P[POS + 1, POS + 1] == 4.0
    others = [k for k in range(N) if k not in (POS, POS + 1)]
    assert np.all(P[POS, others] == 0) and np.all(P[others, POS] == 0)
    assert np.array_equal(P[np.ix_(others, others)], before[np.ix_(others, others)])


def test_bound_limits_variances_and_correlations() -> None:
    P = _random(np.random.default_rng(2))
    P[0, 0] = 50.0
    P[BG, BG] = -1.0
    P[4, 5] = P[5, 4] = 1e6
    covariance.bound(P)
    d = np.diag(P)
    high = np.repeat(covariance.MAX_VARIANCE, 3)
    low = np.repeat(covariance.MIN_VARIANCE, 3)
    assert np.all(d <= high) and np.all(d >= low)
    assert np.all(np.abs(P) <= np.sqrt(np.outer(d, d)) * (1 + 1e-12))
