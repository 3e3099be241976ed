# SPDX-License-Identifier: BSD-3-Clause
"""Free places of a world, as cells of a grid."""

import numpy as np
import pytest

from sitl import worlds
from sitl.envs import robots
from sitl.envs.starts import ReachableCells
from sitl.worlds import Box, Cylinder, World

CORNERS = (
    Box((2.0, 1.0, 0.5), (3.0, 0.2, 1.0), 0.7, "turned"),
    Box((-2.0, 0.0, 3.0), (1.0, 1.0, 1.0), 0.0, "overhead"),
    Box((-1.0, 2.5, 0.3), (0.8, 0.8, 0.1), 0.0, "shelf"),
    Cylinder((0.0, -2.0, 0.5), 0.6, 1.0, "post"),
)
OWN = World("own", CORNERS, worlds.load("open").starts)


@pytest.mark.parametrize("world", [OWN, worlds.load("rooms:seed=3,size=10,difficulty=1")], ids=["own", "rooms"])
def test_cells_are_free_that_are_as_far_from_solids_as_the_margin_says(world):
    robot = robots.load("turtlebot", worlds.load("open"), 1, {})
    cells = ReachableCells(robot, most=4000, world=world)
    free = cells._free(*cells.shape) == 1
    middle = cells.low + cells.cell * (np.argwhere(np.ones(cells.shape)) + 0.5)
    assert free.ravel().tolist() == [cells.is_free(x, y) for x, y in middle.tolist()]
    assert 0 < free.sum() < free.size


def test_reachable_are_the_free_cells_that_are_connected_to_the_start():
    wall = Box((2.0, 0.0, 0.5), (0.2, 30.0, 1.0), name="wall")
    ends = [Box((3.0, y, 0.5), (8.0, 0.2, 1.0), name="end") for y in (-6.0, 6.0)]
    robot = robots.load("turtlebot", worlds.load("open"), 1, {})
    cells = ReachableCells(robot, world=World("walled", (wall, *ends), worlds.load("open").starts))
    x = cells.low[0] + cells.cell * (cells.cells[:, 0] + 0.5)
    assert x.max() < 1.9 - robot.volume.radius
