# SPDX-License-Identifier: BSD-3-Clause
"""Covariance laws against dense linear algebra, and scalar fusion against the textbook update."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sitl.autopilot.estimation import covariance, fusion, history
from sitl.autopilot.estimation.state import BA, BG, BM, POS, THETA, VEL, Ekf, N
from sitl.autopilot.params.estimator import Ekf3
from sitl.core.algebra import IDENTITY, ZERO
from sitl.core.vectors import Quat, Vec3


def _random(r: np.random.Generator) -> np.ndarray:
    a = r.normal(size=(N, N))
    return a @ a.T


def _matrix(q: np.ndarray) -> np.ndarray:
    w, u = q[0], q[1:]
    cross = np.array([[0, -u[2], u[1]], [u[2], 0, -u[0]], [-u[1], u[0], 0]])
    return np.eye(3) + 2 * w * cross + 2 * cross @ cross


def _predict(P: np.ndarray, q: np.ndarray, dv: np.ndarray, dt: float, mirrored: bool = False) -> np.ndarray:
    params, ekf = Ekf3(), Ekf()
    for name in params.fields:
        if isinstance(params[name], float):  # else a group, of sources
            params[name] = 1.0
    ekf.P[:], ekf.q, ekf.step_dv, ekf.step_dt = P, Quat(*q), Vec3(*dv), dt
    ekf.biases_mirrored = mirrored
    covariance.predict(ekf, params)
    return np.array(ekf.P)


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
    P = _predict(P, q, a, dt)
    added = P - F @ before @ F.T
    assert np.allclose(added, np.diag(np.diag(added)), atol=1e-12)
    noisy = [k for first in (THETA, VEL, BG, BA, BM) for k in range(first, first + 3)]
    assert np.all(np.diag(added)[noisy] > 0)
    assert np.diag(added)[POS : POS + 3] == pytest.approx(0.0, abs=1e-12)
    assert np.array_equal(P, P.T)


@given(st.integers(0, 10000), st.floats(-4, 4))
@settings(max_examples=20, deadline=None)
def test_prediction_of_mirrored_biases_is_the_same_to_the_last_bit(seed: int, angle: float) -> None:
    r = np.random.default_rng(seed)
    P, q, dv = _random(r), r.normal(size=4), r.normal(size=3)
    P = 0.5 * (P + P.T)
    covariance.turn_frame(P, angle)
    q /= np.linalg.norm(q)
    assert np.array_equal(_predict(P, q, dv, 0.0125, mirrored=True), _predict(P, q, dv, 0.0125))


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
        fusion.correct(ekf, fusion.innovate(ekf, z[k], R[k, k]), fusion.NIS_HEIGHT)
    S = H @ P @ H.T + R
    K = P @ H.T @ np.linalg.inv(S)
    assert np.allclose(ekf.dx, K @ z)
    assert np.allclose(ekf.P, P - K @ S @ K.T)
    # whitened innovations: their sum is the joint normalised innovation squared
    assert ekf.nis_sum[fusion.NIS_HEIGHT] == pytest.approx(z @ np.linalg.solve(S, z))
    assert ekf.nis_count[fusion.NIS_HEIGHT] == 2


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
