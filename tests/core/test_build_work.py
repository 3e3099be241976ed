# SPDX-License-Identifier: BSD-3-Clause
"""How much of a build is done: by the units' work, at the speed that was seen."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.core.build_work import BuildWork


def test_a_unit_counts_by_its_work_and_while_it_is_compiled_by_the_speed_so_far() -> None:
    work = BuildWork({"large": 6.0, "small": 2.0})
    work.begin("small", 0.0)
    assert work.done(1.0) == pytest.approx(1.0)
    work.end("small", 4.0)  # twice as slow as was thought
    work.begin("large", 4.0)
    assert work.done(8.0) == pytest.approx(2.0 + 2.0)
    assert work.done(100.0) == pytest.approx(2.0 + 0.95 * 6.0)  # it is not complete before it is
    work.end("large", 101.0)
    assert work.done(101.0) == work.total == 8.0


@given(st.lists(st.tuples(st.floats(0.1, 50.0), st.floats(0.1, 200.0)), min_size=1, max_size=8))
def test_it_never_falls_and_ends_at_the_whole(units: list[tuple[float, float]]) -> None:
    """Units one after another, each with its weight and the seconds that it takes."""
    work = BuildWork({str(k): weight for k, (weight, _) in enumerate(units)})
    now, told = 0.0, [0.0]
    for k, (_, seconds) in enumerate(units):
        work.begin(str(k), now)
        told += [work.done(now + share * seconds) for share in (0.0, 0.5, 1.0)]
        now += seconds
        work.end(str(k), now)
        told.append(work.done(now))
    assert told == sorted(told)
    assert told[-1] == pytest.approx(work.total) and told[-2] < work.total
