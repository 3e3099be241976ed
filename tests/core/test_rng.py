# SPDX-License-Identifier: BSD-3-Clause
"""The record's random numbers."""

from __future__ import annotations

import numpy as np
import pytest

from sitl.core import rng


def generator(seed: int):
    holder = [rng.Rng()]
    rng.seed(holder[0], seed)
    return holder[0]


def test_xoshiro128plusplus_reference_sequence() -> None:
    """First outputs from state {1, 2, 3, 4}, computed by hand from the published algorithm."""
    r = generator(0)
    r.s[:] = (1, 2, 3, 4)
    # (s0 + s3) = 5; rotl(5, 7) = 640; + s0 = 641. Then s = {7, 0, 1026, 12288}.
    assert rng.next_u32(r) == 641
    assert list(r.s) == [7, 0, 1026, 12288]
    # (7 + 12288) = 12295; rotl 7 = 1573760; + 7.
    assert rng.next_u32(r) == 1573767


def test_uniform_and_normal_have_their_moments() -> None:
    r = generator(1)
    u = np.array([rng.uniform(r) for _ in range(20000)])
    n = np.array([rng.normal(r) for _ in range(20000)])
    assert u.min() >= 0.0 and u.max() < 1.0
    assert u.mean() == pytest.approx(0.5, abs=0.01)
    assert n.mean() == pytest.approx(0.0, abs=0.03)
    assert n.std() == pytest.approx(1.0, abs=0.03)
    assert abs(np.corrcoef(n[:-1], n[1:])[0, 1]) < 0.03


@pytest.mark.parametrize("before", [0, 1])
def test_two_vectors_at_once_are_those_of_two_calls(before: int) -> None:
    """With a deviate kept from before, and without."""
    one, other = generator(3), generator(3)
    for r in (one, other):
        for _ in range(before):
            rng.normal(r)
    for _ in range(50):
        assert rng.normal_vectors(one) == (rng.normal_vector(other), rng.normal_vector(other))
        assert (list(one.s), one.spare, one.has_spare) == (list(other.s), other.spare, other.has_spare)


def test_seeds_differ_and_repeat() -> None:
    def first(seed: int) -> list[int]:
        r = generator(seed)
        return [rng.next_u32(r) for _ in range(4)]

    assert first(5) == first(5)
    assert len({tuple(first(s)) for s in (-1, 0, 1, 2, 2**40)}) == 5
