# SPDX-License-Identifier: BSD-3-Clause
"""Rollouts: the same episodes whoever plays them, what is written of them, what is refused."""

from __future__ import annotations

import math
import os
import sys

import gymnasium as gym
import pytest

from sitl.agents import algorithms, environments
from sitl.agents.errors import AgentError
from sitl.agents.evaluate import evaluate
from sitl.agents.rollout import TRAJECTORIES, rollout
from sitl.agents.runs.backends import Workers
from sitl.agents.runs.files import read_arrays
from sitl.agents.runs.training import train_one
from sitl.cli import main
from sitl.core import ray_cluster
from tests.agents import rollout_policies
from tests.agents.small_runs import CIRCUIT2, new


def played(workers=None, policy="random", **changes):
    """Eleven short episodes, in parts of eight."""
    given = {"episodes": 11, "seed": 3, "max_steps": 40, "robots": 2, "options": {"start": "random"}, **changes}
    return without_laps(rollout(policy, CIRCUIT2, workers=workers, **given))


def without_laps(evaluation):
    return [(p.reward, p.steps, p.terminated, p.crashed, p.reached, p.simulated_s) for p in evaluation.episodes]


def files(folder):
    return {path.relative_to(folder).as_posix(): read_arrays(path) for path in sorted(folder.rglob("*.npz"))}


def assert_same_files(folder, other):
    one, two = files(folder), files(other)
    assert one and one.keys() == two.keys()
    for path, arrays in one.items():
        assert {name: a.tobytes() for name, a in arrays.items()} == {name: a.tobytes() for name, a in two[path].items()}


def test_how_many_robots_fly_at_once_changes_no_episode():
    assert played(robots=1) == played(robots=2) == played(robots=11)


def test_another_seed_gives_other_episodes():
    assert played() != played(seed=4)


def test_a_run_plays_as_it_is_evaluated(tmp_path):
    run = new(tmp_path / "run", env_options={"start": "random"})
    train_one(run.path, lambda rows: None, lambda: False)
    env = environments.make(run.config)
    alone = evaluate(env, algorithms.policy_of(run), episodes=11, seed=3)
    env.close()
    assert without_laps(rollout(run.path, episodes=11, seed=3, robots=4)) == without_laps(alone)


def test_trajectories_can_be_flown_again(tmp_path):
    options = {"observation": "scan+goal", "task": "goal", "start": "random"}
    found = rollout(
        "random", "sitl/Navigate-v0", 6, seed=5, max_steps=25, robots=2, options=options, trajectories=tmp_path
    )
    arrays = read_arrays(tmp_path / "0000000" / TRAJECTORIES)
    assert arrays["steps"].tolist() == [one.steps for one in found.episodes] and len(set(arrays["steps"])) > 1
    env, row = gym.make("sitl/Navigate-v0", max_episode_steps=25, **options), 0
    for episode, steps in enumerate(arrays["steps"].tolist()):
        observation, _ = env.reset(seed=environments.seed_of(5, episode))
        for _ in range(steps):
            for name, value in observation.items():
                assert arrays[f"observations.{name}"][row].tolist() == value.tolist()
            observation, reward, terminated, _, _ = env.step(int(arrays["actions"][row]))
            assert reward == arrays["rewards"][row]
            row += 1
        assert terminated == arrays["terminated"][episode]
        for name, value in observation.items():
            assert arrays[f"final_observations.{name}"][episode].tolist() == value.tolist()
    env.close()
    assert row == len(arrays["rewards"])


@pytest.mark.slow
def test_vehicles_with_an_autopilot_do_not_notice_their_fleet():
    def flights(robots):
        return without_laps(rollout("random", "GazeboMazeErleRoverLIDAR-v0", 5, max_steps=20, robots=robots))

    assert flights(1) == flights(3)


@pytest.mark.slow
def test_the_number_of_processes_changes_nothing(tmp_path):
    ended = []
    here = played(trajectories=tmp_path / "one")
    there = played(Workers(2), trajectories=tmp_path / "two", on_progress=lambda part, count: ended.append(count))
    assert here == there and sum(ended) == 11
    assert_same_files(tmp_path / "one", tmp_path / "two")


@pytest.mark.slow
def test_a_process_that_dies_is_an_error():
    with pytest.raises(RuntimeError, match="died"):
        played(Workers(2), rollout_policies.fatal)


@pytest.fixture(scope="module")
def ray(tmp_path_factory):
    """An instance on this machine, whose workers find the policies of these tests."""
    pytest.importorskip("ray", reason="Ray is not installed: pip install 'gym-sitl[ray]'")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", os.pathsep.join(sys.path))
        patch.setenv(rollout_policies.MARK, str(tmp_path_factory.mktemp("ray") / "died"))
        patch.delenv("RAY_ADDRESS", raising=False)
        with ray_cluster.cluster(2) as module:
            yield module


@pytest.mark.slow
@pytest.mark.parametrize("jobs", [1, 2])
def test_ray_plays_the_same(ray, tmp_path, jobs):
    here = played(trajectories=tmp_path / "here")
    assert played(Workers(jobs, "ray"), trajectories=tmp_path / "there") == here
    assert_same_files(tmp_path / "here", tmp_path / "there")


@pytest.mark.slow
def test_what_a_dead_worker_of_ray_had_to_play_is_played_by_another(ray):
    assert played(Workers(1, "ray"), rollout_policies.fatal_once) == played(policy=rollout_policies.ahead)
    with pytest.raises(RuntimeError, match=f"3 Ray workers in a row died of item 0 \\(episodes 0 to 7 of {CIRCUIT2}"):
        played(Workers(1, "ray"), rollout_policies.fatal)


def test_the_command_writes_a_row_an_episode(tmp_path, capsys):
    policy, out = "tests.agents.rollout_policies:ahead", tmp_path / "out"
    command = ["rollout", policy, CIRCUIT2, "--episodes", "3", "--max-steps", "30", "--seed", "1", "--out", str(out)]
    assert main([*command, "--trajectories"]) == 0
    assert "3 episodes: mean reward" in capsys.readouterr().out
    head, *rows = (out / "episodes.csv").read_text().splitlines()
    assert head == "episode,seed,reward,steps,terminated,crashed,reached,simulated_s,laps,judge"
    assert [row.split(",")[:2] for row in rows] == [[str(k), str(environments.seed_of(1, k))] for k in range(3)]
    assert (out / "0000000" / TRAJECTORIES).exists()
    assert main(command) != 0 and "is not empty" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("policy", "changes", "message"),
    [
        ("randm", {}, "policy 'randm' is neither 'random' nor MODULE:FUNCTION"),
        ("math:no_such", {}, "policy 'math:no_such' cannot be loaded"),
        ("math:pi", {}, "it must be a function"),
        ("random", {"episodes": 0}, "episodes = 0; it must be 1 or more"),
        ("random", {"robots": 0}, "robots = 0; it must be 1 or more"),
        ("random", {"env": None}, "give ENV, the id of one"),
        ("random", {"env": "NoSuchEnvironment-v0"}, "NoSuchEnvironment"),
        (lambda rows: math.pi, {"workers": Workers(2)}, "cannot be sent to other processes"),
    ],
)
def test_what_cannot_be_is_refused(policy, changes, message):
    with pytest.raises(AgentError, match=message):
        rollout(policy, **{"env": CIRCUIT2, "max_steps": 5, **changes})
