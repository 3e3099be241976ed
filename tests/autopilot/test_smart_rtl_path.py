# SPDX-License-Identifier: BSD-3-Clause
"""SMART_RTL's path: what is kept, what goes."""

from __future__ import annotations

import itertools
import math

import pytest

from sitl.autopilot import smart_rtl_path as srtl
from sitl.autopilot.params.system import SmartRtl
from sitl.autopilot.rover.modes.decisions import keep_path
from sitl.autopilot.smart_rtl_path import PATH_LOST
from sitl.autopilot.state import PathState
from sitl.core.vectors import Vec3
from tests.autopilot.rover.modes.driven_rover import Rover

ACCURACY = 2.0

Way = list[tuple[float, float]]


def points(path: PathState) -> Way:
    return [(float(path.n[k]), float(path.e[k])) for k in range(path.points)]


def driven(way: Way, accuracy: float = ACCURACY) -> PathState:
    """The path of a vehicle that was at these points."""
    path, params = PathState(), SmartRtl()
    params.ACCURACY, params.POINTS = accuracy, 300.0
    for place in way:
        assert srtl.add(path, Vec3(*place, 0.0), params)
        srtl.keep_space(path, params)
    return path


def armed_at(way: Way, **params: float) -> Rover:
    """A rover that was armed at the first point and has been at the others."""
    rover = Rover(**params)
    rover.ap.estimate.pos = (*way[0], 0.0)
    srtl.begin(rover.ap.modes.path, Vec3(*way[0], 0.0), True, rover.v.time_us, rover.ap.params.SRTL)
    for n, e in way[1:]:
        rover.ap.estimate.pos = (n, e, 0.0)
        rover.v.time_us += 340_000
        keep(rover)
    return rover


def keep(rover: Rover) -> None:
    """What is done three times a second."""
    ap = rover.ap
    keep_path(ap.modes, ap.estimate, ap.events, rover.v.time_us, ap.params.SRTL)


def test_points_are_srtl_accuracy_apart() -> None:
    path = driven([(0.1 * k, 0.0) for k in range(101)])
    assert [n for n, _ in points(path)] == pytest.approx([0.0, 2.0, 4.0, 6.0, 8.0, 10.0])


def test_corners_stay_and_straights_go() -> None:
    path = driven([(2.0 * k, 0.0) for k in range(30)] + [(58.0, 2.0 * k) for k in range(1, 30)])
    srtl.simplify(path, ACCURACY)
    kept = points(path)
    assert kept[0] == (0.0, 0.0)
    assert kept[1] == (58.0, 0.0)
    assert kept[-1] == (58.0, 58.0)
    assert len(kept) <= 4  # and one where the first simplification ended


def test_simplified_path_stays_within_half_the_accuracy() -> None:
    way = [(2.0 * k, 15.0 * math.sin(0.1 * k)) for k in range(49)]
    path = driven(way)
    srtl.simplify(path, ACCURACY)
    kept = [Vec3(*place, 0.0) for place in points(path)]
    assert 2 < len(kept) < 30
    for place in way:
        nearest = min(srtl.stretch_distance(Vec3(*place, 0.0), a, b) for a, b in itertools.pairwise(kept))
        assert nearest <= 1.0 + 1e-9


def test_a_loop_is_cut_out() -> None:
    loop = [(20.0 + 10.0 * math.sin(t), 10.0 - 10.0 * math.cos(t)) for t in [0.2 * k for k in range(32)]]
    path = driven([(2.0 * k, 0.0) for k in range(10)] + loop + [(20.0 + 2.0 * k, 0.5) for k in range(1, 10)])
    srtl.clean_up(path, ACCURACY)
    kept = points(path)
    assert kept[0] == (0.0, 0.0)
    assert max(abs(e) for _, e in kept) < 2.0
    assert len(kept) <= 4


def test_way_there_and_back_leaves_home() -> None:
    there = [(2.0 * k, 0.3 * (k % 2)) for k in range(15)]
    path = driven(there + there[::-1][1:-1])
    srtl.clean_up(path, ACCURACY)
    assert all(math.hypot(*p) < 4.0 for p in points(path))


def test_fifty_points_start_a_simplification() -> None:
    assert driven([(2.0 * k, 0.0) for k in range(60)]).points < 15


def test_a_full_path_is_given_up_after_a_while() -> None:
    spiral = [(0.15 * k * math.cos(0.7 * k), 0.15 * k * math.sin(0.7 * k)) for k in range(0, 1500, 3)]
    rover = armed_at(spiral, SRTL_POINTS=20.0, SRTL_ACCURACY=1.0)
    assert not rover.ap.modes.path.active
    assert (PATH_LOST, srtl.FULL, 0.0) in rover.events()


def test_a_position_lost_for_long_ends_it() -> None:
    rover = armed_at([(2.0 * k, 0.0) for k in range(5)])
    rover.set_estimate(False)
    rover.v.time_us += 14_000_000
    keep(rover)
    assert rover.ap.modes.path.active
    rover.v.time_us += 2_000_000
    keep(rover)
    assert not rover.ap.modes.path.active


def test_no_points_no_path() -> None:
    assert not armed_at([(2.0 * k, 0.0) for k in range(5)], SRTL_POINTS=0.0).ap.modes.path.active


def test_the_last_point_goes_first() -> None:
    path = driven([(2.0 * k, 0.0) for k in range(4)])
    srtl.drop_last(path)
    assert points(path) == [(0.0, 0.0), (2.0, 0.0), (4.0, 0.0)]


def test_heights_count() -> None:
    path, params = PathState(), SmartRtl()
    params.ACCURACY, params.POINTS = ACCURACY, 300.0
    corners = [(0.0, 0.0, 0.0), (0.0, 0.0, -20.0), (10.0, 0.0, -20.0), (10.0, 0.0, -4.0)]
    way = [Vec3(0.0, 0.0, -2.0 * k) for k in range(11)] + [Vec3(2.0 * k, 0.0, -20.0) for k in range(1, 6)]
    for place in way + [Vec3(10.0, 0.0, 2.0 * k - 20.0) for k in range(1, 9)]:
        assert srtl.add(path, place, params)
    srtl.clean_up(path, ACCURACY)
    assert [tuple(srtl.point(path, k)) for k in range(path.points)] == corners
