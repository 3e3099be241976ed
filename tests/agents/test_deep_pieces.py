# SPDX-License-Identifier: BSD-3-Clause
"""The pieces of deep agents: features, frames, actions, the tally, and the robots as stable-baselines3 sees them."""

from __future__ import annotations

import math
import re
from dataclasses import fields
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.agents.deep import library, training
from sitl.agents.deep.actions import Actions
from sitl.agents.deep.features import Features, Frames, nearest
from sitl.agents.deep.settings import Dqn, Ppo, Sac
from sitl.agents.deep.tally import Tally
from sitl.agents.errors import AgentError
from sitl.errors import MissingExtra
from tests.agents.deep_runs import CIRCUIT2


@given(st.integers(1, 60), st.integers(0, 80), st.integers(0, 2**31))
def test_sectors_cover_the_scan_and_hold_the_nearest(readings, sectors, seed):
    scans = np.random.default_rng(seed).uniform(0.0, 20.0, (3, readings)).astype(np.float32)
    out = nearest(scans, sectors)
    assert out.shape == (3, readings if sectors == 0 else min(sectors, readings))
    assert np.array_equal(out.min(axis=1), scans.min(axis=1)) and np.isin(out, scans).all()


def test_scans_of_other_lidars_give_the_same_sectors():
    space = gym.spaces.Box(0.0, 20.0, (240,), np.float32)
    features = Features(space, 24)
    wall = np.linspace(1.0, 5.0, 24, dtype=np.float32)
    fine, coarse = features(np.repeat(wall, 10)[None]), features(np.repeat(wall, 2)[None])
    assert features.width == 24 and np.array_equal(fine, coarse)
    assert fine.min() > 0.0 and features(np.full((1, 240), 20.0)).max() == pytest.approx(1.0)


def test_digits_goals_and_poses():
    digits = Features(gym.spaces.MultiDiscrete([7, 7, 11]), 24)
    assert digits(np.array([[6, 0, 5]])).tolist() == [[1.0, 0.0, 0.5]]
    low, high = np.array([0.0, -math.pi], np.float32), np.array([100.0, math.pi], np.float32)
    bound = np.array([100.0, 100.0, 100.0, math.pi], np.float32)
    both = gym.spaces.Dict({"goal": gym.spaces.Box(low, high), "pose": gym.spaces.Box(-bound, bound)})
    row = Features(both, 0)({"goal": np.array([[0.0, math.pi / 2]]), "pose": np.array([[10.0, -10.0, 0.0, math.pi]])})
    assert row[0] == pytest.approx([0.0, 0.0, 1.0, 1.0, -1.0, 0.0, -1.0, 0.0], abs=1e-6)
    with pytest.raises(AgentError, match="cannot be learnt from"):
        Features(gym.spaces.Box(0, 255, (8, 8), np.uint8), 0)


def test_frames_remember_and_forget():
    frames = Frames(2, 3, 1)
    assert frames.begin(np.array([[1.0], [2.0]], np.float32)).tolist() == [[1, 1, 1], [2, 2, 2]]
    frames.push(np.array([[3.0], [4.0]], np.float32))
    assert frames.push(np.array([[5.0], [6.0]], np.float32)).tolist() == [[5, 3, 1], [6, 4, 2]]
    assert frames.begin(np.array([[7.0], [8.0]], np.float32), np.array([1])).tolist() == [[5, 3, 1], [8, 8, 8]]
    alone = Frames(1, 1, 2)
    assert alone.push(np.array([[1.0, 2.0]], np.float32)).tolist() == [[1.0, 2.0]]


@given(st.lists(st.floats(-3.0, 3.0, width=32), min_size=2, max_size=2))
def test_continuous_actions_fill_the_box_and_stay_in_it(numbers):
    box = gym.spaces.Box(np.array([1100.0, -0.6], np.float32), np.array([1900.0, 0.6], np.float32))
    actions = Actions(box, "sac")
    assert box.contains(actions.to_environment(np.array([numbers], np.float32))[0])
    ends = actions.to_environment(np.array([[-1.0, -1.0], [1.0, 1.0], [0.0, 0.0]], np.float32))
    assert ends == pytest.approx(np.array([box.low, box.high, [1500.0, 0.0]]))


def test_the_tally_makes_a_row_of_each_episode_that_ends():
    tally = Tally(2, 0.5)
    tally.count(np.array([1.0, 2.0]), np.array([False, False]), np.array([False, False]))
    reported = tally.count(np.array([1.0, -200.0]), np.array([False, True]), np.array([False, True]))
    assert reported == [(-198.0, 2)]
    kept = tally.memory()
    other = Tally(2, 0.5)
    other.recall(kept)
    for one in (tally, other):
        one.count(np.array([3.0, 4.0]), np.array([False, False]), np.array([True, True]))
    rows = [row[:-1] for row in tally.take()]
    assert [row[:3] + row[4:] for row in rows] == [(0, 2, -198.0, 1, 1.0), (1, 3, 5.0, 0, 1.5), (2, 1, 4.0, 0, 0.5)]
    assert [repr(row[:-1]) for row in other.take()] == [repr(row) for row in rows[1:]]
    assert tally.done == 3 and tally.done_steps == 6 and tally.take() == []


def test_without_the_extra_the_message_says_how_to_get_it(monkeypatch):
    monkeypatch.setattr(library.importlib.util, "find_spec", lambda name: None if name == "torch" else name)
    for use in (lambda: training.settings("ppo", {}), library.stable_baselines3, library.torch):
        with pytest.raises(MissingExtra, match=r"gym-sitl\[rl\]"):
            use()


def test_every_setting_is_explained():
    page = (Path(__file__).parents[2] / "docs/learning.md").read_text().split("## DQN, PPO and SAC")[1]
    for kind in (Ppo, Dqn, Sac):
        for field in fields(kind):
            row = next(line for line in page.splitlines() if line.startswith("| `") and f"`{field.name}`" in line)
            defaults = row.split("|")[2].replace("as it begins", "0.0003")
            assert str(field.default) in re.split("[ ,;]+", defaults), (kind, field.name)


SEEDS = [11, 12, 13]


def robots(start="random", steps=20):
    pytest.importorskip("stable_baselines3", reason="deep agents need the extra 'rl'")
    from sitl.agents.deep.robots import Robots

    env = gym.make_vec(CIRCUIT2, num_envs=3, observation="scan", start=start, max_episode_steps=steps)
    features = Features(env.single_observation_space, 0)
    return Robots(env, features, 2, Actions(env.single_action_space, "ppo"), 0.1, Tally(3, 0.6), SEEDS)


def test_each_robot_is_a_single_environment_reset_in_the_step_that_ends_its_episode():
    many = robots()
    singles = [gym.make(CIRCUIT2, observation="scan", start="random", max_episode_steps=20) for _ in SEEDS]
    features = Features(singles[0].observation_space, 0)
    width, rng = features.width, np.random.default_rng(0)
    seen = many.reset()
    alone = [env.reset(seed=seed)[0] for env, seed in zip(singles, SEEDS)]
    assert np.array_equal(seen[:, :width], features(np.array(alone)))
    assert np.array_equal(seen[:, width:], seen[:, :width])
    ends = 0
    for _ in range(120):
        actions = rng.integers(3, size=3)
        before = seen
        seen, rewards, dones, infos = many.step(actions)
        for k, env in enumerate(singles):
            observation, reward, terminated, truncated, _ = env.step(int(actions[k]))
            row = features(observation[None])[0]
            assert rewards[k] == pytest.approx(0.1 * reward) and dones[k] == (terminated or truncated)
            if dones[k]:
                ends += 1
                assert np.array_equal(infos[k]["terminal_observation"], np.concatenate([row, before[k, :width]]))
                assert infos[k]["TimeLimit.truncated"] == (truncated and not terminated)
                row = features(env.reset()[0][None])[0]
                assert np.array_equal(seen[k], np.tile(row, 2))
            else:
                assert np.array_equal(seen[k], np.concatenate([row, before[k, :width]])) and infos[k] == {}
    assert ends > 6


def test_they_go_on_from_a_memory_bit_for_bit():
    one, other = robots(), robots()
    one.reset()
    rng = np.random.default_rng(1)
    for _ in range(30):
        one.step(rng.integers(3, size=3))
    other.recall(one.memory())
    for _ in range(40):
        actions = rng.integers(3, size=3)
        for a, b in zip(one.step(actions)[:3], other.step(actions)[:3]):
            assert np.array_equal(a, b)


def test_stable_baselines3_takes_them():
    pytest.importorskip("stable_baselines3", reason="deep agents need the extra 'rl'")
    from stable_baselines3.common.env_util import is_wrapped  # noqa: F401
    from stable_baselines3.common.vec_env import VecMonitor

    wrapped = VecMonitor(robots())
    assert wrapped.reset().shape == (3, 40) and wrapped.get_attr("num_envs") == [3, 3, 3]
    with pytest.raises(NotImplementedError):
        wrapped.set_attr("x", 1)
    wrapped.close()
