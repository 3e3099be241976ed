# SPDX-License-Identifier: BSD-3-Clause
"""Goal-conditioned runs: steps are replayed with goals that were reached later."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("stable_baselines3", reason="deep agents need the extra 'rl'")
pytest.importorskip("torch", reason="deep agents need the extra 'rl'")

import gymnasium as gym

from sitl.agents import environments
from sitl.agents.deep import training
from sitl.agents.deep.features import Features, goals_of
from sitl.agents.errors import AgentError
from sitl.agents.evaluate import evaluate_run
from sitl.agents.runs.config import RunConfig
from sitl.agents.runs.evaluation_plan import EvaluationPlan
from sitl.agents.runs.folder import RunFolder
from tests.agents.deep_runs import train, weights

REACH = "sitl/RoverReachGoal"
SMALL = {
    "hindsight": 4, "frames": 1, "robots": 4, "warm_up": 100, "memory": 300, "batch": 32, "width": 8,
    "check_every": 200, "check_episodes": 2,
}  # fmt: skip


def run_of(path, algorithm, env=f"{REACH}-v0", **settings):
    chosen = training.settings(algorithm, {**SMALL, **settings})
    config = RunConfig(env, algorithm, settings=chosen, episodes=None, steps=400, max_steps=20)
    return RunFolder.create(path, config)


@pytest.mark.parametrize(("algorithm", "form"), [("sac", ""), ("dqn", "Discrete")])
def test_a_resumed_run_equals_an_uninterrupted_one(tmp_path, algorithm, form):
    name = f"{REACH}{form}-v0"
    whole, parts = run_of(tmp_path / "whole", algorithm, name), run_of(tmp_path / "parts", algorithm, name)
    train(whole)
    train(parts, episodes=9)  # after its memory is full, in the middle of episodes
    train(RunFolder(parts.path))
    assert weights(parts) == weights(whole)
    found = evaluate_run(parts, EvaluationPlan(episodes=2), seed=5)
    assert len(found.episodes) == 2 and all(played.steps == 20 for played in found.episodes)


def test_goals_are_worth_what_the_environment_says(tmp_path):
    from sitl.agents.deep.actions import Actions
    from sitl.agents.deep.robots import Robots
    from sitl.agents.deep.tally import Tally

    config = run_of(tmp_path / "run", "sac").config
    env = environments.make_many(config, 2)
    features = Features(env.single_observation_space, 0)
    tally = Tally(2, 0.2)
    robots = Robots(env, features, 1, Actions(env.single_action_space, "sac"), 0.5, tally, [1, 2], True)
    seen = robots.reset()
    assert isinstance(robots.observation_space, gym.spaces.Dict) and set(seen) == set(robots.observation_space.spaces)
    task = env.unwrapped.session.task
    assert np.allclose(goals_of(seen["desired_goal"]), task.targets, atol=1e-5)
    (worth,) = robots.env_method("compute_reward", seen["desired_goal"], seen["desired_goal"], [{}, {}], indices=[0])
    assert worth.tolist() == [0.0, 0.0]
    (worth,) = robots.env_method("compute_reward", seen["desired_goal"] + 1.0, seen["desired_goal"], [{}, {}])
    assert worth.tolist() == [-0.5, -0.5]
    with pytest.raises(NotImplementedError):
        robots.env_method("close")
    env.close()


@pytest.mark.parametrize(
    ("env", "settings", "says"),
    [
        ("sitl/RoverWaypoint-v0", {}, "hindsight = 4, frames = 1 in sitl/RoverWaypoint-v0: .* goal-conditioned"),
        (f"{REACH}-v0", {"frames": 2}, "frames = 2"),
        (f"{REACH}-v0", {"warm_up": 79}, "warm_up = 79, memory = 300: with hindsight they must be 80 .* and 240"),
    ],
)
def test_what_cannot_be_replayed_is_refused(tmp_path, env, settings, says):
    with pytest.raises(AgentError, match=says):
        environments.try_all([run_of(tmp_path / "run", "sac", env, **settings).config])
