# SPDX-License-Identifier: BSD-3-Clause
"""Distances between robots and solids, against sampling of their volumes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from sitl.core.vectors import Vec2
from sitl.worlds import contact
from sitl.worlds.contact import Contact, Volume
from sitl.worlds.geometry import Floats, Geometry, compile_geometry
from sitl.worlds.shapes import Box, Cylinder, Solid
from tests.worlds.world_cases import lengths, random_solids, solids, worlds

radii = st.sampled_from((0.0, 0.178, 1.0))
heights = st.sampled_from((0.1, 0.42, 2.0))
GRAIN = 0.02


def surface(solid: Solid) -> Floats:
    """Points of the solid's surface in its file's frame, shape (n, 3), GRAIN of its size apart along each axis."""
    steps = np.linspace(-1.0, 1.0, round(2.0 / GRAIN) + 1)
    levels = np.linspace(solid.low, solid.high, len(steps))
    if isinstance(solid, Cylinder):
        angle = math.pi * steps
        rim = solid.radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        disc = np.concatenate([rim * r for r in np.linspace(0.0, 1.0, len(steps) // 2)])
    else:
        a, b = np.meshgrid(steps, steps)
        disc = 0.5 * np.stack([a.ravel() * solid.size[0], b.ravel() * solid.size[1]], axis=1)
        edge = np.abs(np.stack([a.ravel(), b.ravel()])).max(axis=0) == 1.0
        c, s = math.cos(solid.yaw), math.sin(solid.yaw)
        disc = disc @ np.array([[c, s], [-s, c]])
        rim = disc[edge]
    middle = np.array(solid.centre[:2])
    caps = [np.column_stack([disc + middle, np.full(len(disc), z)]) for z in (solid.low, solid.high)]
    sides = np.column_stack([np.repeat(rim + middle, len(levels), axis=0), np.tile(levels, len(rim))])
    return np.concatenate([*caps, sides])


def from_robot(points: Floats, x: float, y: float, low: float, high: float, radius: float) -> Floats:
    """Distances from points to the robot's cylinder, 0 inside of it."""
    level = np.maximum(np.hypot(points[:, 0] - x, points[:, 1] - y) - radius, 0.0)
    upright = np.maximum(np.maximum(low - points[:, 2], points[:, 2] - high), 0.0)
    return np.hypot(level, upright)


def longest(solid: Solid) -> float:
    sides = solid.size if isinstance(solid, Box) else (2.0 * math.pi * solid.radius, solid.height)
    return max(sides)


@given(solids, lengths, lengths, lengths, heights, radii)
def test_distance_against_sampling(solid: Solid, x: float, y: float, low: float, height: float, radius: float) -> None:
    geometry = compile_geometry([solid], -50.0)
    found = contact.clearance(geometry, x, -y, -(low + height), -low, radius)
    sampled = float(from_robot(surface(solid), x, y, low, low + height, radius).min())
    grain = GRAIN * longest(solid)
    if sampled > 0.0:
        inside = found.distance < -1e-9  # the robot is inside of the solid and touches no point of its surface
        assert inside or sampled - grain <= found.distance <= sampled + 1e-9
    else:
        assert found.distance <= 1e-9
    assert np.linalg.norm(found.normal) == pytest.approx(1.0)
    assert found.solid == 0


@given(solids, lengths, lengths, lengths, heights, radii)
def test_the_normal_is_the_shortest_way_out(
    solid: Solid, x: float, y: float, low: float, height: float, radius: float
) -> None:
    rows = compile_geometry([solid], -50.0).solids

    def at(move: Floats) -> Contact:
        n, e, d = move.tolist()
        return contact.separation(rows, 0, Volume(Vec2(x + n, e - y), d - (low + height), d - low, radius))

    def distance(move: Floats) -> float:
        return at(move).distance

    here, normal, _ = at(np.zeros(3))
    assume(abs(here) > 1e-6)
    way = np.array(normal)
    assert distance(-here * way) == pytest.approx(0.0, abs=1e-9), "along the normal it is as far as is said"
    if here > 0.0:
        assert distance(0.5 * way) == pytest.approx(here + 0.5)
    for angle in np.arange(16) * (math.pi / 8):
        for rise in (-1.0, -0.4, 0.0, 0.4, 1.0):
            other = np.array([math.cos(angle) * math.sqrt(1 - rise**2), math.sin(angle) * math.sqrt(1 - rise**2), rise])
            short = 0.999 * abs(here) * other
            if here > 0.0:
                assert distance(short) > 0.0, "no shorter way touches"
            else:
                assert distance(short) < 0.0, "no shorter way separates"


@given(worlds, lengths, lengths)
def test_the_nearest_of_all(geometry: Geometry, n: float, e: float) -> None:
    found = contact.clearance(geometry, n, e, -0.4, 0.0, 0.2)
    robot = Volume(Vec2(n, e), -0.4, 0.0, 0.2)
    each = [contact.separation(geometry.solids, k, robot).distance for k in range(len(geometry))]
    assert found.distance == min(each, default=math.inf)
    assert found.solid == (each.index(min(each)) if each else -1)


@given(worlds, lengths, lengths, st.sampled_from((0.0, 1.0, 3.0, 50.0)), st.integers(1, 8))
def test_solids_near_a_place(geometry: Geometry, n: float, e: float, reach: float, room: int) -> None:
    rows = contact.rows(room)
    count, complete = contact.near(geometry, n, e, reach, rows)
    distances = sorted(contact.beside(geometry.solids, k, Vec2(n, e)).distance for k in range(len(geometry)))
    wanted = [d for d in distances if d <= reach][:room]
    assert [contact.beside(rows, k, Vec2(n, e)).distance for k in range(count)] == wanted
    left = distances[len(wanted) :]
    assert complete == (left[0] if left else math.inf)


def test_the_short_list_tells_all_contacts_while_it_is_complete() -> None:
    geometry = compile_geometry(random_solids(60, 5), 0.0)
    rng, rows = np.random.default_rng(1), contact.rows(8)
    for _ in range(200):
        n, e = rng.uniform(-10, 10, 2)
        count, complete = contact.near(geometry, n, e, 2.0, rows)
        turn, far = rng.uniform(-math.pi, math.pi), max(complete, 0.0) * rng.uniform()
        n2, e2 = n + far * math.cos(turn), e + far * math.sin(turn)
        radius = 0.999 * (max(complete, 0.0) - far)
        listed = contact.nearest_of(rows, count, Volume(Vec2(n2, e2), -0.4, 0.0, radius)).distance
        everything = contact.clearance(geometry, n2, e2, -0.4, 0.0, radius).distance
        assert min(listed, 0.0) == min(everything, 0.0)
        assert everything > 0.0 or listed == everything


def test_above_and_below_do_not_touch() -> None:
    """A copter over a wall, under a lintel, landing on a tread."""
    wall = compile_geometry([Box((0.0, 0.0, 0.5), (2.0, 0.15, 1.0))], 0.0)
    over = contact.clearance(wall, 0.0, 0.0, -1.6, -1.2, 0.3)
    assert over.distance == pytest.approx(0.2) and over.normal == (0.0, 0.0, -1.0)
    lintel = compile_geometry([Box((0.0, 0.0, 2.25), (2.0, 0.15, 0.5))], 0.0)
    under = contact.clearance(lintel, 0.0, 0.0, -1.6, -1.2, 0.3)
    assert under.distance == pytest.approx(0.4) and under.normal == (0.0, 0.0, 1.0)
    resting = contact.clearance(wall, 0.0, 0.0, -1.39, -0.99, 0.3)
    assert resting.distance == pytest.approx(-0.01) and resting.normal == (0.0, 0.0, -1.0)
    beside = contact.clearance(wall, 0.0, 0.3, -0.5, -0.1, 0.178)
    assert beside.distance == pytest.approx(0.3 - 0.075 - 0.178) and beside.normal == pytest.approx((0.0, 1.0, 0.0))


def test_no_solids() -> None:
    found = contact.clearance(compile_geometry([], 0.0), 0.0, 0.0, -1.0, 0.0, 0.2)
    assert (found.distance, found.solid) == (math.inf, -1)
    assert contact.near(compile_geometry([], 0.0), 0.0, 0.0, 5.0, contact.rows(4)) == (0, math.inf)
