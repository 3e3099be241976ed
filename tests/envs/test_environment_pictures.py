# SPDX-License-Identifier: BSD-3-Clause
"""Pictures from above, with and without a screen."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from sitl.envs.tasks import ReachGoal

pytest.importorskip("pygame")
CIRCUIT2 = "GazeboCircuit2TurtlebotLIDAR-v0"


def test_picture_shows_walls_robot_and_trail():
    env = gym.make(CIRCUIT2, render_mode="rgb_array")
    env.reset()
    first = env.render()
    assert first.dtype == np.uint8 and first.ndim == 3 and first.shape[2] == 3 and max(first.shape) == 640
    for _ in range(5):
        env.step(0)
    later = env.render()
    assert later.shape == first.shape and (later != first).any()
    wall = (first == (62, 68, 76)).all(axis=2).mean()
    assert 0.03 < wall < 0.3
    trail = (later == (70, 130, 180)).all(axis=2).sum()
    assert trail > 10
    env.reset()
    assert np.array_equal(env.render(), first)
    env.close()
    env.close()


def test_window_works_without_a_screen(monkeypatch):
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    env = gym.make(CIRCUIT2, render_mode="window")
    env.reset()
    env.step(0)
    assert env.render() is None
    env.close()
    env.close()


def test_vector_gives_a_picture_of_each_robot():
    vector = gym.make_vec(CIRCUIT2, num_envs=2, render_mode="rgb_array")
    vector.reset(seed=0)
    vector.step([0, 1])
    a, b = vector.render()
    assert a.shape == b.shape and (a != b).any()


def test_goal_is_drawn():
    pictures = []
    for goal in ((1.0, 0.0), (2.0, 0.0)):
        env = gym.make("sitl/Navigate-v0", task=ReachGoal(goal), render_mode="rgb_array")
        env.reset()
        pictures.append(env.render())
    assert (pictures[0] != pictures[1]).any()


def test_render_without_a_mode_says_how(recwarn):
    env = gym.make(CIRCUIT2).unwrapped
    env.reset()
    assert env.render() is None
    assert any("render_mode" in str(w.message) for w in recwarn)


def test_gymnasiums_checker_accepts_the_pictures(monkeypatch, recwarn):
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    check_env(gym.make(CIRCUIT2).unwrapped)
    assert [str(w.message) for w in recwarn] == []


@pytest.mark.parametrize("name", ["RoverWaypoint", "RoverSlalom", "RoverParking"])
def test_places_and_gates_are_drawn_and_the_arena_is_in_the_picture(name):
    env = gym.make(f"sitl/{name}-v0", render_mode="rgb_array")
    env.reset(seed=3)
    picture = env.render()
    assert (picture == (60, 150, 80)).all(axis=2).sum() > 30
    places = env.unwrapped.task.positions[0, :, :2]
    box = env.unwrapped.task.arena
    assert (places >= box.low[:2]).all() and (places <= box.high[:2]).all() and max(picture.shape) == 640
    env.close()


@pytest.mark.parametrize("name", ["CopterRace", "RoverSlalom"])
def test_a_whole_track_is_in_the_picture(name):
    env = gym.make(f"sitl/{name}-v0", render_mode="rgb_array")
    env.reset(seed=3)
    green = (env.render() == (60, 150, 80)).all(axis=2)
    edges = np.concatenate([green[:8].ravel(), green[-8:].ravel(), green[:, :8].ravel(), green[:, -8:].ravel()])
    assert green.sum() > 100 and not edges.any()
    env.close()
