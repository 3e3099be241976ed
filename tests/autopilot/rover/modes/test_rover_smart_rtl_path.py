# SPDX-License-Identifier: BSD-3-Clause
"""SMART_RTL's path: what is kept, what goes."""

from __future__ import annotations

import itertools
import math

import pytest

from sitl.autopilot.events import PATH_LOST
from sitl.autopilot.rover import smart_rtl_path as srtl
from tests.autopilot.rover.modes.driven_rover import Rover


def points(rover: Rover) -> list[tuple[float, float]]:
    path = rover.ap.modes.path
    return [(float(path.n[k]), float(path.e[k])) for k in range(int(path.points))]


def driven(way: list[tuple[float, float]], **params: float) -> Rover:
    """A rover that was armed at the first point and has been at the others."""
    rover = Rover(**params)
    rover.place(*way[0])
    rover.ap.estimate.pos = (*way[0], 0.0)
    srtl.set_home(rover.v)
    for n, e in way[1:]:
        rover.ap.estimate.pos = (n, e, 0.0)
        rover.v.time_us += 340_000
        srtl.update(rover.v, 1)
    return rover


def test_points_are_srtl_accuracy_apart() -> None:
    rover = driven([(0.1 * k, 0.0) for k in range(101)], SRTL_ACCURACY=2.0)
    assert [n for n, _ in points(rover)] == pytest.approx([0.0, 2.0, 4.0, 6.0, 8.0, 10.0])


def test_corners_stay_and_straights_go() -> None:
    way = [(2.0 * k, 0.0) for k in range(30)] + [(58.0, 2.0 * k) for k in range(1, 30)]
    rover = driven(way)
    srtl.simplify(rover.ap)
    kept = points(rover)
    assert kept[0] == (0.0, 0.0)
    assert kept[1] == (58.0, 0.0)
    assert kept[-1] == (58.0, 58.0)
    assert len(kept) <= 4  # and one where the first simplification ended


def test_simplified_path_stays_within_half_the_accuracy() -> None:
    way = [(2.0 * k, 15.0 * math.sin(0.1 * k)) for k in range(49)]
    rover = driven(way)
    srtl.simplify(rover.ap)
    kept = points(rover)
    assert 2 < len(kept) < 30
    for n, e in way:
        nearest = min(srtl.segment_distance(n, e, *a, *b) for a, b in itertools.pairwise(kept))
        assert nearest <= 1.0 + 1e-9


def test_a_loop_is_cut_out() -> None:
    loop = [(20.0 + 10.0 * math.sin(t), 10.0 - 10.0 * math.cos(t)) for t in [0.2 * k for k in range(32)]]
    rover = driven([(2.0 * k, 0.0) for k in range(10)] + loop + [(20.0 + 2.0 * k, 0.5) for k in range(1, 10)])
    srtl.clean_up(rover.ap)
    kept = points(rover)
    assert kept[0] == (0.0, 0.0)
    assert max(abs(e) for _, e in kept) < 2.0
    assert len(kept) <= 4


def test_way_there_and_back_leaves_home() -> None:
    there = [(2.0 * k, 0.3 * (k % 2)) for k in range(15)]
    rover = driven(there + there[::-1][1:-1])
    srtl.clean_up(rover.ap)
    assert all(math.hypot(*p) < 4.0 for p in points(rover))


def test_fifty_points_start_a_simplification() -> None:
    rover = driven([(2.0 * k, 0.0) for k in range(60)])
    assert len(points(rover)) < 15


def test_a_full_path_is_given_up_after_a_while() -> None:
    spiral = [(0.15 * k * math.cos(0.7 * k), 0.15 * k * math.sin(0.7 * k)) for k in range(0, 1500, 3)]
    rover = driven(spiral, SRTL_POINTS=20.0, SRTL_ACCURACY=1.0)
    assert rover.ap.modes.path.active == 0
    assert (PATH_LOST, srtl.FULL, 0.0) in rover.events()


def test_a_position_lost_for_long_ends_it() -> None:
    rover = driven([(2.0 * k, 0.0) for k in range(5)])
    rover.set_estimate(False)
    rover.v.time_us += 14_000_000
    srtl.update(rover.v, 1)
    assert rover.ap.modes.path.active == 1
    rover.v.time_us += 2_000_000
    srtl.update(rover.v, 1)
    assert rover.ap.modes.path.active == 0


def test_no_points_no_path() -> None:
    assert driven([(2.0 * k, 0.0) for k in range(5)], SRTL_POINTS=0.0).ap.modes.path.active == 0


def test_popping_goes_home() -> None:
    rover = driven([(2.0 * k, 0.0) for k in range(4)])
    found = [srtl.pop(rover.ap) for _ in range(5)]
    assert found == [(1, 6.0, 0.0), (1, 4.0, 0.0), (1, 2.0, 0.0), (1, 0.0, 0.0), (0, 0.0, 0.0)]
