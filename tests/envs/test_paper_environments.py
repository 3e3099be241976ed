# SPDX-License-Identifier: BSD-3-Clause
"""The paper's Turtlebot environments: start observations, rewards, crash rule, repeats, pickling, a lap by hand."""

from __future__ import annotations

import math
import os
import pickle
import subprocess
import sys

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from pytest import approx

from sitl import envs

START = {
    "GazeboCircuitTurtlebotLIDAR-v0": [0, 4, 5, 1, 0],
    "GazeboCircuit2TurtlebotLIDAR-v0": [1, 0, 2, 1, 0],
    "GazeboMazeTurtlebotLIDAR-v0": [0, 4, 1, 1, 0],
    "GazeboRoundTurtlebotLIDAR-v0": [2, 1, 3, 1, 1],
}
START_OF_ALL = {
    **START,
    "GazeboMazeErleRoverLIDAR-v0": [6, 4, 10, 13, 4, 6],
    "GazeboOfficeErleCopterLIDAR-v0": [5, 4, 9, 7, 10],
}
"""Computed from gym-gazebo's world files, without this simulator."""
CIRCUIT2 = "GazeboCircuit2TurtlebotLIDAR-v0"
MOVES = {  # forward and turning speed [m/s]
    "GazeboCircuitTurtlebotLIDAR-v0": (0.3, 0.05),
    "GazeboCircuit2TurtlebotLIDAR-v0": (0.3, 0.05),
    "GazeboMazeTurtlebotLIDAR-v0": (0.25, 0.05),
    "GazeboRoundTurtlebotLIDAR-v0": (0.3, 0.1),
}


FORWARD, LEFT, RIGHT = 0, 1, 2
CIRCUIT2_CORNERS = [(3.9, 0.0), (3.9, -3.8), (0.28, -3.8), (0.28, -7.65), (-3.7, -7.65), (-3.7, 0.0), (0.0, 0.0)]
"""Corners of the middle of circuit2's corridors, x and y [m], from the start round to it."""


def bearing_error(pose, corner):
    """How far to the left of the robot's heading the corner lies [rad]."""
    x, y, _, yaw = pose
    return math.remainder(math.atan2(corner[1] - y, corner[0] - x) - yaw, 2.0 * math.pi)


def drive(env, corners, near=0.3, most=600):
    """Go from corner to corner. Returns the steps, the sum of rewards, and which way it turned at each corner."""
    turns, steps, total = [], 0, 0.0
    for corner in corners:
        while True:
            pose = env.unwrapped.robot.pose[0].tolist()
            if math.dist(pose[:2], corner) < near:
                break
            error = bearing_error(pose, corner)
            action = FORWARD if abs(error) < 0.15 else LEFT if error > 0.0 else RIGHT
            if abs(error) > 0.8 and (not turns or turns[-1][1] != corner):
                turns.append(("left" if error > 0.0 else "right", corner))
            _, reward, terminated, truncated, _ = env.step(action)
            steps, total = steps + 1, total + reward
            assert not terminated, f"crashed at {pose} on the way to {corner}"
            assert not truncated and steps < most
    return steps, total, [way for way, _ in turns]


@pytest.mark.parametrize("name", START_OF_ALL)
def test_start_observations_are_those_of_the_world_files(name):
    for spelling in (name, name.replace("LIDAR", "Lidar")):
        env = gym.make(spelling)
        observation, _ = env.reset(seed=1)
        assert observation.tolist() == START_OF_ALL[name]
        assert env.observation_space.contains(observation)


@pytest.mark.parametrize("name", START_OF_ALL)
def test_environments_pass_gymnasiums_checker(name, recwarn):
    check_env(gym.make(name).unwrapped, skip_render_check=True)
    assert [str(w.message) for w in recwarn] == []


@pytest.mark.parametrize("name", START)
def test_rewards_and_moves_of_each_action(name):
    env = gym.make(name)
    forward, turning = MOVES[name]
    best = 3.0 if "Maze" in name else 5.0
    for action, reward, speed, turn in ((0, best, forward, 0.0), (1, 1.0, turning, 0.3), (2, 1.0, turning, -0.3)):
        env.reset()
        _, got, terminated, truncated, info = env.step(action)
        assert (got, terminated, truncated) == (reward, False, False)
        assert info == {"crashed": False}
        x, _, _, yaw = env.unwrapped.robot.pose[0]
        assert x == approx(0.6 * speed, rel=0.03)
        assert yaw == approx(0.6 * turn, abs=0.006)  # the left wheel is larger
        assert env.unwrapped.robot.time[0] == approx(0.6)


@pytest.mark.parametrize("name", START)
def test_driving_into_a_wall_is_a_crash_just_before_it_touches(name):
    env = gym.make(name)
    env.reset()
    for _ in range(200):
        _, reward, terminated, _, info = env.step(0)
        if terminated:
            break
        assert env.unwrapped.robot.scan.min() >= 0.2
    assert terminated and reward == -200.0 and info == {"crashed": True}
    assert env.unwrapped.robot.scan.min() < 0.2


def test_spelling_of_the_original_code_works():
    assert START.keys() <= envs.PAPER.keys()
    for name in START:
        env = gym.make(name.replace("LIDAR", "Lidar"))
        assert env.reset()[0].tolist() == START[name]


def test_id_can_name_the_package():
    out = subprocess.run(
        [sys.executable, "-c", "import gymnasium as g; print(g.make('sitl.envs:sitl/Navigate-v0').reset()[0].shape)"],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}, capture_output=True, text=True,
    )  # fmt: skip
    assert out.stdout == "(20,)\n", out.stderr


def test_importing_the_package_loads_no_compiler():
    """And nothing of the simulator but its version, and the errors that ours are kinds of."""
    heavy = "{'numba', 'pygame', 'pymavlink'} & set(sys.modules)"
    code = f"import sys, sitl.envs; print(sorted({heavy}), sorted(m for m in sys.modules if m.startswith('sitl')))"
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    out = subprocess.run([sys.executable, "-c", code], env=env, capture_output=True, text=True)
    ours = ["sitl", "sitl.envs", "sitl.envs.goals", "sitl.envs.ids", "sitl.envs.options", "sitl.errors", "sitl.version"]
    assert out.stdout == f"[] {ours}\n", out.stderr


def test_episodes_are_truncated_after_1500_steps_and_without_limit_never():
    env = gym.make(CIRCUIT2)
    env.reset()
    ends = [env.step(1)[2:4] for _ in range(1500)]  # small circles
    assert ends[:-1] == [(False, False)] * 1499 and ends[-1] == (False, True)
    env = gym.make(CIRCUIT2, max_episode_steps=-1)
    env.reset()
    assert not any(env.step(1)[3] for _ in range(1600))


def test_lap_of_circuit2_by_hand():
    env = gym.make(CIRCUIT2)
    env.reset()
    steps, total, turns = drive(env, CIRCUIT2_CORNERS)
    assert turns == ["right", "right", "left", "right", "right", "right"]
    assert 140 < steps < 250
    assert total > 600.0


EPISODES = """
import hashlib, gymnasium, envs
env = gymnasium.make("GazeboMazeTurtlebotLIDAR-v0", observation="scan", start="random",
                     randomise={"range_noise": (0.0, 0.02), "wheel_radius_left": (0.0345, 0.0355)})
env.action_space.seed(3)
observation, _ = env.reset(seed=11)
digest = hashlib.sha256(observation.tobytes())
for _ in range(300):
    observation, reward, terminated, truncated, _ = env.step(env.action_space.sample())
    digest.update(observation.tobytes() + repr((reward, terminated)).encode())
    if terminated or truncated:
        digest.update(env.reset()[0].tobytes())
print(digest.hexdigest())
"""


def test_same_seed_and_actions_in_another_process():
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    out = [subprocess.run([sys.executable, "-c", EPISODES], env=env, capture_output=True, text=True) for _ in range(2)]
    assert out[0].returncode == 0, out[0].stderr
    assert out[0].stdout == out[1].stdout


def trace(env, actions):
    out = []
    for action in actions:
        observation, reward, terminated, truncated, _ = env.step(action)
        out.append((observation.tolist(), reward, terminated, truncated))
        if terminated or truncated:
            out.append(env.reset()[0].tolist())
    return out


def noisy():
    return gym.make(CIRCUIT2, observation="scan", start="random", randomise={"range_noise": (0.0, 0.05)})


def test_snapshot_goes_on_bit_for_bit_also_in_another_environment():
    env = noisy()
    env.reset(seed=4)
    env.step(1)
    kept = pickle.loads(pickle.dumps(env.unwrapped.snapshot()))
    actions = [k % 3 for k in range(80)]
    first = trace(env.unwrapped, actions)
    assert sum(len(part) == 20 for part in first) > 0, "an episode ends on the way: the next start is drawn alike"
    assert np.array_equal(env.unwrapped.restore(kept), env.unwrapped.restore(kept))
    assert trace(env.unwrapped, actions) == first
    other = noisy()
    other.reset(seed=99)
    other.unwrapped.restore(kept)
    assert trace(other.unwrapped, actions) == first


def test_pickled_environment_goes_on_bit_for_bit():
    env = noisy()
    env.reset(seed=4)
    env.step(2)
    copy = pickle.loads(pickle.dumps(env))
    actions = [k % 3 for k in range(80)]
    assert trace(copy, actions) == trace(env, actions)
