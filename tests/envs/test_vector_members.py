# SPDX-License-Identifier: BSD-3-Clause
"""Each robot of a vector environment: called, read, set, drawn and reset by itself; and Gymnasium's wrappers."""

from __future__ import annotations

import pickle

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.vector import SyncVectorEnv
from gymnasium.wrappers import vector as wrappers

from sitl.envs import EnvOptionError
from tests.envs.vector_equality import same

CIRCUIT2, ROVER = "GazeboCircuit2TurtlebotLIDAR-v0", "GazeboMazeErleRoverLIDAR-v0"
NOISE = {"start": "random", "randomise": {"range_noise": (0.01, 0.02)}}


def both(name=CIRCUIT2, count=3, **options):
    """Our vector environment, and Gymnasium's over single ones; both were reset and have moved."""
    made = gym.make_vec(name, num_envs=count, **options), SyncVectorEnv([lambda: gym.make(name, **options)] * count)
    for vector in made:
        vector.reset(seed=7)
        vector.step(np.arange(count) % 3)
    return made


@pytest.mark.parametrize("name", ["step_time", "render_mode", "observation_space", "action_space", "np_random_seed"])
def test_attributes_are_those_of_single_environments(name):
    ours, theirs = both()
    assert ours.get_attr(name) == theirs.get_attr(name) == ours.call(name)


@pytest.mark.parametrize("name", [CIRCUIT2, ROVER])
def test_robots_are_looked_at_one_by_one(name):
    ours, theirs = both(name)
    for mine, other in zip(ours.get_attr("robot"), theirs.get_attr("robot")):
        assert mine.count == other.count == 1 and mine.name == other.name
        for arrays in ("pose", "velocity", "scan", "collided", "time", "angles"):
            assert np.array_equal(getattr(mine, arrays), getattr(other, arrays)), arrays
        with pytest.raises(AttributeError, match="moves with all others"):
            mine.advance(0.1)
    if name == ROVER:
        mine, other = (vector.get_attr("robot")[1] for vector in (ours, theirs))
        assert mine.view(0).time_us == other.view(0).time_us
        assert mine.view(0).physics.body.pos == other.view(0).physics.body.pos
        with pytest.raises(IndexError, match="no robot 1"):
            mine.view(1)
    assert [world.name for world in ours.get_attr("world")] == [world.name for world in theirs.get_attr("world")]


def test_random_numbers_are_those_of_single_environments():
    ours, theirs = both()
    draws = [[generator.integers(1000) for generator in vector.np_random] for vector in (ours, theirs)]
    assert draws[0] == draws[1]
    assert ours.np_random_seed == theirs.np_random_seed == (7, 8, 9)
    ours.set_attr("np_random", [np.random.default_rng(k) for k in range(3)])
    assert ours.np_random_seed == (-1, -1, -1)
    assert ours.get_attr("np_random")[2].integers(1000) == np.random.default_rng(2).integers(1000)


def test_methods_are_called_for_each():
    ours, theirs = both(**NOISE)
    kept = ours.call("snapshot"), theirs.call("snapshot")
    for a, b in zip(*kept):
        assert same(a.robot, b.robot) and a.rng == b.rng
    first = ours.step(np.array([0, 1, 2]))[0]
    for index, snapshot in enumerate(kept[0]):
        ours.unwrapped.envs[index].restore(snapshot)
    assert np.array_equal(ours.step(np.array([0, 1, 2]))[0], first)
    before = ours.unwrapped.robot.pose.copy()
    observation, _ = ours.unwrapped.envs[1].reset(seed=3)
    assert np.array_equal(observation, gym.make(CIRCUIT2, **NOISE).reset(seed=3)[0])
    assert np.array_equal(ours.unwrapped.robot.pose[[0, 2]], before[[0, 2]])
    with pytest.raises(gym.error.Error, match="moves with all others"):
        ours.call("step", 0)
    with pytest.raises(AttributeError):
        ours.call("no_such_thing")


def test_attributes_are_set_for_each():
    for vector in both():
        vector.set_attr("level", 4)
        assert vector.get_attr("level") == (4, 4, 4)
        vector.set_attr("level", [1, 2, 3])
        assert vector.get_attr("level") == (1, 2, 3)
        with pytest.raises(ValueError, match=r"3 environments|num_envs = 3"):
            vector.set_attr("level", [1, 2])


def test_attributes_are_pickled_with_the_vector():
    vector = both()[0]
    vector.set_attr("level", [1, 2, 3])
    again = pickle.loads(pickle.dumps(vector))
    assert again.get_attr("level") == (1, 2, 3)
    assert np.array_equal(again.get_attr("robot")[2].pose, vector.get_attr("robot")[2].pose)


def test_start_poses_one_by_one():
    vector = gym.make_vec(CIRCUIT2, num_envs=3, **NOISE)
    vector.reset(seed=1)
    usual = vector.unwrapped.robot.pose.copy()
    poses = [(0.5, 0.0, 0.1), None, (0.7, 0.0, 0.0, 0.2)]
    vector.reset(seed=1, options={"pose": poses})
    placed = vector.unwrapped.robot.pose
    assert placed[0, [0, 1, 3]].tolist() == pytest.approx([0.5, 0.0, 0.1]) and placed[2, 3] == pytest.approx(0.2)
    assert np.array_equal(placed[1], usual[1])
    mask = np.array([False, False, True])
    vector.reset(options={"pose": np.full((3, 3), 0.25), "reset_mask": mask})
    assert vector.unwrapped.robot.pose[:, 0].tolist() == pytest.approx([0.5, usual[1, 0], 0.25])
    vector.reset(options={"pose": (0.5, 0.0, 0.1)})  # three numbers for three robots are one pose
    assert vector.unwrapped.robot.pose[:, 3].tolist() == pytest.approx([0.1] * 3)
    with pytest.raises(EnvOptionError, match="2 start poses for num_envs = 3"):
        vector.reset(options={"pose": [(0.5, 0.0, 0.1)] * 2})


def test_pictures_of_each_and_of_one_and_a_grid():
    pytest.importorskip("pygame", reason="pictures need the extra 'viz'")
    ours, theirs = both(render_mode="rgb_array", max_episode_steps=2)
    for _ in range(3):  # episodes end, and others begin
        for vector in (ours, theirs):
            vector.step(np.array([0, 1, 2]))
        pictures = ours.render()
        assert isinstance(pictures, tuple) and same(pictures, theirs.render())
    assert np.array_equal(ours.unwrapped.envs[1].render(), pictures[1])
    assert same(ours.call("render"), pictures)
    grid = gym.make_vec(CIRCUIT2, num_envs=3, render_mode="rgb_array", tiled=True)
    grid.reset(seed=7)
    height, width, _ = pictures[0].shape
    picture = grid.render()
    assert picture.shape == (2 * height, 2 * width, 3) and not picture[height:, width:].any()
    assert np.array_equal(picture[:height, width:], grid.unwrapped.envs[1].render())
    assert gym.make_vec(CIRCUIT2, num_envs=2).render() is None


@pytest.mark.parametrize("mode", gym.vector.AutoresetMode)
@pytest.mark.parametrize("name", ["RecordEpisodeStatistics", "NormalizeReward", "ClipReward", "DictInfoToList"])
def test_wrappers_give_what_they_give_of_single_environments(name, mode):
    arguments = {"ClipReward": {"min_reward": -1.0, "max_reward": 2.0}}.get(name, {})
    options = {"max_episode_steps": 4}
    ours = gym.make_vec(CIRCUIT2, num_envs=2, autoreset_mode=mode, **options)
    theirs = SyncVectorEnv([lambda: gym.make(CIRCUIT2, **options)] * 2, autoreset_mode=mode)
    made = [getattr(wrappers, name)(vector, **arguments) for vector in (ours, theirs)]
    assert same(*(vector.reset(seed=2) for vector in made))
    for _ in range(12):
        got, expected = (vector.step(np.array([0, 1])) for vector in made)
        for infos in (got[4], expected[4]):
            if isinstance(infos, dict) and "episode" in infos:
                infos["episode"].pop("t")  # wall time
        assert same(got, expected)
        if mode is gym.vector.AutoresetMode.DISABLED and got[3].any():
            assert same(*(vector.reset() for vector in made))


def test_observations_are_normalised_and_flattened():
    made = both("sitl/Navigate-v1", world="maze", **NOISE)
    ours, theirs = (wrappers.FlattenObservation(wrappers.NormalizeObservation(vector)) for vector in made)
    assert ours.observation_space == theirs.observation_space
    assert same(ours.reset(seed=1), theirs.reset(seed=1))
    for _ in range(5):
        assert same(ours.step(np.array([0, 1, 2])), theirs.step(np.array([0, 1, 2])))


def test_videos_are_recorded(tmp_path):
    pytest.importorskip("moviepy", reason="Gymnasium records videos with it")
    pytest.importorskip("pygame", reason="pictures need the extra 'viz'")
    vector = gym.make_vec(CIRCUIT2, num_envs=2, render_mode="rgb_array")
    filmed = wrappers.RecordVideo(vector, str(tmp_path), video_length=3, step_trigger=lambda step: step == 1)
    filmed.reset(seed=1)
    for _ in range(6):
        filmed.step(np.array([0, 1]))
    filmed.close()
    assert [file.suffix for file in tmp_path.iterdir()] == [".mp4"]


def test_a_closed_vector_is_opened_by_reset_and_closed_again():
    vector = gym.make_vec(ROVER, num_envs=2)
    first = vector.reset(seed=1)
    vector.close()
    assert vector.closed
    assert same(vector.reset(seed=1), first) and not vector.closed
    vector.step(np.array([0, 0]))
    vector.close()
    assert vector.closed
