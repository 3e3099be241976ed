# SPDX-License-Identifier: BSD-3-Clause
"""Features, frames, actions and the tally of deep agents: none of these needs the extra."""

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
from sitl.agents.deep.training import Tally
from sitl.agents.errors import AgentError
from sitl.errors import MissingExtra


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
    told = tally.count(np.array([1.0, -200.0]), np.array([False, True]), np.array([False, True]))
    assert told == [(-198.0, 2)]
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
    monkeypatch.setattr(library, "find_spec", lambda name: None if name == "torch" else name)
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
