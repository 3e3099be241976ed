# SPDX-License-Identifier: BSD-3-Clause
"""What ``info`` tells besides what the task does: terms of the reward, the true pose, events."""

from __future__ import annotations

import pickle

import gymnasium as gym
import numpy as np
import pytest

from sitl.envs import EnvOptionError, ids
from sitl.envs.rewards import EachStep, Forward
from sitl.envs.targets.moving import Follow
from sitl.envs.targets.waypoints import Waypoints
from sitl.envs.tasks import ReachGoal, Task
from tests.envs.vector_equality import same


def add_up(info):
    return sum(value for name, value in info.items() if name.startswith("reward_"))


@pytest.mark.parametrize("name", ["Hover", "ReachGoal", "Course", "Gates", "Trajectory", "Land", "Forest"])
def test_terms_add_up_to_the_reward(name):
    env = gym.make(f"sitl/Copter{name}-v0")
    env.action_space.seed(3)
    env.reset(seed=3)
    for _ in range(40):
        _, reward, terminated, _, info = env.step(env.action_space.sample())
        assert add_up(info) == pytest.approx(reward, abs=1e-9)
        assert {"is_success", "crashed", "touched", "outside", "true_pose"} <= info.keys()
        if terminated:
            env.reset()


@pytest.mark.parametrize("name", [*ids.PAPER, *ids.NEW, "sitl/Navigate-v0"])
def test_terms_of_every_id_add_up_to_the_reward(name):
    env = gym.make(name, info=["rewards"])
    env.action_space.seed(3)
    env.reset(seed=3)
    for _ in range(4):
        _, reward, terminated, truncated, info = env.step(env.action_space.sample())
        assert add_up(info) == pytest.approx(reward, abs=1e-9)
        if terminated or truncated:
            env.reset()
    env.close()


def test_terms_of_parking_add_up_to_the_end():
    """Also those of the step that parks."""
    env = gym.make("sitl/RoverParking-v0")
    env.reset(seed=3)
    task, place = env.unwrapped.task, env.unwrapped.robot.pose[0]
    task.positions[0, 0], task.headings[0] = place[:3], place[3]
    _, reward, terminated, _, info = env.step(np.zeros(2, np.float32))
    assert terminated and info["reward_parked"] == 20.0
    assert add_up(info) == pytest.approx(reward, abs=1e-9)


@pytest.mark.parametrize(
    ("task", "names"),
    [
        (Task(["forward", EachStep(-0.5), lambda step: 0.1 * step.pose[:, 0]]), {"forward", "each_step", "term_2"}),
        (ReachGoal(rewards=(Forward(),)), {"forward", "progress", "goal"}),
    ],
)
def test_terms_of_a_robot_that_crashes_add_up_too(task, names):
    env = gym.make("sitl/Navigate-v0", world="maze", task=task, info=["rewards"])
    env.reset(seed=1)
    crashes = 0
    for _ in range(60):
        _, reward, terminated, _, info = env.step(0)
        assert {f"reward_{name}" for name in (*names, "crash")} == {n for n in info if n.startswith("reward_")}
        assert add_up(info) == pytest.approx(reward, abs=1e-9)
        if terminated:
            crashes += info["reward_crash"] == reward == -200.0
            env.reset()
    assert crashes > 0


@pytest.mark.parametrize(("lost_reward", "names"), [(0.0, {"nearness"}), (-10.0, {"nearness", "lost"})])
def test_what_a_lost_target_costs_is_a_term_of_its_own(lost_reward, names):
    env = gym.make("sitl/CopterFollow-v1", task=Follow(lost=0.001, lost_reward=lost_reward), info=["rewards"])
    env.reset(seed=1)
    terminated = False
    while not terminated:
        _, reward, terminated, _, info = env.step(np.zeros(4, np.float32))
        assert {n for n in info if n.startswith("reward_")} == {f"reward_{name}" for name in (*names, "crash", "out")}
        assert add_up(info) == pytest.approx(reward, abs=1e-9)
    assert info.get("reward_lost", 0.0) == lost_reward and info["reward_nearness"] > 0.0
    env.close()


def test_the_true_pose_is_where_the_vehicle_really_is():
    env = gym.make("sitl/CopterHover-v0")
    env.reset(seed=2)
    *_, info = env.step(np.zeros(4, np.float32))
    robot = env.unwrapped.robot
    assert info["true_pose"].tolist() == robot.true_state()[0, :4].tolist()
    assert info["true_pose"][:3].tolist() != robot.pose[0, :3].tolist()


def test_vector_tells_what_singles_tell():
    vector = gym.make_vec("sitl/CopterForest-v0", num_envs=2)
    singles = gym.make_vec("sitl/CopterForest-v0", num_envs=2, vectorization_mode="sync")
    vector.reset(seed=5), singles.reset(seed=5)
    vector.action_space.seed(1)
    for _ in range(30):
        actions = vector.action_space.sample()
        got, expected = vector.step(actions)[4], singles.step(actions)[4]
        assert got.keys() == expected.keys()
        for name in got:
            assert same(got[name], expected[name]), name


def test_it_is_not_told_unless_asked_for_and_names_are_checked():
    env = gym.make("GazeboMazeTurtlebotLIDAR-v0")
    env.reset(seed=1)
    assert env.step(0)[4].keys() == {"crashed"}
    with pytest.raises(
        EnvOptionError, match="info 'reward' is not known; it is one of rewards, true_pose, estimate_error, events"
    ):
        gym.make("GazeboMazeTurtlebotLIDAR-v0", info=["reward"])


class _Counting(Waypoints):
    """A user's task: its info is another array in each step."""

    def info(self, step):
        return {**super().info(step), "steps": np.rint(step.robot.time / step.seconds)}


def test_infos_of_tasks_with_an_info_of_their_own_are_those_of_each_step():
    env = gym.make("sitl/CopterWaypoint-v1", task=_Counting(1))
    env.reset(seed=0)
    assert [env.step(np.zeros(4))[4]["steps"] for _ in range(3)] == [1.0, 2.0, 3.0]


def test_infos_are_the_readers_own_and_follow_a_copy():
    env = gym.make("sitl/CopterWaypoint-v1").unwrapped
    env.reset(seed=0)
    first, second = (env.step(np.ones(4))[4] for _ in range(2))
    assert first["true_pose"].tolist() != second["true_pose"].tolist()
    copy = pickle.loads(pickle.dumps(env))
    mine, its = (each.step(np.ones(4))[4] for each in (env, copy))
    assert {name: np.asarray(value).tolist() for name, value in mine.items()} == {
        name: np.asarray(value).tolist() for name, value in its.items()
    }
