# SPDX-License-Identifier: BSD-3-Clause
"""Spline waypoints are flown as waypoints along the curve."""

from __future__ import annotations

import math

import pytest

from sitl.autopilot.mission import item as c
from sitl.missions.files import MissionFileError, straightened
from sitl.missions.files.document import Plane
from sitl.missions.library.draft import LAT, LON, Draft

PLANE = Plane((LAT, LON))


def places(draft: Draft) -> list[tuple[float, float]]:
    """Of the straightened mission [m]."""
    items = straightened(draft.file()).mission.items
    assert all(item.command != c.NAV_SPLINE_WAYPOINT for item in items)
    return [PLANE.point((i.x * 1e-7, i.y * 1e-7)) for i in items if i.command == c.NAV_WAYPOINT and not i.no_place][1:]


def test_a_circle_of_splines_is_round() -> None:
    """Eight places on a circle of 20 m: the curve through them stays within a third of a metre of it."""
    corners = [(20 * math.cos(k * math.pi / 4), 20 * math.sin(k * math.pi / 4)) for k in range(9)]
    path = places(Draft("copter", "").take_off(5).curve(*corners, z=5.0))
    inner = [p for p in path if math.dist(p, corners[0]) > 16.0]  # away from its ends, which are straight
    assert len(inner) > 20
    assert [math.hypot(*p) for p in inner] == pytest.approx([20.0] * len(inner), abs=0.35)


def test_it_leaves_along_the_straight_leg_that_came_before() -> None:
    path = places(Draft("copter", "").take_off(5).to((0, 0), (20, 0), z=5.0).curve((30, 30), z=5.0))
    out = path[2]
    assert abs(out[1]) < 0.35 * (out[0] - 20.0)


def test_it_arrives_along_the_straight_leg_that_follows() -> None:
    path = places(Draft("copter", "").take_off(5).to((0, 0), z=5.0).curve((20, 0), z=5.0).to((20, 30), z=5.0))
    north, east = 20.0 - path[-3][0], 0.0 - path[-3][1]
    assert 0.0 < north < 0.7 * east


def test_heights_and_jumps_follow() -> None:
    draft = Draft("copter", "").take_off(5).to((0, 0), z=5.0).curve((20, 0), z=15.0).to((20, 30), z=15.0).jump(4, 1)
    items = straightened(draft.file()).mission.items
    assert items[int(items[-1].p1)].y == draft.file().mission.items[4].y
    assert [i.z for i in items[2:-1]] == sorted(i.z for i in items[2:-1])


def test_without_splines_it_is_the_same_file() -> None:
    file = Draft("copter", "").take_off(5).file()
    assert straightened(file) is file


def test_a_spline_needs_a_place() -> None:
    with pytest.raises(MissionFileError, match="item 2: a spline waypoint needs a latitude"):
        straightened(Draft("copter", "").take_off(5).add(c.NAV_SPLINE_WAYPOINT, z=3.0).file())
