# SPDX-License-Identifier: BSD-3-Clause
"""Datasets in Minari's form: they load, repeat, are what environments give, and can be learnt from."""

from __future__ import annotations

import json

import gymnasium as gym
import numpy as np
import pytest

import sitl
from sitl.agents import datasets, environments
from sitl.agents.errors import AgentError
from sitl.cli import main

minari = pytest.importorskip("minari", reason="needs the extra 'minari'")
ID = "sitl/CopterWaypoint-v0"
pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore")]


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """Where Minari keeps datasets."""
    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path))
    return tmp_path


def arrays(dataset):
    """All of a dataset's episodes."""
    return [(e.observations, e.actions, e.rewards, e.terminations, e.truncations) for e in dataset.iterate_episodes()]


def equal(one, other):
    return all(np.array_equal(a, b) for x, y in zip(one, other, strict=True) for a, b in zip(x, y, strict=True))


def test_a_dataset_loads_and_is_what_the_environment_gives():
    written = datasets.record(ID, expert="guided", episodes=3, seed=5, options={"step_time": 0.2})
    dataset = minari.load_dataset("sitl/CopterWaypoint/guided-v0")
    assert dataset.total_episodes == 3 and dataset.total_steps == written.steps and written.successes == 3
    about = dataset.storage.metadata
    assert (about["expert"], about["environment"], int(about["seed"])) == ("guided", ID, 5)
    assert json.loads(about["options"]) == {"step_time": 0.2}
    assert json.loads(about["versions"])["gym-sitl"] == sitl.__version__
    env = dataset.recover_environment()
    assert env.unwrapped.step_time == 0.2
    for k, episode in enumerate(dataset.iterate_episodes()):
        seed = environments.seed_of(5, k)
        observation, _ = env.reset(seed=seed)
        assert json.loads(about["episode_seeds"])[k] == seed
        assert np.array_equal(observation, episode.observations[0])
        for action, seen, reward in zip(episode.actions, episode.observations[1:], episode.rewards, strict=True):
            observation, paid, *_ = env.step(action)
            assert np.array_equal(observation, seen) and paid == reward
        assert episode.terminations[-1] and not episode.truncations[-1]
        assert episode.infos["is_success"][-1] and not episode.infos["is_success"][:-1].any()
    env.close()


def test_the_same_seed_gives_the_same_dataset():
    made = [
        datasets.record(ID, f"test/{name}-v0", expert="auto", episodes=2, seed=seed).dataset
        for name, seed in (("one", 1), ("again", 1), ("other", 2))
    ]
    one, again, other = map(arrays, made)
    assert equal(one, again)
    assert not np.array_equal(one[0][0][0], other[0][0][0])


def test_goals_and_tables_are_recorded():
    goals = datasets.record("sitl/RoverReachGoal-v0", episodes=1).dataset
    episode = next(iter(goals.iterate_episodes()))
    assert set(episode.observations) == {"observation", "achieved_goal", "desired_goal"}
    table = datasets.record("sitl/RoverWaypointDiscrete-v0", episodes=1).dataset
    assert next(iter(table.iterate_episodes())).actions.dtype == np.int64


def test_a_shipped_policy_is_an_expert():
    found = datasets.record(ID, expert="baseline", episodes=2)
    assert found.dataset.id == "sitl/CopterWaypoint/copter-waypoint-v0" and found.successes == 2
    found = datasets.record("sitl/RoverWaypointDiscrete-v0", expert="baseline", episodes=2)
    assert found.dataset.id == "sitl/RoverWaypointDiscrete/rover-waypoint-discrete-v0" and found.successes == 2


def test_a_policy_that_copies_the_expert_is_better_than_drawn_actions():
    """Behaviour cloning, by least squares on a few hundred fixed features."""
    dataset = datasets.record(ID, expert="guided", episodes=30).dataset
    seen = np.concatenate([e.observations[:-1] for e in dataset.iterate_episodes()]).astype(np.float64)
    done = np.concatenate([e.actions for e in dataset.iterate_episodes()]).astype(np.float64)
    scale = seen.std(axis=0) + 1e-6
    rng = np.random.default_rng(0)
    mixed, shift = rng.normal(size=(seen.shape[1], 300)) / np.sqrt(seen.shape[1]), rng.uniform(-2.0, 2.0, 300)

    def features(rows):
        return np.tanh(rows / scale @ mixed + shift)

    x = features(seen)
    weights = np.linalg.solve(x.T @ x + 0.1 * np.eye(300), x.T @ done)

    def play(act):
        env, rewards, successes = gym.make(ID), [], 0
        for seed in range(1000, 1010):
            observation, _ = env.reset(seed=seed)
            total, ended, info = 0.0, False, {}
            while not ended:
                observation, reward, terminated, truncated, info = env.step(act(observation))
                total, ended = total + reward, terminated or truncated
            rewards.append(total)
            successes += info["is_success"]
        env.close()
        return np.mean(rewards), successes

    space = gym.spaces.Box(-1.0, 1.0, (4,), np.float32, seed=0)
    reward, successes = play(lambda row: np.clip(features(row) @ weights, -1.0, 1.0).astype(np.float32))
    drawn, lucky = play(lambda row: space.sample())
    assert reward > drawn + 10.0 and successes > lucky + 4


def test_truth_estimate_and_costs_are_beside_the_observations():
    """A row for the reset, and one for each step."""
    costs = ["energy", {"cost": "speed", "speed": 1.0}]
    made = datasets.record("sitl/CopterWaypoint-v1", episodes=2, seed=4, options={"costs": costs}).dataset
    assert made.id == "sitl/CopterWaypoint/guided-v1"
    dataset = minari.load_dataset(made.id)
    columns = json.loads(dataset.storage.metadata["state_columns"])
    assert columns[:4] == ["x [m]", "y [m]", "z [m]", "yaw [rad]"] and len(columns) == 12
    env = dataset.recover_environment()
    for k, episode in enumerate(dataset.iterate_episodes()):
        told, count = episode.infos, len(episode.rewards) + 1
        assert told["truth"].shape == told["estimate"].shape == (count, 12)
        env.reset(seed=environments.seed_of(4, k))
        robot = env.unwrapped.robot
        for step, action in enumerate([None, *episode.actions]):
            info = {} if action is None else env.step(action)[4]
            assert np.array_equal(told["truth"][step], robot.true_state()[0])
            assert np.array_equal(told["estimate"][step], robot.state[0])
            for name in ("cost", "cost_energy", "cost_speed"):
                assert told[name][step] == info.get(name, 0.0)
        assert 0.0 < np.abs(told["truth"] - told["estimate"])[:, :3].max() < 3.0
        assert told["cost_speed"].any() and not told["cost_speed"].all()
    env.close()


def test_names_of_datasets_have_the_version_of_the_environment():
    for env, name in (
        ("sitl/CopterWaypoint-v1", "sitl/CopterWaypoint/guided-v1"),
        ("sitl.envs:sitl/CopterWaypoint-v0", "sitl/CopterWaypoint/guided-v0"),
        ("GazeboMazeTurtlebotLIDAR-v0", "sitl/GazeboMazeTurtlebotLIDAR/guided-v0"),
    ):
        assert datasets.name_of(env, "guided") == name
        minari.dataset.minari_dataset.parse_dataset_id(name)


def test_the_command_records(capsys, folder):
    assert main(["dataset", "record", ID, "--episodes", "1", "--seed", "3", "--name", "mine/flights-v1"]) == 0
    assert "mine/flights-v1: 1 episodes" in capsys.readouterr().out
    assert "mine/flights-v1" in minari.list_local_datasets()
    assert main(["dataset", "record", ID, "--episodes", "1", "--name", "mine/flights-v1"]) == 2
    assert "there is a dataset 'mine/flights-v1' already" in capsys.readouterr().err


def test_what_cannot_be_is_refused():
    for arguments, needed in (
        ({"env": "sitl/CopterWaypint-v0"}, "sitl/CopterWaypint"),
        ({"env": ID, "options": {"worl": "open"}}, "worl"),
        ({"env": ID, "expert": "gided"}, "none of guided, auto, pilot, baseline, random"),
        ({"env": "sitl/Navigate-v0", "expert": "baseline"}, "no policy of sitl/Navigate-v0"),
        ({"env": ID, "dataset": "no version"}, "no version"),
    ):
        with pytest.raises(AgentError, match=needed):
            datasets.record(**{"episodes": 1, **arguments})
    assert not minari.list_local_datasets()
