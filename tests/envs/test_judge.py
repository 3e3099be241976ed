# SPDX-License-Identifier: BSD-3-Clause
"""Tasks are judged by where robots really are, and nothing is won by ending early."""

from __future__ import annotations

import pickle
from types import SimpleNamespace

import gymnasium as gym
import numpy as np
import pytest

import sitl.envs  # noqa: F401
from sitl.envs import EnvOptionError, ids
from sitl.envs.judge import ESTIMATE, TRUTH, Judge
from sitl.envs.senses import arrays_stay, reads_scan
from sitl.envs.targets.target_task import nearness
from sitl.envs.tasks_v1 import GOAL, HOVER_HALF, worst_of

CONTINUOUS = [name for name in ids.NEW if "Discrete" not in name]


def flown(name, steps, action=0.0, **options):
    """The environment and its last step, after as many steps of one action."""
    env = gym.make(name, **options)
    env.reset(seed=1000)
    for _ in range(steps):
        last = env.step(np.full(env.action_space.shape, action, np.float32))
        if last[2] or last[3]:
            break
    return env, last


@pytest.mark.parametrize("judge", [TRUTH, ESTIMATE])
def test_rewards_go_by_the_truth_unless_the_estimate_is_asked_for(judge):
    env, last = flown("sitl/CopterHover-v1", 30, judge=judge, sensors="gps", faults={"gps/wrong=4": 0.0})
    info, inner = last[4], env.unwrapped
    assert inner.session.judged_by == judge
    assert info["estimate_error"][0] > 2.0
    pose = info["true_pose"] if judge == TRUTH else inner.robot.pose[0]
    distance = np.linalg.norm(pose[:3] - inner.task.targets[0])
    assert info["reward_nearness"] == pytest.approx(0.1 * nearness(distance, 1.0, HOVER_HALF), abs=1e-9)
    env.close()


def test_the_error_is_the_estimate_minus_the_truth():
    env, last = flown("sitl/RoverWaypoint-v1", 3, 0.5)
    pose, info = env.unwrapped.robot.pose[0], last[4]
    assert info["estimate_error"].tolist() == pytest.approx((pose - info["true_pose"]).tolist(), abs=1e-12)
    assert env.unwrapped.session.judge.error()[0, 3] == info["estimate_error"][3]
    env.close()


def test_who_does_not_know_the_truth_is_judged_by_the_estimate():
    robot = SimpleNamespace(pose=np.ones((1, 4)), velocity=np.zeros((1, 4)))
    judge = Judge(robot, TRUTH)
    assert (judge.by, judge.knows_truth) == (ESTIMATE, False)
    assert judge.pose is robot.pose and judge.velocity is robot.velocity


class Moving:
    """A robot of a plugin, which says nothing about its arrays and makes new ones each time it is asked."""

    name, count = "moving", 1

    def __init__(self):
        self.moves = 0.0

    @property
    def state(self):
        return np.full((1, 12), 99.0)

    @property
    def pose(self):
        return np.full((1, 4), self.moves)

    @property
    def velocity(self):
        return np.full((1, 4), 10.0 + self.moves)


def test_what_a_robot_does_not_say_of_its_arrays_is_not_relied_on():
    robot = Moving()
    assert arrays_stay(robot) is False and reads_scan(robot) is True, "nothing is known, so it may"
    robot.arrays_stay, robot.reads_scan = True, False
    assert arrays_stay(robot) is True and reads_scan(robot) is False
    robot = Moving()
    judge = Judge(robot, ESTIMATE)
    for moves in (1.0, 2.0):
        robot.moves = moves
        judge.moved()
        assert judge.table().tolist() == [[moves] * 4 + [10.0 + moves] * 4]


def test_another_judge_is_refused():
    with pytest.raises(EnvOptionError, match="judge 'pilot' is not known; it is one of truth, estimate"):
        gym.make("sitl/CopterHover-v1", judge="pilot")


def test_first_versions_and_gates_say_who_judges():
    for name, judge in (
        ("sitl/CopterHover-v0", ESTIMATE), ("sitl/CopterGates-v0", TRUTH), ("sitl/CopterHover-v1", TRUTH),
        ("sitl/Navigate-v0", ESTIMATE), ("sitl/Navigate-v1", TRUTH),
    ):  # fmt: skip
        env = gym.make(name, **({"robot": "erle_rover"} if "Navigate" in name else {}))
        assert env.unwrapped.session.judged_by == judge, name
        env.close()


def test_a_judge_is_pickled_without_what_it_has_seen():
    env, _ = flown("sitl/RoverWaypoint-v1", 2, 0.5)
    other = pickle.loads(pickle.dumps(env.unwrapped))
    judges = [each.session.judge for each in (env.unwrapped, other)]
    assert judges[0].state().tolist() == judges[1].state().tolist()
    other.close()
    env.close()


@pytest.mark.parametrize("name", ["sitl/CopterReachGoal-v1", "sitl/RoverReachGoalDiscrete-v1"])
def test_a_goal_is_worth_what_the_step_paid_where_the_info_tells_the_error(name):
    env = gym.make(name, sensors="gps", faults={"gps/wrong=4": 0.0})
    seen, _ = env.reset(seed=3)
    differs = False
    for _ in range(40):
        seen, reward, *_, info = env.step(env.action_space.sample())
        goals = seen["achieved_goal"], seen["desired_goal"]
        compute = env.unwrapped.compute_reward
        assert compute(*goals, info) == pytest.approx(reward, abs=1e-6)
        many = compute(*(np.stack([goal, goal]) for goal in goals), np.array([info, info]))
        assert many.tolist() == pytest.approx([reward, reward], abs=1e-6)
        differs |= abs(float(compute(*goals, {})) - reward) > 1e-3
    assert differs  # the estimate is worth something else
    env.close()


def test_a_copter_that_sinks_to_the_floor_has_crashed():
    down = np.array([0.0, 0.0, -1.0, 0.0], np.float32)
    for version, ends in (("v1", True), ("v0", False)):
        env = gym.make(f"sitl/CopterWaypoint-{version}")
        env.reset(seed=5)
        for _ in range(60):
            _, reward, terminated, _, info = env.step(down)
            if terminated:
                break
        assert (terminated, info["crashed"]) == (ends, ends)
        assert not ends or reward == env.unwrapped.task.crash_reward
        env.close()


def test_nothing_ends_goal_conditioned_episodes_early():
    env, last = flown("sitl/CopterReachGoal-v1", 100, 1.0)
    assert last[2:4] == (False, True) and last[4]["outside"] and last[1] < -0.9
    env.close()


@pytest.mark.parametrize("name", CONTINUOUS)
def test_ending_early_is_worth_less_than_whatever_else_until_the_time_limit(name):
    env = gym.make(name)
    task, limit = env.unwrapped.task, env.spec.max_episode_steps
    if getattr(task, "is_sparse", False):
        assert task.crash_reward <= -limit and not task.out_ends
    else:
        worst = worst_of(task, limit * env.unwrapped.step_time)
        assert task.crash_reward < worst and task.out_reward < worst
        assert getattr(task, "lost_reward", worst - 1.0) < worst or task.lost > 1e6
        assert min(task.crash_reward, task.out_reward) > worst - GOAL, "or who has not learnt yet does not dare to try"
    env.close()
