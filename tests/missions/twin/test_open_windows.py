# SPDX-License-Identifier: BSD-3-Clause
"""Pieces of a log's flight that a twin flies from where the log's vehicle was."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from sitl.missions.twin.twin import _Twins


def windows(sampled: Any, length: float = 9.0, seconds: float = 2.0, climbs: float = 1.0) -> list[tuple[float, float]]:
    """(begin, end) of pieces of a flight that is 5 m high from ``climbs`` on and whose rates were logged then."""
    time = np.round(np.arange(-2.0, 12.0, 0.1), 3)
    table = {"t": time, "PD": np.where(time < climbs, 7.0, 2.0)}
    log = SimpleNamespace(
        span=SimpleNamespace(length=length),
        estimate=lambda: table,
        table=lambda name: {"t": np.array(sampled)},
        since_arming=lambda of: of["t"],
        at_arming=lambda time, values: values[0],
        has=lambda *names: True,
    )
    twins: Any = SimpleNamespace(log=log)
    return [(round(window.begin, 3), round(window.end, 3)) for window in _Twins._windows(twins, seconds)]


HALVES = np.arange(-2.0, 12.0, 0.5)


def test_one_follows_the_other_to_the_end_of_the_flight() -> None:
    assert windows(HALVES) == [(1.0, 3.0), (3.0, 5.0), (5.0, 7.0), (7.0, 9.0)]
    assert windows(HALVES, length=8.9) == [(1.0, 3.0), (3.0, 5.0), (5.0, 7.0)]


def test_they_begin_when_rates_were_logged() -> None:
    assert windows(HALVES + 0.2) == [(1.2, 3.2), (3.2, 5.2), (5.2, 7.2)]


def test_none_goes_beyond_the_flight() -> None:
    assert windows([7.0]) == [(7.0, 9.0)]
    assert windows([7.5]) == []
    assert windows([0.5]) == [], "no rates were logged after that"


def test_one_that_samples_make_half_as_long_again_is_none() -> None:
    assert windows([1.0, 3.9, 6.0, 8.0]) == [(1.0, 3.9), (3.9, 6.0), (6.0, 8.0)]
    assert windows([1.0, 4.0, 6.0, 8.0]) == [(4.0, 6.0), (6.0, 8.0)]


def test_a_flight_that_never_left_the_ground_has_none() -> None:
    assert windows(HALVES, climbs=100.0) == []
