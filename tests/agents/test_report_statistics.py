# SPDX-License-Identifier: BSD-3-Clause
"""Statistics over seeds, against published tables, rliable and values computed by hand."""

from __future__ import annotations

import math
import sys

import numpy as np
import pytest
from pytest import approx
from scipy import stats

from sitl.agents.report.document import block_means, block_names, moving_mean
from sitl.agents.report.statistics import (
    difference,
    improvement,
    improvement_interval,
    interquartile_mean,
    iqm_interval,
    mean_interval,
    profile,
    profile_interval,
    suite_interval,
    t_quantile,
    trained_interval,
    wilson,
)
from sitl.errors import MissingExtra


def test_quantiles_are_students():
    table = {1: 12.706, 2: 4.303, 3: 3.182, 4: 2.776, 5: 2.571, 9: 2.262, 19: 2.093, 200: 1.972}
    assert {degrees: round(t_quantile(degrees), 3) for degrees in table} == table


def test_without_scipy_the_message_names_the_extra(monkeypatch):
    monkeypatch.setitem(sys.modules, "scipy", None)
    with pytest.raises(MissingExtra, match=r"scipy: pip install 'gym-sitl\[report\]'"):
        iqm_interval(SCORES)


def test_interval_of_a_mean():
    samples = np.random.default_rng(1).normal(5.0, 2.0, (10, 3))
    mean, half = mean_interval(samples)
    for k in range(3):
        low, high = stats.t.interval(0.95, 9, samples[:, k].mean(), stats.sem(samples[:, k]))
        assert (mean[k] - half[k], mean[k] + half[k]) == (approx(low, rel=1e-3), approx(high, rel=1e-3))
    assert np.isnan(mean_interval(samples[:1])[1]).all()


def test_interquartile_mean_leaves_out_a_quarter_at_each_end():
    samples = np.random.default_rng(1).normal(0.0, 1.0, 40)
    for count in range(1, 12):
        cut = count // 4
        kept = np.sort(samples[:count])[cut : count - cut]
        assert float(interquartile_mean(samples[:count])) == approx(kept.mean())
    assert float(interquartile_mean(np.array([-1e9, 1.0, 3.0, 1e9]))) == 2.0
    assert float(interquartile_mean(np.array([0.0, 6.0, 100.0]))) == approx(106.0 / 3.0)  # too few to leave one out
    rows = samples.reshape(4, 10)
    assert interquartile_mean(rows, axis=0) == approx(np.sort(rows, axis=0)[1:3].mean(axis=0))


SCORES = np.array([3.0, 1.0, 4.0, 1.0, 5.0, 9.0, 2.0, 6.0, 5.0, 3.0])
OTHERS = np.array([2.0, 7.0, 1.0, 8.0])
IQM, BETTER = (11 / 3, 2.1667, 5.3333), (0.4625, 0.1, 0.8625)
"""Statistic, low and high end."""


def test_statistics_are_those_of_rliable():
    """Made by rliable 1.2: aggregate_iqm, probability_of_improvement, get_interval_estimates (50,000 resamples)."""
    value, low, high = iqm_interval(SCORES)
    assert (value, low, high) == (approx(IQM[0]), approx(IQM[1], abs=0.17), approx(IQM[2], abs=0.17))
    value, low, high = improvement_interval(SCORES, OTHERS)
    assert (value, low, high) == (approx(BETTER[0]), approx(BETTER[1], abs=0.03), approx(BETTER[2], abs=0.03))


def test_a_single_run_has_no_interval():
    one = np.array([5.0])
    assert iqm_interval(one) == (5.0, approx(np.nan, nan_ok=True), approx(np.nan, nan_ok=True))
    assert improvement_interval(SCORES, one)[0] == approx(0.3) and np.isnan(improvement_interval(SCORES, one)[1:]).all()
    shares, low, high = profile_interval(one, np.array([4.0, 6.0]))
    assert shares.tolist() == [1.0, 0.0] and np.isnan([low, high]).all()
    assert difference(SCORES, one)[0] == approx(-1.1) and np.isnan(difference(SCORES, one)[1])


def test_difference_of_means_is_welchs():
    rng = np.random.default_rng(2)
    for sizes in ((10, 10), (40, 3), (5, 30)):
        a, b = rng.normal(0.0, 1.0, sizes[0]), rng.normal(1.0, 4.0, sizes[1])
        interval = stats.ttest_ind(a, b, equal_var=False).confidence_interval(0.95)
        apart, half = difference(a, b)
        assert apart == approx(a.mean() - b.mean()) and apart == approx((interval.high + interval.low) / 2)
        right = (interval.high - interval.low) / 2
        assert right - 1e-9 <= half * 1.001 and half <= 1.25 * right  # degrees of freedom are rounded down
    assert difference(np.ones(3), np.zeros(3)) == (1.0, 0.0)


def test_bootstrap_covers_the_truth_about_as_often_as_it_says():
    rng = np.random.default_rng(5)
    hits = 0
    for trial in range(100):
        value, low, high = iqm_interval(rng.normal(3.0, 1.0, 30), seed=trial, resamples=300)
        assert low <= value <= high
        hits += low <= 3.0 <= high
    assert 84 <= hits <= 100
    samples = rng.normal(size=8)
    assert iqm_interval(samples, seed=1) == iqm_interval(samples, seed=1)


def test_probability_of_improvement_counts_pairs():
    a, b = np.array([1.0, 3.0]), np.array([1.0, 2.0])
    assert improvement(a, b) == approx((0.5 + 0.0 + 1.0 + 1.0) / 4)
    assert improvement(b, a) == approx(1.0 - improvement(a, b))
    value, low, high = improvement_interval(a + 10.0, b)
    assert (value, low, high) == (1.0, 1.0, 1.0)


def test_profile_falls_from_one_to_zero():
    assert profile(np.array([1.0, 2.0, 3.0]), np.array([0.0, 1.5, 3.0])).tolist() == approx([1.0, 2 / 3, 0.0])


def test_interval_of_a_profile_holds_it_and_is_that_of_resampled_runs():
    levels = np.array([0.0, 2.5, 4.5, 9.0])
    shares, low, high = profile_interval(SCORES, levels)
    assert shares.tolist() == profile(SCORES, levels).tolist() == [1.0, 0.7, 0.4, 0.0]
    assert (low <= shares).all() and (shares <= high).all()
    # A resample's share is binomial: 10 draws of 0.7.
    assert (low[1], high[1]) == (approx(0.4), approx(1.0)) and (low[0], high[3]) == (1.0, 0.0)


def test_names_of_blocks_end_where_the_episodes_end():
    assert block_names(600, 200) == ["0 to 200", "200 to 400", "400 to 600"]
    assert block_names(250, 200) == ["0 to 200", "200 to 250"] and block_names(3, 5) == ["0 to 3"]


def test_means_of_blocks_and_moving_means():
    rewards = np.arange(10.0)[None]
    assert block_means(rewards, 4).tolist() == [[1.5, 5.5, 8.5]]
    assert moving_mean(rewards, 3)[0, [0, 1, 2, 9]].tolist() == [0.0, 0.5, 1.0, 8.0]


def test_wilsons_interval():
    assert wilson(50, 100) == pytest.approx((0.4038, 0.5962), abs=1e-4)
    assert wilson(200, 200)[1] == 1.0 and wilson(0, 10)[0] == 0.0


def test_the_interval_over_trainings_sees_that_they_differ():
    """A bootstrap that draws other trainings for each episode averages the differences away."""
    rng = np.random.default_rng(0)
    rates = np.array([0.59, 0.25, 0.02, 0.03, 0.82])
    scores = (rng.uniform(size=(5, 200)) < rates[:, None]).astype(float)
    value, low, high = trained_interval(scores)
    assert value == pytest.approx(np.sort(scores.mean(axis=1))[1:4].mean())
    assert low < 0.1 and high > 0.6
    alike = (rng.uniform(size=(5, 200)) < 0.5).astype(float)
    _, low, high = trained_interval(alike)
    assert 0.05 < high - low < 0.15 and low < 0.5 < high


def test_it_sees_that_episodes_differ():
    same = np.tile((np.arange(200) < 100).astype(float), (5, 1))
    value, low, high = trained_interval(same)
    assert value == 0.5 and high - low == pytest.approx(2 * 1.96 * math.sqrt(0.25 / 200), rel=0.1)


def test_one_training_has_no_interval():
    value, low, high = trained_interval(np.array([[1.0, 0.0]]))
    assert value == 0.5 and math.isnan(low) and math.isnan(high)


def test_the_interval_over_tasks_draws_trainings_within_each():
    scores = np.array([[0.0] * 5, [1.0] * 5, [0.5] * 5, [0.5] * 5])
    assert suite_interval(scores) == (0.5, 0.5, 0.5)  # tasks differ, trainings of a task do not
    value, low, high = suite_interval(np.array([[0.0, 1.0, 0.0, 1.0, 0.5]] * 4))
    assert value == 0.5 and low < 0.4 and high > 0.6
