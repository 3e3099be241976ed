# SPDX-License-Identifier: BSD-3-Clause
"""Numbers of actions outside of their box are clipped, or refused by choice; what is no number is always refused."""

from __future__ import annotations

import math

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.error import InvalidAction

from sitl.envs import EnvOptionError
from sitl.envs.actions import VELOCITY, Continuous, Discrete, Normalised

OPTIONS = {"action": "continuous", "world": "maze"}
ULP = float(np.nextafter(np.float32(0.3), np.float32(1.0)))


def make(**options):
    env = gym.make("sitl/Navigate-v1", **OPTIONS, **options)
    env.reset(seed=1)
    return env


def make_vec(**options):
    robots = gym.make_vec("sitl/Navigate-v1", num_envs=2, **OPTIONS, **options)
    robots.reset(seed=1)
    return robots


@pytest.mark.parametrize(
    ("given", "taken"),
    [([0.4, 0.0], [0.3, 0.0]), ([-1.0, -9.0], [0.0, -0.3]), (np.array([ULP, 0.1], np.float32), [0.3, 0.1]),
     (np.array([9, 0]), [0.3, 0.0])],
)  # fmt: skip
def test_an_action_outside_of_its_box_is_the_nearest_one_within(given, taken):
    clipped, same = make(), make()
    assert np.array_equal(clipped.step(given)[0], same.step(taken)[0])
    action = clipped.unwrapped.session.actions[0].astype(np.float32)
    assert clipped.action_space.contains(action) and np.allclose(action, taken, atol=1e-7)


@pytest.mark.parametrize("kind", [np.float32, np.float64, list])
def test_robots_of_a_vector_have_their_actions_clipped(kind):
    rows = [[0.4, 0.0], [0.2, -7.0]]
    robots, same = make_vec(), make_vec()
    seen = robots.step(rows if kind is list else np.array(rows, kind))[0]
    assert np.array_equal(seen, same.step(np.array([[0.3, 0.0], [0.2, -0.3]], np.float32))[0])


@pytest.mark.parametrize("action", [[0.4, 0.0], [0.1, ULP]])
def test_without_clipping_it_is_refused(action):
    with pytest.raises(InvalidAction, match=r"forward \[m/s\] 0 .. 0.3, turn \[rad/s\] -0.3 .. 0.3"):
        make(clip_actions=False).step(action)
    with pytest.raises(InvalidAction, match=r"forward \[m/s\] 0 .. 0.3"):
        make_vec(clip_actions=False).step(np.array([[0.1, 0.0], action]))


@pytest.mark.parametrize("clip_actions", [True, False])
@pytest.mark.parametrize("number", [math.nan, math.inf, -math.inf])
def test_what_is_not_finite_is_refused_in_any_case(number, clip_actions):
    with pytest.raises(InvalidAction, match="turn"):
        make(clip_actions=clip_actions).step([0.1, number])
    with pytest.raises(InvalidAction, match="turn"):
        make_vec(clip_actions=clip_actions).step(np.array([[0.1, 0.0], [9.0, number]]))


def test_a_choice_that_is_none_is_refused():
    with pytest.raises(EnvOptionError, match="clip_actions = 1; it must be True or False"):
        make(clip_actions=1)


def test_the_action_nearest_to_a_set_point():
    """Columns of a table count by their range; in a box each number is as near as its limits let it be."""
    table = Discrete(VELOCITY, {"stay": (0, 0, 0, 0), "ahead": (4, 0, 0, 0), "turn": (0, 0, 0, 1)})
    for command, number in (((1.9, 0, 0, 0), 0), ((2.1, 0, 0, 0), 1), ((0, 0, 0, 0.6), 2), ((1.8, 9, 9, 0.4), 0)):
        assert table.nearest(np.array(command)) == number, command
    box = Continuous(VELOCITY, (-2.0, -1.0), (4.0, 1.0), (0, 3))
    assert box.nearest(np.array([1.5, 9.0, 9.0, 0.5])).tolist() == [1.5, 0.5]
    assert box.nearest(np.array([9.0, 9.0, 9.0, -9.0])).tolist() == [4.0, -1.0]
    normalised = Normalised(box)
    assert normalised.nearest(np.array([1.0, 9.0, 9.0, 0.5])).tolist() == [0.0, 0.5], "the middle is 0"
    assert normalised.nearest(np.array([-9.0, 9.0, 9.0, 9.0])).tolist() == [-1.0, 1.0]
    for command in ((-1.0, 0.0, 0.0, 0.25), (3.0, 0.0, 0.0, -1.0)):
        for action in (box, normalised):
            row, out = action.buffer(1), np.zeros((1, 4))
            row[0] = action.nearest(np.array(command))
            action.commands(row, out)
            assert out[0].tolist() == pytest.approx(command)
