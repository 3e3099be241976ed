# SPDX-License-Identifier: BSD-3-Clause
"""Slalom, races and parking: what counts as done, and what does not."""

from __future__ import annotations

import math

import gymnasium as gym
import numpy as np
import pytest

import sitl.envs  # noqa: F401 (registers the environments)
from sitl.envs import EnvOptionError
from sitl.envs.targets.gates import Gates
from sitl.envs.targets.parking import Park


def steered(env, seed, look=0):
    """Drive towards the next gate, at full speed; the last info."""
    observation, _ = env.reset(seed=seed)
    while True:
        ahead, left = observation[3 * look : 3 * look + 2].astype(float)
        turn = np.clip(2.0 * math.atan2(left, ahead), -1.0, 1.0)
        observation, _, terminated, truncated, info = env.step(np.array([1.0, turn], np.float32))
        if terminated or truncated:
            return info


def test_who_drives_from_gate_to_gate_finishes_the_slalom():
    env = gym.make("sitl/RoverSlalom-v0", start=None)
    info = steered(env, 1)
    assert info["is_success"] and info["passed"] == len(env.unwrapped.task.gates)


def test_laps_are_timed_and_the_best_is_kept():
    env = gym.make("sitl/RoverRace-v0", world="track:seed=1,difficulty=0.2", observation=["path", "velocity"])
    info = steered(env, 1)
    assert info["is_success"] and info["passed"] == 24
    assert 0.0 < info["best_lap"] <= info["lap_time"] < env.unwrapped.robot.time[0]


def test_a_rover_that_stands_in_its_bay_is_parked():
    task = Park([(6.0, 0.0, 0.0)])
    env = gym.make("sitl/RoverParking-v0", world="open", start=(0.0, 0.0, 0.0), task=task).unwrapped
    observation, _ = env.reset(seed=1)
    total, parked = 0.0, False
    for _ in range(100):
        at = env.session.observation.slices
        ahead = float(observation[at["goal"]][0])
        assert observation[at["goal_heading"]][0] > 0.98
        observation, reward, parked, _, info = env.step(np.array([np.clip(ahead, -0.7, 0.7), 0.0], np.float32))
        total += reward
        if parked:
            break
        assert not info["is_success"]
    assert parked and info["is_success"] and total > 20.0
    assert abs(env.robot.velocity[0, 0]) < task.speed and abs(env.robot.pose[0, 0] - 6.0) < task.radius


def test_passing_through_a_bay_or_standing_across_it_is_not_parking():
    env = gym.make("sitl/RoverParking-v0", world="open", start=(0.0, 0.0, 0.0), task=Park([(4.0, 0.0, 0.0)])).unwrapped
    env.reset(seed=1)
    for _ in range(40):
        _, _, terminated, _, info = env.step(np.array([1.0, 0.0], np.float32))
        assert not terminated and not info["is_success"]
    assert env.robot.pose[0, 0] > 6.0
    across = gym.make(
        "sitl/RoverParking-v0", world="open", start=(0.0, 0.0, 0.0), task=Park([(0.0, 0.0, math.pi / 2)])
    ).unwrapped
    across.reset(seed=1)
    assert across.task.turns()[0] == pytest.approx(math.pi / 2, abs=0.05)
    assert not across.step(np.zeros(2, np.float32))[4]["is_success"]


def test_a_rover_parks_by_its_table_of_actions():
    task = Park([(6.0, 0.5, 0.0)])  # its own idea of its place is half a metre to the left
    env = gym.make("sitl/RoverParkingDiscrete-v0", world="open", start=(0.0, 0.0, 0.0), task=task).unwrapped
    number = env.session.action.names.index
    env.reset(seed=1)
    info = {"is_success": False}
    for _ in range(60):
        *_, info = env.step(number("forward" if env.robot.pose[0, 0] < 5.1 else "stay"))
        if info["is_success"]:
            break
    assert info["is_success"] and abs(env.robot.velocity[0, 0]) < task.speed


@pytest.mark.parametrize(("move", "side"), [("back left", 1.0), ("back right", -1.0)])
def test_a_rover_backs_to_the_side_that_the_action_names(move, side):
    env = gym.make("sitl/RoverWaypointDiscrete-v0", start=(0.0, 0.0, 0.0)).unwrapped
    env.reset(seed=1)
    before = env.robot.pose[0].copy()
    for _ in range(20):
        env.step(env.session.action.names.index(move))
    x, y, _, yaw = env.robot.pose[0] - before
    assert x < -1.5 and side * y > 0.5 and side * yaw < -0.5


@pytest.mark.parametrize("name", ["CopterGates", "CopterForest", "CopterRooms", "CopterReachGoal", "RoverParking"])
def test_a_table_of_actions_is_within_the_limits_of_the_other_form(name):
    box, table = (gym.make(f"sitl/{name}{form}-v0").unwrapped.session.action for form in ("", "Discrete"))
    for column, (low, high) in zip(box.columns, box.limits, strict=True):
        assert low <= table.table[:, column].min() and table.table[:, column].max() <= high


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"task": Gates()}, r"world 'open' needs markings \"gate 1\".*it has none"),
        ({"task": Park()}, "world 'open' has no markings \"bay 1\""),
        ({"observation": ["goal", "goal_heading"]}, 'observation "goal_heading".*wants no heading'),
    ],
)
def test_what_a_world_or_task_lacks_is_said(options, says):
    with pytest.raises(EnvOptionError, match=says):
        gym.make("sitl/RoverWaypoint-v0", **options)


def test_bays_that_cannot_be_are_refused():
    with pytest.raises(EnvOptionError, match=r"it must be .x, y, yaw."):
        Park([(1.0, 2.0)])
    with pytest.raises(EnvOptionError, match="angle=0"):
        Park(angle=0.0)


@pytest.mark.parametrize("name", ["Waypoint", "ReachGoal"])
def test_a_rover_is_judged_in_x_and_y(name):
    """Its height is barometric: here it drifts by 1 m/s, beyond the radius of the place and out of the arena."""
    env = gym.make(f"sitl/Rover{name}-v0", randomise={"SIM_BARO_DRIFT": (1.0, 1.0)})
    env.reset(seed=1)
    robot, task = env.unwrapped.robot, env.unwrapped.task
    for _ in range(60):
        _, _, terminated, _, info = env.step(np.zeros(2, np.float32))
        assert not terminated and not info["outside"]
    assert abs(robot.pose[0, 2]) > 6.0
    task.positions[0, 0, :2] = robot.pose[0, :2]
    for _ in range(30):
        observation, reward, terminated, _, info = env.step(np.zeros(2, np.float32))
        if terminated:
            break
    assert info["is_success"]
    if name == "ReachGoal":
        assert (
            reward == env.unwrapped.compute_reward(observation["achieved_goal"], observation["desired_goal"], {}) == 0
        )
    env.close()
