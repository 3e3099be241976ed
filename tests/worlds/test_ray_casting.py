# SPDX-License-Identifier: BSD-3-Clause
"""Ranges: by grid, by brute force and in plain Python the same bits; and true by what lies along the ray."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.core.algebra import quat_from_euler, rotate
from sitl.core.vectors import Euler, Quat, Vec2, Vec3
from sitl.worlds import contact, planar, raycast
from sitl.worlds.geometry import Floats, Geometry, compile_geometry
from tests.worlds.world_cases import LIDARS, fans, points, random_solids, worlds, yaws


def walked(geometry: Geometry, point: tuple[float, float, float], fan: Floats) -> Floats:
    out = np.full(fan.shape[1], -1.0)
    raycast.walked(geometry.arrays, Vec3(*point), fan, out)
    return out


def swept(geometry: Geometry, point: tuple[float, float, float], fan: Floats, reach: float = math.inf) -> Floats:
    out = np.full(fan.shape[1], -1.0)
    raycast.swept(geometry.arrays, Vec3(*point), fan, reach, out)
    return out


@given(worlds, points, fans())
def test_the_grid_gives_the_bits_of_brute_force(
    geometry: Geometry, point: tuple[float, float, float], fan: Floats
) -> None:
    assert walked(geometry, point, fan).tobytes() == swept(geometry, point, fan).tobytes()


@given(worlds, points, fans())
def test_plain_python_gives_the_same_bits(geometry: Geometry, point: tuple[float, float, float], fan: Floats) -> None:
    plain = np.zeros(fan.shape[1])
    raycast.sweep_rays(geometry.arrays, Vec3(*point), fan, math.inf, plain)
    assert plain.tobytes() == swept(geometry, point, fan).tobytes()
    raycast.walk_rays(geometry.arrays, Vec3(*point), fan, plain)
    assert plain.tobytes() == swept(geometry, point, fan).tobytes()


@given(worlds, points, fans(), st.sampled_from((0.0, 0.5, 3.0, 10.0)))
def test_what_is_in_reach_is_not_left_out(
    geometry: Geometry, point: tuple[float, float, float], fan: Floats, reach: float
) -> None:
    found = swept(geometry, point, fan, reach)
    assert np.minimum(found, reach).tobytes() == np.minimum(walked(geometry, point, fan), reach).tobytes()


@given(worlds, points, st.sampled_from((65, 70, 140, 541)), st.floats(0.0, 2.0 * math.pi), st.tuples(yaws, yaws, yaws))
def test_what_is_beside_a_group_of_rays_is_left_out_and_nothing_else(
    geometry: Geometry, point: tuple[float, float, float], count: int, view: float, angles: tuple[float, float, float]
) -> None:
    """A lidar's rays, level and tilted any way, and the same in disorder: then they are no fan."""
    rays, q = planar.rays(count, view), quat_from_euler(Euler(*angles))
    fan = np.ascontiguousarray(np.array([rotate(q, Vec3(*ray)) for ray in rays.T]).T)
    for some in (rays, fan, np.ascontiguousarray(np.random.default_rng(1).permutation(fan, axis=1))):
        for reach in (2.0, math.inf):
            expected = np.minimum(walked(geometry, point, some), reach)
            assert np.minimum(swept(geometry, point, some, reach), reach).tobytes() == expected.tobytes()


@pytest.mark.parametrize("count", [3, 60, 400])
@pytest.mark.parametrize("cells_each", [0, 1, 6, 60])
def test_the_grid_gives_the_bits_of_brute_force_in_large_worlds(count: int, cells_each: int) -> None:
    half = 2.0 * math.sqrt(count)
    geometry = compile_geometry(random_solids(count, seed=count, half=half), 0.0, cells_each)
    rng = np.random.default_rng(7)
    for _ in range(40):
        n, e, d = rng.uniform(-1.5 * half, 1.5 * half), rng.uniform(-1.5 * half, 1.5 * half), -rng.uniform(0.0, 2.5)
        fan = rng.normal(size=(3, 64)) * [[1.0], [1.0], [0.2]]
        fan /= np.linalg.norm(fan, axis=0)
        found = walked(geometry, (n, e, d), np.ascontiguousarray(fan))
        assert found.tobytes() == swept(geometry, (n, e, d), np.ascontiguousarray(fan)).tobytes()
        assert np.isfinite(found).any()


@given(worlds, points, fans())
def test_the_way_to_a_hit_is_free_and_its_end_is_not(
    geometry: Geometry, point: tuple[float, float, float], fan: Floats
) -> None:
    """Against distances (another computation): nowhere along a ray before its range is there a solid."""
    ranges = swept(geometry, point, fan)
    origin = np.array(point)
    for direction, reached in zip(fan.T, ranges):
        for fraction in (0.0, 0.3, 0.7, 0.999):
            length = fraction * min(reached, 20.0)
            if reached > 0.0:
                assert _distance(geometry, origin + length * direction) > -1e-9
        if reached < math.inf:
            assert _distance(geometry, origin + reached * direction) < 1e-9


def _distance(geometry: Geometry, point: Floats) -> float:
    n, e, d = (float(x) for x in point)
    nearest = contact.nearest_of(geometry.solids, len(geometry), contact.Volume(Vec2(n, e), d, d, 0.0)).distance
    return min(nearest, geometry.floor - d)


def test_from_inside_below_and_nowhere() -> None:
    geometry = compile_geometry(random_solids(1, 0, half=0.1), 0.0)
    up, down, north = (np.array([[float(k == a)] for k in range(3)]) for a in (2, 2, 0))
    up = -up
    n, e = geometry.solids[0, :2]
    assert swept(geometry, (n, e, -0.5), north)[0] == 0.0, "inside of a solid"
    assert swept(geometry, (50.0, 0.0, 0.1), north)[0] == 0.0, "below the floor"
    assert swept(geometry, (50.0, 0.0, -3.0), down)[0] == 3.0
    assert swept(geometry, (50.0, 0.0, -3.0), up)[0] == math.inf
    empty = compile_geometry([], -1.0)
    assert walked(empty, (0.0, 0.0, -3.0), down)[0] == swept(empty, (0.0, 0.0, -3.0), down)[0] == 4.0
    assert walked(empty, (0.0, 0.0, -3.0), north)[0] == math.inf


def test_many_bodies_in_one_call_see_what_each_alone_sees() -> None:
    geometry = compile_geometry(random_solids(25, 3), 0.0)
    rng = np.random.default_rng(0)
    positions = np.concatenate([rng.uniform(-8, 8, (6, 2)), rng.uniform(-1, 0, (6, 1))], axis=1)
    attitudes = np.array([quat_from_euler(Euler(*rng.uniform(-0.3, 0.3, 2), rng.uniform(-3, 3))) for _ in range(6)])
    mount, rays = np.array([0.15, 0.0, -0.1]), planar.rays(36, math.radians(270.0))
    together = raycast.scan_from(geometry, positions, attitudes, mount, rays, np.zeros((6, 36)))
    for i in range(6):
        alone = raycast.scan_from(geometry, positions[i : i + 1], attitudes[i : i + 1], mount, rays, np.zeros((1, 36)))
        assert alone.tobytes() == together[i].tobytes()
        origin = positions[i] + rotate(Quat(*attitudes[i]), Vec3(*mount))
        directions = np.array([rotate(Quat(*attitudes[i]), Vec3(*ray)) for ray in rays.T]).T
        by_hand = raycast.scan(geometry, origin, np.ascontiguousarray(directions), np.zeros(36))
        assert by_hand == pytest.approx(together[i], rel=1e-12)


def test_published_readings_lie_between_rays() -> None:
    """Gazebo's rule: position i * (rays - 1) / (readings - 1), a weighted mean; beyond the range is inf."""
    cast = np.array([1.0, 2.0, math.inf, 30.0, 4.0])
    assert planar.publish(cast, 20.0, np.zeros(5)).tolist() == [1.0, 2.0, math.inf, math.inf, 4.0]
    assert planar.publish(cast, 20.0, np.zeros(3)).tolist() == [1.0, math.inf, 4.0]
    assert planar.publish(cast, 20.0, np.zeros(2)).tolist() == [1.0, 4.0]
    assert planar.publish(cast[:3], 20.0, np.zeros(2)).tolist() == [1.0, math.inf]
    assert planar.publish(cast[:4], 20.0, np.zeros(3)).tolist() == [1.0, 11.0, math.inf]
    assert planar.publish(cast[:1], 20.0, np.zeros(1)).tolist() == [1.0]
    for rays, published, longest, _ in LIDARS.values():
        readings = planar.publish(np.full(rays, longest), longest, np.zeros(published))
        assert (readings == math.inf).all(), "no reading of the full range is lost to rounding"


def test_angles_run_from_right_to_left() -> None:
    rays = planar.rays(3, math.radians(180.0))
    assert pytest.approx(np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]), abs=1e-15) == rays.T
    assert planar.angles(1, 1.0).tolist() == [0.0]


SCAN = """
import numpy as np
from sitl import worlds
from sitl.worlds import contact, planar, raycast
g = worlds.load("maze").geometry
out = raycast.scan(g, np.array([0.1, -0.2, -0.5]), planar.rays(40, 4.7), np.zeros(40))
print(out.tobytes().hex(), contact.clearance(g, 0.1, -0.2, -0.5, 0.0, 0.178))
"""


def test_without_numba_the_same() -> None:
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    said = [
        subprocess.run(
            [sys.executable, "-c", SCAN],
            env={**environment, "NUMBA_DISABLE_JIT": off},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for off in "01"
    ]
    assert said[0] == said[1] and len(said[0]) > 640
