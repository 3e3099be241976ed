# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of a world: depths are those of single rays, and colours those of the solids."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sitl import worlds
from sitl.core.algebra import quat_from_euler, rotate
from sitl.core.vectors import Euler, Quat, Vec3
from sitl.worlds.camera import Camera, Photographer
from sitl.worlds.raycast import scan
from sitl.worlds.shapes import Box, Cylinder, Marking, Start
from sitl.worlds.world import World

REACH = 20.0
OPTICS = Camera(32, 24, math.tan(math.radians(45.0)), REACH)


def place(x, y, z, yaw=0.0, pitch=0.0, roll=0.0):
    """A camera in the frame of world files, pitch up."""
    return [x, -y, -z, *quat_from_euler(Euler(roll, pitch, -yaw))]


def workspace(*solids, markings=()):
    return World("room", solids, (Start("here", (0.0, 0.0, 0.0), 0.0),), markings=markings)


@pytest.mark.parametrize("name", ["forest:seed=1", "rooms:seed=2", "office_erlecopter", "circuit2"])
def test_depths_are_those_of_single_rays_from_anywhere(name):
    world, rng = worlds.load(name), np.random.default_rng(3)
    x0, y0, x1, y1 = world.bounds
    cameras = [
        place(rng.uniform(x0, x1), rng.uniform(y0, y1), rng.uniform(0.1, 9.0), *rng.uniform(-3.0, 3.0, 3))
        for _ in range(30)
    ]
    depths = Photographer(world, OPTICS).depths(np.array(cameras))
    assert depths.shape == (30, 24, 32)
    assert depths.dtype == np.float32
    u = OPTICS.slope * (2.0 * (np.arange(32) + 0.5) / 32 - 1.0)
    v = OPTICS.slope * (2.0 * (np.arange(24) + 0.5) - 24) / 32
    for camera, picture in zip(np.array(cameras), depths):
        q, out = Quat(*camera[3:]), np.zeros(32)
        for row in range(24):
            rays = [Vec3(1.0, float(a), float(v[row])) for a in u]
            lengths = np.array([math.sqrt(1.0 + r.y * r.y + r.z * r.z) for r in rays])
            turned = np.array([rotate(q, r) for r in rays]).T / lengths
            scan(world.geometry, camera[:3].copy(), np.ascontiguousarray(turned), out)
            assert picture[row] == pytest.approx(np.minimum(out / lengths, REACH), abs=1e-4)


def test_a_wall_is_as_deep_everywhere_and_the_sky_is_far():
    world = workspace(Box((5.0, 0.0, 50.0), (1.0, 100.0, 200.0)))
    ahead, behind = Photographer(world, OPTICS).depths(
        np.array([place(0.0, 0.0, 3.0, 0.0, 0.3), place(0.0, 0.0, 3.0, math.pi, 0.8)])
    )
    assert ahead[0, 0] > ahead[12, 0] > 4.5, "of a camera that looks up the upper rays come to the wall last"
    assert ahead[0] == pytest.approx(np.full(32, ahead[0, 0]), rel=1e-6)
    assert (behind == REACH).all()
    level = Photographer(world, OPTICS).depths(np.array([place(0.0, 0.0, 30.0)]))
    assert level == pytest.approx(np.full((1, 24, 32), 4.5), abs=1e-6)


def test_colours_are_those_of_solids_and_markings_in_the_sun():
    world = workspace(
        Box((5.0, 0.0, 1.0), (1.0, 1.0, 2.0), 0.0, "crate", "red"),
        Cylinder((-5.0, 0.0, 1.0), 0.5, 2.0, "post", "green"),
        markings=(Marking((0.0, 0.0), 1.0, colour="yellow"),),
    )
    pictures = Photographer(world, OPTICS).colours(
        np.array([place(0.0, 0.0, 1.0), place(0.0, 0.0, 1.0, math.pi), place(0.0, 0.0, 3.0, 0.0, -math.pi / 2)])
    )
    crate, post, pad = (picture[12, 16].astype(int) for picture in pictures)
    assert crate[0] > 2 * crate[1]
    assert crate[0] > 2 * crate[2]
    assert post[1] > 1.5 * post[0]
    assert pad[0] > pad[2] + 100
    assert pad[1] > pad[2] + 100
    sky, floor = pictures[0][0, 0].astype(int), pictures[2][12, 31].astype(int)
    assert sky[2] > sky[0]
    assert floor[0] == floor[1] == floor[2]


def test_sides_are_lit_differently():
    world = workspace(Box((0.0, 0.0, 1.0), (2.0, 2.0, 2.0), 0.0, "crate", "white"))
    around = [place(-4.0 * math.cos(a), -4.0 * math.sin(a), 1.0, a) for a in (0.0, math.pi / 2, math.pi)]
    above = place(0.0, 0.0, 6.0, 0.0, -math.pi / 2)
    sides = Photographer(world, OPTICS).colours(np.array([*around, above]))[:, 12, 16, 0].tolist()
    assert len(set(sides)) >= 3
    assert sides[3] == max(sides), "the sun stands high"


def test_a_camera_within_a_solid_sees_no_depth():
    world = workspace(Box((0.0, 0.0, 1.0), (2.0, 2.0, 2.0)))
    assert (Photographer(world, OPTICS).depths(np.array([place(0.0, 0.0, 1.0)])) == 0.0).all()
