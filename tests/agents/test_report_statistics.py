# SPDX-License-Identifier: BSD-3-Clause
"""Statistics over seeds beside scipy's, and by hand."""

from __future__ import annotations

import numpy as np
import pytest
from pytest import approx

from agents.report.blocks import block_means, moving_mean
from agents.report.statistics import (
    bootstrap,
    improvement,
    improvement_interval,
    interquartile_mean,
    iqm,
    mean_interval,
    profile,
    t_quantile,
)


def test_quantiles_are_students():
    stats = pytest.importorskip("scipy.stats")
    for degrees in (1, 2, 3, 4, 5, 9, 19, 200):
        assert t_quantile(degrees) == approx(stats.t.ppf(0.975, degrees), rel=1e-3)


def test_interval_of_a_mean():
    stats = pytest.importorskip("scipy.stats")
    samples = np.random.default_rng(1).normal(5.0, 2.0, (10, 3))
    mean, half = mean_interval(samples)
    for k in range(3):
        low, high = stats.t.interval(0.95, 9, samples[:, k].mean(), stats.sem(samples[:, k]))
        assert (mean[k] - half[k], mean[k] + half[k]) == (approx(low, rel=1e-3), approx(high, rel=1e-3))
    assert np.isnan(mean_interval(samples[:1])[1]).all()


def test_interquartile_mean_leaves_out_a_quarter_at_each_end():
    stats = pytest.importorskip("scipy.stats")
    samples = np.random.default_rng(1).normal(0.0, 1.0, 40)
    assert float(interquartile_mean(samples)) == approx(stats.trim_mean(samples, 0.25))
    assert float(interquartile_mean(np.array([-1e9, 1.0, 3.0, 1e9]))) == 2.0
    assert float(interquartile_mean(np.array([0.0, 6.0, 100.0]))) == approx((0.25 * 0.0 + 6.0 + 0.25 * 100.0) / 1.5)


def test_bootstrap_covers_the_truth_about_as_often_as_it_says():
    rng = np.random.default_rng(5)
    hits = 0
    for trial in range(100):
        value, low, high = bootstrap(rng.normal(3.0, 1.0, (2, 15)), iqm, seed=trial, resamples=300)
        assert low <= value <= high
        hits += low <= 3.0 <= high
    assert 84 <= hits <= 100
    samples = rng.normal(size=(1, 8))
    assert bootstrap(samples, iqm, seed=1) == bootstrap(samples, iqm, seed=1)


def test_probability_of_improvement_counts_pairs():
    a, b = np.array([1.0, 3.0]), np.array([1.0, 2.0])
    assert improvement(a, b) == approx((0.5 + 0.0 + 1.0 + 1.0) / 4)
    assert improvement(b, a) == approx(1.0 - improvement(a, b))
    value, low, high = improvement_interval(a + 10.0, b)
    assert (value, low, high) == (1.0, 1.0, 1.0)


def test_profile_falls_from_one_to_zero():
    assert profile(np.array([1.0, 2.0, 3.0]), np.array([0.0, 1.5, 3.0])).tolist() == approx([1.0, 2 / 3, 0.0])


def test_means_of_blocks_and_moving_means():
    rewards = np.arange(10.0)[None]
    assert block_means(rewards, 4).tolist() == [[1.5, 5.5, 8.5]]
    assert moving_mean(rewards, 3)[0, [0, 1, 2, 9]].tolist() == [0.0, 0.5, 1.0, 8.0]
