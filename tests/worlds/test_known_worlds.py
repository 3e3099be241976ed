# SPDX-License-Identifier: BSD-3-Clause
"""The worlds of the package are those of gym-gazebo: scans, outlines and clearances of independent making."""

from __future__ import annotations

import math
import pickle

import numpy as np
import pytest

from sitl import worlds
from sitl.core.algebra import quat_from_euler
from sitl.core.vectors import Euler
from sitl.worlds import contact, planar, raycast
from sitl.worlds.outline import outline
from tests.worlds.world_cases import KNOWN, LIDARS

SCANNED = [name for name, known in KNOWN.items() if "scan" in known]
OUTLINES = [(name, height) for name, known in KNOWN.items() for height in known.get("outlines", {})]


def start_scan(name: str) -> np.ndarray:
    """What the lidar of the world's own robot publishes at the start pose, as the original's would."""
    world = worlds.load(name)
    robot = {"maze_erlerover": "erle_rover", "office_erlecopter": "erle_copter"}.get(name, "turtlebot")
    cast, published, longest, (forward, left, above) = LIDARS[robot]
    start = world.start(robot)
    north, east, down = start.north_east_down
    attitude = np.array([quat_from_euler(Euler(0.0, 0.0, start.heading))])
    position = np.array([[north, east, down]])
    mount = np.array([forward, -left, -above - down])  # heights are given above the floor
    rays = planar.rays(cast, math.radians(270.0))
    ranges = raycast.scan_from(world.geometry, position, attitude, mount, rays, np.zeros((1, cast)))
    return planar.publish(ranges[0], longest, np.zeros(published))


@pytest.mark.parametrize("name", SCANNED)
def test_scan_at_the_start(name: str) -> None:
    known = KNOWN[name]["scan"]
    longest = 10.0 if name == "office_erlecopter" else 20.0
    scan = np.minimum(start_scan(name), longest)
    assert scan[known["sampled_indices"]] == pytest.approx(known["sampled_ranges"], abs=0.001)
    assert scan.min() == pytest.approx(known["min_range"], abs=0.001)
    if "all" in known:
        assert scan == pytest.approx(known["all"], abs=0.001)


@pytest.mark.parametrize("name", SCANNED)
def test_discretised_observation(name: str) -> None:
    known, scan = KNOWN[name]["scan"], start_scan(name)
    nothing = 10 if name == "office_erlecopter" else 20
    step = known["published_ranges"] // 5
    observation = [nothing if math.isinf(r) else int(r) for r in scan[::step]]
    assert observation == known["discretised"]
    assert len(scan) == known["published_ranges"]
    angles = np.degrees(planar.angles(len(scan), math.radians(270.0)))[known["sampled_indices"]]
    assert angles == pytest.approx(known["sampled_angles_deg"], abs=0.01)


@pytest.mark.parametrize("name", list(KNOWN))
def test_extent_and_start(name: str) -> None:
    known, world = KNOWN[name], worlds.load(name)
    assert [sum(isinstance(s, kind) for s in world.solids) for kind in (worlds.Box, worlds.Cylinder)] == known.get(
        "solids", [0, 0]
    )
    start = world.starts[0]
    assert (*start.position, start.yaw) == pytest.approx(known["start"], abs=1e-12)
    if "bounds" not in known:
        return
    corners = np.concatenate([s.footprint() for s in world.solids])
    assert [*corners.min(axis=0), *corners.max(axis=0)] == pytest.approx(known["bounds"], abs=0.0011)
    n, e, _ = start.north_east_down
    free = contact.clearance(world.geometry, n, e, -world.plan_height - 0.001, -world.plan_height, 0.0)
    assert free.distance == pytest.approx(known["clearance"], abs=0.001)


@pytest.mark.parametrize(("name", "height"), OUTLINES)
def test_solid_at_a_height(name: str, height: str) -> None:
    """Points about the walls: solid here and there, or free here and there."""
    world, cut = worlds.load(name), float(height)
    theirs = np.array(KNOWN[name]["outlines"][height], dtype=np.float64)
    points = _along(theirs)
    points = points + np.random.default_rng(0).uniform(-0.3, 0.3, points.shape)
    (x1, y1), (x2, y2) = theirs.T[:2, :, None], theirs.T[2:, :, None]
    x, y = points.T[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        crossed = ((y1 > y) != (y2 > y)) & (x < x1 + (x2 - x1) * (y - y1) / (y2 - y1))
    solid_there = crossed.sum(axis=0) % 2 == 1
    here = [contact.clearance(world.geometry, px, -py, -cut, -cut, 0.0).distance for px, py in points.tolist()]
    clear = np.abs(here) > _tolerance(world)
    assert ((np.array(here) < 0.0) == solid_there)[clear].all()
    assert solid_there[clear].any() and not solid_there[clear].all()


@pytest.mark.parametrize(("name", "height"), OUTLINES)
def test_outline_at_a_height(name: str, height: str) -> None:
    world, cut = worlds.load(name), float(height)
    ours, theirs = outline(world, cut), np.array(KNOWN[name]["outlines"][height], dtype=np.float64)
    way, length = ours[:, 2:] - ours[:, :2], np.hypot(*(ours[:, 2:] - ours[:, :2]).T)
    right = np.stack([way[:, 1], -way[:, 0]], axis=1) / length[:, None]
    round_ones = any(isinstance(s, worlds.Cylinder) for s in world.solids)  # a polygon is not the circle
    for side, sign in ((right, 1.0), (-right, -1.0)):
        points = (ours[:, :2] + 0.5 * way + 0.0006 * side)[length > 0.03]
        for x, y in points.tolist() if not round_ones else []:
            found = contact.clearance(world.geometry, x, -y, -cut, -cut, 0.0).distance
            assert sign * found > 0.0, "free on the right, solid on the left"
    assert _farthest(_along(ours), theirs) < _tolerance(world)
    lengths = [np.hypot(*(s[:, 2:] - s[:, :2]).T).sum() for s in (ours, theirs)]
    assert 0.97 * lengths[1] < lengths[0] < 1.001 * lengths[1], "theirs has the seams between walls that touch, too"


def _tolerance(world: worlds.World) -> float:
    """Their points are rounded to 1 mm and smaller corners left out; a circle is a polygon of 32 corners to them."""
    return max([0.003, *(0.0055 * s.radius for s in world.solids if isinstance(s, worlds.Cylinder))])


def _along(segments: np.ndarray) -> np.ndarray:
    """Points along segments, both ends and between, shape (n, 2)."""
    return np.concatenate([segments[:, :2] + f * (segments[:, 2:] - segments[:, :2]) for f in np.linspace(0, 1, 9)])


def _farthest(points: np.ndarray, segments: np.ndarray) -> float:
    """Greatest distance from a point to the nearest of the segments."""
    start, way = segments[:, :2], segments[:, 2:] - segments[:, :2]
    along = np.einsum("psi,si->ps", points[:, None] - start, way) / np.maximum((way**2).sum(axis=1), 1e-12)
    nearest = start + np.clip(along, 0.0, 1.0)[..., None] * way
    return float(np.hypot(*(points[:, None] - nearest).transpose(2, 0, 1)).min(axis=1).max())


def test_windows_of_the_office() -> None:
    """A window in the east wall: open at 1 m, its sill below and the wall above are not."""
    geometry = worlds.load("office_erlecopter").geometry
    ranges = []
    for height in (0.3, 1.0, 1.6):
        origin = np.array([0.0, 1.1795, -height])
        ranges.append(float(raycast.scan(geometry, origin, np.array([[1.0], [0.0], [0.0]]), np.zeros(1))[0]))
    assert ranges[1] == math.inf
    assert [ranges[0], ranges[2]] == pytest.approx([4.038, 4.038], abs=0.01)


def test_a_lidar_that_tilts_sees_the_floor() -> None:
    world = worlds.load("office_erlecopter")
    attitude = np.array([quat_from_euler(Euler(0.0, math.radians(-20.0), math.pi))])  # nose down, westward
    ray = np.array([[1.0], [0.0], [0.0]])
    position, mount = np.array([[0.0, 0.0, -1.0]]), np.zeros(3)
    found = raycast.scan_from(world.geometry, position, attitude, mount, ray, np.zeros((1, 1)))
    assert found[0, 0] == pytest.approx(1.0 / math.sin(math.radians(20.0)), abs=1e-9)


def test_names_are_the_files_and_load_at_any_spelling() -> None:
    assert set(worlds.names()) == {path.stem for path in worlds._DATA.glob("*.toml")} == {*KNOWN, "open"}
    for name in worlds.names():
        assert worlds.load(name).name == name
        assert worlds.load(name).description and (worlds.load(name).source or name == "open")
    assert worlds.load("Office-ErleCopter") is worlds.load("office_erlecopter")
    assert worlds.load(worlds.load("maze")) is worlds.load("maze")
    with pytest.raises(worlds.WorldError, match=r"world 'mars' is not known; it is one of circuit, circuit2, .*\.toml"):
        worlds.load("mars")
    with pytest.raises(worlds.WorldError, match="neither a name"):
        worlds.load(3)  # type: ignore[arg-type]


def test_start_poses() -> None:
    office = worlds.load("office_erlecopter")
    assert office.start("erle_copter").position[2] == 0.08
    assert office.start("turtlebot").position[2] == office.start(name="floor").position[2] == 0.0
    assert worlds.load("maze").start("anyone").name == "original"
    with pytest.raises(worlds.WorldError, match="has no start 'roof'; it has original, floor"):
        office.start(name="roof")
    start = worlds.Start("s", (1.0, 2.0, 3.0), 0.5)
    assert start.north_east_down == (1.0, -2.0, -3.0) and start.heading == -0.5


def test_worlds_pickle() -> None:
    world = worlds.load("maze")
    copy = pickle.loads(pickle.dumps(world))
    assert copy == world
    assert np.array_equal(copy.geometry.solids, world.geometry.solids)
    assert np.array_equal(copy.geometry.cells, world.geometry.cells)
