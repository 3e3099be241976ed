# SPDX-License-Identifier: BSD-3-Clause
"""Depth and camera as observations: alone and in dicts, with rate, latency and noise."""

from __future__ import annotations

import pickle

import gymnasium as gym
import numpy as np
import pytest

from sitl.envs import EnvOptionError
from sitl.envs.pictures import Camera, Depth
from tests.envs.vector_equality import same

MAZE = {"robot": "turtlebot", "world": "maze", "action": "continuous", "start": "random"}


def make(observation, **options):
    return gym.make("sitl/Navigate-v1", **{**MAZE, "observation": observation, **options})


def drive(env, steps, seed=1):
    """Observations of an episode with the same actions."""
    rng = np.random.default_rng(0)
    seen = [env.reset(seed=seed)[0]]
    for _ in range(steps):
        seen.append(env.step(np.array([0.02, rng.uniform(-0.3, 0.3)], np.float32))[0])
    return seen


def test_depth_is_a_box_of_metres_that_the_lidar_agrees_with():
    env = make(Depth(65, 49, 90.0, 6.0))
    assert env.observation_space == gym.spaces.Box(0.0, 6.0, (49, 65), np.float32)
    seen = drive(env, 5)[-1]
    assert env.observation_space.contains(seen)
    robot = env.unwrapped.robot
    middle = np.interp(0.0, robot.angles, robot.scan[0])
    assert seen[24, 32] == pytest.approx(min(middle, 6.0), abs=0.1)
    assert seen[48, 32] < seen[24, 32] or seen[24, 32] < 0.6, "the floor is below"


@pytest.mark.parametrize(
    "observation",
    [
        "depth",
        "grey+velocity",
        {"d": Depth(16, 12, rate=1 / 1.2, latency=0.6, noise=0.05), "c": Camera(16, 12, noise=4.0), "n": ["velocity"]},
    ],
)
def test_vector_equals_singles_and_goes_on_from_snapshots_and_pickles(observation):
    options = {**MAZE, "observation": observation}
    vector = gym.make_vec("sitl/Navigate-v1", num_envs=3, **options)
    singles = gym.make_vec("sitl/Navigate-v1", num_envs=3, vectorization_mode="sync", **options)
    assert vector.observation_space == singles.observation_space
    vector.action_space.seed(1)
    assert same(vector.reset(seed=3)[0], singles.reset(seed=3)[0])
    ended = 0
    for _ in range(60):
        actions = vector.action_space.sample()
        got, expected = vector.step(actions), singles.step(actions)
        assert same(got[0], expected[0])
        ended += int(got[2].sum())
    assert ended > 0
    kept, copy = vector.unwrapped.snapshot(), pickle.loads(pickle.dumps(vector))
    after = vector.step(actions)[0]
    assert same(copy.step(actions)[0], after)
    vector.unwrapped.restore(kept)
    assert same(vector.unwrapped.observe(), got[0])
    assert same(vector.step(actions)[0], after)


def test_rate_and_latency_show_earlier_pictures():
    now = drive(make(Depth(16, 12)), 12)
    late = drive(make(Depth(16, 12, latency=1.2)), 12)
    slow = drive(make(Depth(16, 12, rate=1 / 1.8)), 12)
    both = drive(make(Depth(16, 12, rate=1 / 1.8, latency=1.2)), 12)
    for k in range(13):
        assert np.array_equal(late[k], now[max(k - 2, 0)]), k
        assert np.array_equal(slow[k], now[k // 3 * 3]), k
        assert np.array_equal(both[k], now[max((k - 2) // 3 * 3, 0)]), k


def test_noise_is_of_the_episode_and_of_the_size_that_was_asked_for():
    clean, a, b, other = (
        drive(make(Depth(64, 48, noise=noise)), 4, seed) for noise, seed in ((0.0, 1), (0.02, 1), (0.02, 1), (0.02, 2))
    )
    assert all(np.array_equal(x, y) for x, y in zip(a, b))
    assert not np.array_equal(a[0], other[0])
    inside = (clean[3] > 0.2) & (clean[3] < 19.0)
    assert np.std((a[3] - clean[3])[inside]) == pytest.approx(0.02, rel=0.1)


def test_a_camera_is_bytes_in_colour_or_grey():
    colour, grey = (drive(make(Camera(20, 10, grey=grey)), 2)[-1] for grey in (False, True))
    assert colour.shape == (10, 20, 3)
    assert grey.shape == (10, 20, 1)
    assert colour.dtype == grey.dtype == np.uint8
    assert len(np.unique(grey)) > 3


def test_a_copter_sees_what_is_ahead_of_where_it_really_is():
    env = gym.make("sitl/CopterForest-v0", observation={"depth": Depth(33, 25, reach=30.0), "n": ["goal", "scan"]})
    seen = env.reset(seed=4)[0]
    assert env.observation_space.contains(seen)
    for _ in range(3):
        seen, *_ = env.step(np.zeros(4, np.float32))
    robot = env.unwrapped.robot
    assert seen["depth"][12, 16] == pytest.approx(min(np.interp(0.0, robot.angles, robot.scan[0]), 30.0), abs=0.6)


@pytest.mark.parametrize(
    ("observation", "says"),
    [
        (["depth", "velocity"], "is a picture, which is no row of numbers"),
        ({"x": "dept"}, "did you mean 'depth'"),
        ({}, "no entries"),
        ("depth+nothing", "'nothing' is not known"),
    ],
)
def test_what_cannot_be_is_refused(observation, says):
    with pytest.raises(EnvOptionError, match=says):
        make(observation)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"width": 0}, "width = 0"),
        ({"field_of_view": 180.0}, r"field_of_view = 180\.0; it must be 1 \.\. 170 deg"),
        ({"rate": 7.0}, "is not a whole number of steps"),
        ({"latency": 0.1}, r"latency = 0\.1 s is not a whole number of steps of 0\.6 s"),
        ({"at": (1.0, 2.0)}, "three finite numbers"),
    ],
)
def test_settings_that_cannot_be_are_refused(arguments, says):
    with pytest.raises(EnvOptionError, match=says):
        make(Depth(**arguments))


def test_a_vehicle_elsewhere_has_no_camera_here():
    with pytest.raises(EnvOptionError, match="shows no world to a camera"):
        gym.make(
            "sitl/Navigate-v1", robot="erle_rover", world="maze_erlerover", observation="depth",
            connection="udp:127.0.0.1:1",
        )  # fmt: skip
