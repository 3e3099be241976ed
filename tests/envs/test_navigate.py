# SPDX-License-Identifier: BSD-3-Clause
"""The pieces of an environment and their combinations."""

from __future__ import annotations

import math

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from pytest import approx

from sitl import worlds
from sitl.envs import EnvOptionError
from sitl.envs.actions import DRIVE, Discrete
from sitl.envs.observations import Digits
from sitl.envs.rewards import ByAction, EachStep, Forward, Nearness, Turning
from sitl.envs.tasks import ReachGoal, Task
from sitl.vehicles.turtlebot import Lidar

NAVIGATE = "sitl/Navigate-v1"


def make(**options):
    return gym.make(NAVIGATE, **options).unwrapped


@pytest.mark.parametrize("world", worlds.names())
def test_turtlebot_drives_in_every_world(world):
    env = make(world=world)
    env.reset(seed=0)
    env.step(0)
    assert env.robot.pose[0, 0] != worlds.load(world).start("turtlebot").position[0] or world == "office_erlecopter"


@pytest.mark.parametrize("action", ["discrete", "continuous"])
@pytest.mark.parametrize("observation", ["digits", "scan", "digits+pose", "scan+pose"])
@pytest.mark.parametrize("task", ["wander", "goal"])
def test_all_combinations_pass_gymnasiums_checker(action, observation, task, recwarn):
    check_env(gym.make(NAVIGATE, action=action, observation=observation, task=task).unwrapped, skip_render_check=True)
    assert [str(w.message) for w in recwarn] == []


def test_paper_task_needs_no_more_than_a_table():
    env = make(task="paper", observation="digits")
    env.reset()
    assert env.step(0)[1] == 5.0 and env.step(2)[1] == 1.0


def test_continuous_actions_are_speeds():
    env = make(action="continuous")
    env.reset()
    env.step(np.array([0.2, 0.1], np.float32))
    assert env.robot.velocity[0] == approx([0.2, 0.0, 0.0, 0.1], abs=0.006)


def test_step_time_is_exact():
    env = make(step_time=0.1)
    env.reset()
    for _ in range(7):
        env.step(0)
    assert env.robot.time[0] == approx(0.7, abs=1e-9)
    assert env.robot.pose[0, 0] == approx(0.21, rel=0.01)


def test_full_scan_has_the_range_where_there_is_nothing():
    env = make(world=worlds.World("open", (), (worlds.Start("o", (0.0, 0.0, 0.0), 0.0),)))
    observation, _ = env.reset()
    assert observation.tolist() == [20.0] * 20
    env = make(world=env.world, observation="digits")
    assert env.reset()[0].tolist() == [6] * 5


def test_digits_take_every_so_many_readings():
    env = make(observation=Digits(when_inf=9), lidar=Lidar(542, 271, math.radians(270.0)))
    observation, _ = env.reset()
    assert observation.shape == (6,)  # 271 // 5 = 54: readings 0, 54, ... 270
    assert env.observation_space.contains(observation)
    assert observation.tolist() == [int(r) for r in env.robot.scan[0, ::54]]


def test_random_starts_are_free_reachable_and_of_the_seed():
    env = make(world="maze", start="random")
    poses = []
    for seed in range(40):
        env.reset(seed=seed)
        pose = env.robot.pose[0]
        poses.append(tuple(pose))
        assert not env.step(1)[4]["crashed"]
    assert len(set(poses)) == 40
    env.reset(seed=7)
    assert tuple(env.robot.pose[0]) == poses[7]
    x0, y0, x1, y1 = env.world.bounds
    assert all(x0 < x < x1 and y0 < y < y1 for x, y, *_ in poses)


def test_random_starts_stay_inside_of_the_circuit():
    env = make(world="circuit2", start="random")
    for seed in range(60):
        env.reset(seed=seed)
        x, y = env.robot.pose[0, :2]
        assert not (-2.6 < x < 3.0 and -2.9 < y < -0.9), "within the island"
        assert not (x > 1.1 and y < -4.7), "outside of the walls"


def test_start_can_be_a_pose_a_function_or_an_option_of_reset():
    env = make(start=(0.5, 0.1, 0.2))
    env.reset()
    assert env.robot.pose[0] == approx([0.5, 0.1, 0.0, 0.2])
    env.reset(options={"pose": (1.0, 0.0, -0.1)})
    assert env.robot.pose[0] == approx([1.0, 0.0, 0.0, -0.1])
    env = make(start=lambda rng: (rng.uniform(0.0, 1.0), 0.0, 0.0))
    env.reset(seed=1)
    first = env.robot.pose[0, 0]
    env.reset()
    assert 0.0 < first < 1.0 and env.robot.pose[0, 0] != first


def test_properties_are_drawn_for_each_episode():
    env = make(randomise={"wheel_radius_left": (0.036, 0.037), "range_noise": lambda rng: 0.01})
    drifts = []
    for seed in (1, 1, 2):
        env.reset(seed=seed)
        env.step(0)
        drifts.append(env.robot.pose[0, 3])
    assert drifts[0] == drifts[1] != drifts[2]
    assert all(drift < -0.02 for drift in drifts)


def test_randomised_range_stays_in_the_space():
    env = make(randomise={"range_max": (15.0, 30.0)})
    assert env.observation_space.high.max() == 30.0


def test_rewards_are_added_up_and_replaced():
    env = make(task=Task(["forward", EachStep(-1.0), lambda step: 2.0 * step.commands[:, 1]]))
    env.reset()
    half = 0.115 * 0.3
    speed = 0.5 * ((0.05 - half) * 0.0352 / 0.035 + 0.05 + half)
    assert env.step(1)[1] == approx(25.0 * 0.6 * speed - 1.0 + 0.6)


def test_terms():
    env = make(task=Task([]), action="continuous")
    env.reset()
    assert env.step([0.3, 0.0])[1] == 0.0
    step = env._session.step
    assert Forward(10.0)(step) == approx([10.0 * 0.6 * 0.3], rel=0.01)
    assert Turning(-2.0)(step) == approx([-2.0 * 0.00746], rel=0.01)
    nearest = float(env.robot.scan.min())
    assert Nearness(1.0, -3.0)(step) == approx([-3.0 * (1.0 - nearest)])
    assert Nearness(0.1)(step) == [0.0]


def test_crash_can_be_further_off_or_never():
    env = make(task=Task(crash_range=0.7, crash_reward=-7.0))
    env.reset()
    assert env.step(0)[1:3] == (-7.0, True)
    env = make(task=Task(crash_range=0.0, contact_ends=False))
    env.reset()
    for _ in range(60):
        _, _, terminated, _, _ = env.step(0)
        assert not terminated
    assert env.robot.collided[0]


def test_contact_is_a_crash_even_where_no_ray_sees_it():
    env = make(lidar=Lidar(1, 1, 1.0), start=(0.0, 0.0, 1.2), task=Task(crash_range=0.19))
    env.reset()
    for _ in range(60):
        _, reward, terminated, _, info = env.step(0)
        if terminated:
            break
    assert terminated and reward == -200.0 and info["crashed"]
    assert env.robot.scan.min() > 0.19


def test_goal_is_reached_and_progress_pays():
    env = make(task=ReachGoal((1.0, 0.0), radius=0.3, rewards=()))
    env.reset()
    total, steps = 0.0, 0
    while True:
        _, reward, terminated, _, info = env.step(0)
        total, steps = total + reward, steps + 1
        if terminated:
            break
    assert info["reached"] and not info["crashed"] and info["goal"].tolist() == [1.0, 0.0]
    assert steps == 4
    assert total == approx(200.0 + 25.0 * 0.72, rel=0.01)


def test_random_goals_are_of_the_seed_and_the_snapshot():
    env = make(task="goal")
    env.reset(seed=3)
    goal = env.step(1)[4]["goal"]
    kept = env.snapshot()
    env.reset(seed=4)
    assert env.step(1)[4]["goal"].tolist() != goal.tolist()
    env.restore(kept)
    assert env.step(1)[4]["goal"].tolist() == goal.tolist()


def test_environments_do_not_share_a_task():
    task = ReachGoal()
    a, b = make(task=task), make(task=task)
    a.reset(seed=1)
    goal = a.task.goals.copy()
    b.reset(seed=2)
    assert np.array_equal(a.task.goals, goal) and not np.array_equal(b.task.goals, goal)


class Blind:
    """An observation of a user's own."""

    def space(self, robot):
        return gym.spaces.Box(0.0, 1.0, (1,), np.float32)

    def observe(self, robot):
        return np.zeros((robot.count, 1), np.float32)


def test_pieces_of_ones_own():
    table = Discrete(DRIVE, {"go": (0.2, 0.0), "spin": (0.0, 1.0)})
    env = make(observation=Blind(), action=table, task=Task([ByAction((1.0, 0.0))]))
    assert env.reset()[0].tolist() == [0.0]
    assert env.action_space.n == 2
    assert env.step(1)[1] == 0.0


def test_numpy_integers_are_actions():
    env = make()
    for action in (np.int64(1), np.array(1), np.uint8(2)):
        after = []
        for given in (action, int(action)):
            env.reset(seed=1)
            env.step(given)
            after.append(env.robot.pose[0].tolist())
        assert after[0] == after[1]


@pytest.mark.parametrize("step_time", [np.float32(0.1), 0.1 + 0.2 - 0.2, 0.100000005])
def test_step_time_is_the_nearest_whole_number_of_ticks(step_time):
    env = make(step_time=step_time)
    env.reset()
    env.step(0)
    assert env.step_time == 0.1 and env.robot.time[0] == approx(0.1, abs=1e-12)


def test_start_can_be_an_array():
    env = make(start=np.array([0.5, 0.1, 0.2]))
    env.reset()
    assert env.robot.pose[0] == approx([0.5, 0.1, 0.0, 0.2])


def test_random_starts_leave_room_for_the_greatest_robot():
    env = make(start="random", randomise={"radius": (0.4, 0.45)})
    for seed in range(40):
        env.reset(seed=seed)
        assert not env.step(1)[4]["crashed"]


def test_random_goals_are_not_where_the_robot_starts():
    env = make(task=ReachGoal(radius=1.0))
    for seed in range(100):
        env.reset(seed=seed)
        assert not env.step(1)[4]["reached"]


def test_digits_stay_in_the_space_whatever_a_function_draws():
    wall = worlds.Box((40.0, 0.0, 0.5), (1.0, 90.0, 1.0))
    world = worlds.World("far", (wall,), (worlds.Start("o", (0.0, 0.0, 0.0), 0.0),))
    env = make(world=world, observation="digits", randomise={"range_max": lambda rng: 90.0})
    observation, _ = env.reset()
    assert env.robot.scan[0, 8] == approx(42.4, abs=0.1) and observation[2] == 20
    assert env.observation_space.contains(observation)


def yard(half):
    """A yard that a wall without a gate divides; small boxes outside of it."""
    at = [((half, 0.0), 0.2, 2 * half), ((-half, 0.0), 0.2, 2 * half), ((0.0, half), 2 * half, 0.2)]
    at += [((0.0, -half), 2 * half, 0.2), ((0.0, 0.0), 0.2, 2 * half), ((half + 50.0, 0.0), 0.2, 0.2)]
    walls = tuple(worlds.Box((*xy, 0.5), (length, width, 1.0)) for xy, length, width in at)
    return worlds.World("yard", walls, (worlds.Start("o", (-0.5 * half, 0.0, 0.0), 0.0),))


def test_random_starts_stay_behind_walls_of_a_large_world():
    env = make(world=yard(200.0), start="random")
    for seed in range(100):
        env.reset(seed=seed)
        x, y = env.robot.pose[0, :2]
        assert -200.0 < x < 0.0 and abs(y) < 200.0
    with pytest.raises(EnvOptionError, match=r"world 'yard': 8051 x 8001 m is too large; say where instead"):
        make(world=yard(4000.0), start="random")
