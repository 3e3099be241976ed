# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

from sitl.envs.noise import EXPONENTIAL_TAIL, NORMAL_TAIL, dirichlet, standard_normal


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_only_the_tail_is_drawn_anew(dtype: type[np.float32] | type[np.float64]) -> None:
    theirs = np.random.default_rng(1).standard_normal((400, 500), dtype)
    ours = standard_normal(np.random.default_rng(1), (400, 500), dtype)
    is_tail = np.abs(theirs) > dtype(NORMAL_TAIL)
    assert ours.dtype == dtype and 30 < is_tail.sum() < 80  # 52 are expected
    assert np.array_equal(ours[~is_tail], theirs[~is_tail])
    assert (ours[is_tail] != theirs[is_tail]).all() and np.array_equal(np.sign(ours), np.sign(theirs))
    assert np.abs(ours[is_tail]).min() >= dtype(NORMAL_TAIL) and 3.8 < np.abs(ours[is_tail]).mean() < 4.0


def test_a_tail_does_not_take_the_c_librarys_logarithm() -> None:
    class Tail:
        """A generator that gives a number of the tail, and then halves."""

        def standard_normal(self, shape: int, dtype: type) -> object:
            return np.array([-4.0], dtype)

        def random(self) -> float:
            return 0.5

    found = standard_normal(Tail(), 1)  # type: ignore[arg-type]
    assert found.tolist() == [-(NORMAL_TAIL + 0.6931471805599453 / NORMAL_TAIL)]


def test_shares_are_numpys_dirichlet_of_ones_but_for_the_tail() -> None:
    a, b = np.random.default_rng(3), np.random.default_rng(3)
    assert np.array_equal(a.dirichlet(np.ones(3), 50), dirichlet(b, 50, 3))
    many = dirichlet(np.random.default_rng(4), 20000, 3)
    assert np.allclose(many.sum(axis=1), 1.0) and np.allclose(many.mean(axis=0), 1.0 / 3.0, atol=0.01)
    assert (np.random.default_rng(4).standard_exponential((20000, 3)) > EXPONENTIAL_TAIL).any()
