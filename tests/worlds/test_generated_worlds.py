# SPDX-License-Identifier: BSD-3-Clause
"""Worlds from a seed: the same everywhere, with ways to everywhere, more difficult as one asks."""

from __future__ import annotations

import pytest

from sitl import worlds
from sitl.envs.robots.turtlebot import Turtlebot
from sitl.envs.starts import ReachableCells
from sitl.worlds import WorldError
from sitl.worlds.generated import generate


def reach(world):
    """Share of the world's area that a robot of 0.18 m can get to from the start."""
    robot = Turtlebot(world, 1)
    cells = ReachableCells(robot)
    x0, y0, x1, y1 = robot.world.bounds
    return len(cells.cells) * cells.cell**2 / ((x1 - x0) * (y1 - y0))


@pytest.mark.parametrize("kind", ["forest", "rooms", "labyrinth"])
@pytest.mark.parametrize("difficulty", [0.0, 0.5, 1.0])
def test_one_can_get_to_every_room(kind, difficulty):
    for seed in range(4):
        assert reach(f"{kind}:seed={seed},difficulty={difficulty}") > 0.55


@pytest.mark.parametrize("kind", ["forest", "rooms", "labyrinth"])
def test_a_text_is_one_world(kind):
    text = f"{kind}:seed=3,difficulty=0.7"
    assert generate(text) == generate(text) != generate(f"{kind}:seed=4,difficulty=0.7")
    assert worlds.load(text).name == f"{text},size={40 if kind == 'forest' else 20},scale=1"
    assert worlds.load(worlds.load(text).name) == worlds.load(text)
    easy, hard = (len(generate(f"{kind}:seed=3,difficulty={d}").solids) for d in (0, 1))
    assert hard > 2 * easy


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("forest:sed=1", "'sed' is not known; there are seed, difficulty, size, scale"),
        ("forest:seed=x", "seed='x' is no number"),
        ("forest:seed=-1", "seed must be 0"),
        ("rooms:difficulty=1.5", "difficulty must be 0 .. 1"),
        ("rooms:difficulty=nan", "difficulty must be 0 .. 1"),
        ("labyrinth:size=5", "size must be 10 .. 200 m"),
        ("wood", 'one of circuit.*"forest:seed=1"'),
    ],
)
def test_what_cannot_be_made_is_said(text, says):
    with pytest.raises(WorldError, match=says):
        worlds.load(text)
