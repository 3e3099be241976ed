# SPDX-License-Identifier: BSD-3-Clause
"""Estimates by instruments: a controller that answers gusts makes least squares wrong, and not these."""

from __future__ import annotations

import numpy as np
import pytest

from sitl.identify.moments import WEAK, Block, fit
from sitl.identify.regression import long_run

DT, GAIN, LAG, DAMPING = 0.01, 40.0, 0.05, 1.0


def loop(seed: int, steps: int = 12_000) -> tuple[np.ndarray, ...]:
    """(Output, rate, wanted rate) of a rate controller in gusts, output through a lag."""
    draw = np.random.default_rng(seed)
    wanted = np.repeat(draw.normal(size=steps // 50), 50)
    u, p = np.zeros(steps), np.zeros(steps)
    motor = gust = 0.0
    for k in range(steps - 1):
        u[k] = 0.15 * (wanted[k] - p[k])
        motor += DT / LAG * (u[k] - motor)
        gust += -DT * gust + 0.4 * draw.normal()
        p[k + 1] = p[k] + DT * (GAIN * motor + gust - DAMPING * p[k])
    return u, p, wanted


def block(signals: tuple[np.ndarray, ...], instruments: np.ndarray) -> Block:
    u, p, _ = signals
    s = 2j * np.pi * np.fft.rfftfreq(len(u), DT)
    f = s.imag / (2.0 * np.pi)
    band = (f / 0.3) ** 4 / (1.0 + (f / 0.3) ** 4) / (1.0 + (f / 8.0) ** 8)

    def passed(x: np.ndarray, by: np.ndarray) -> np.ndarray:
        return np.fft.irfft(band * by * np.fft.rfft(x), len(x))

    def columns(shared: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return passed(p, s), np.stack([-passed(p, 1.0 + 0 * s), passed(u, 1.0 / (1.0 + s * shared[0]))], -1)

    z = passed(instruments, 1.0 + 0 * s)
    z = np.stack([np.roll(z, k) for k in (0, 2, 5, 8, 12, 18, 26)], -1)
    return Block(columns, z, np.zeros(len(u)), 200)


def test_gain_and_lag_are_found_in_a_loop_that_gusts_disturb() -> None:
    held = []
    for seed in range(5):
        signals = loop(seed)
        found = fit([block(signals, signals[2])], np.array([0.02]), np.array([0.01]))
        value, error = found.values[0][1], found.errors[0][1]
        held.append(abs(value - GAIN) < 1.96 * error and error < 0.05 * GAIN)
        assert found.shared[0] == pytest.approx(LAG, abs=0.01)
    assert sum(held) >= 4
    # The output as its own instrument is least squares: what the controller does against gusts takes from the gain.
    signals = loop(0)
    wrong = fit([block(signals, signals[0])], np.array([0.02]), np.array([0.01]))
    assert abs(wrong.values[0][1] - GAIN) > 0.05 * GAIN


def test_instruments_that_move_nothing_are_weak() -> None:
    signals = loop(0, 4_000)
    noise = np.random.default_rng(9).normal(size=4_000)
    assert block(signals, signals[2]).strength(1) > WEAK > block(signals, noise).strength(1)


@pytest.mark.parametrize(("count", "lag"), [(500, 20), (10, 50), (50, 49), (300, 0), (40_000, 60)])
def test_the_long_run_covariance_is_the_sum_over_pairs_with_bartletts_weights(count: int, lag: int) -> None:
    draw = np.random.default_rng(count)
    factors, errors = draw.normal(size=(count, 3)), draw.normal(size=count)
    groups = draw.integers(0, 2, count)
    expected = np.zeros((3, 3))
    for group in (0, 1):
        scores = (factors * errors[:, None])[groups == group]
        expected += scores.T @ scores
        for apart in range(1, min(lag, len(scores) - 1) + 1):
            pairs = scores[apart:].T @ scores[:-apart]
            expected += (1.0 - apart / (lag + 1.0)) * (pairs + pairs.T)
    np.testing.assert_allclose(long_run(factors, errors, groups, lag), expected, rtol=0, atol=1e-12 * count)
