# SPDX-License-Identifier: BSD-3-Clause
"""The paper's environments of vehicles with an autopilot, in process: observations, rules, repeats, many at once."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.error import InvalidAction
from pytest import approx

from sitl.autopilot.params.parm_files import ParameterWarning
from sitl.envs import EnvOptionError
from sitl.envs.tasks import Task
from sitl.errors import LinkLostError

ROVER, COPTER = "GazeboMazeErleRoverLIDAR-v0", "GazeboOfficeErleCopterLIDAR-v0"
MODE = {ROVER: 0, COPTER: 2}
"""MANUAL, ALT_HOLD."""


@pytest.mark.parametrize("name", MODE)
def test_a_step_is_a_tenth_of_a_second_in_the_papers_mode(name):
    env = gym.make(name)
    env.reset(seed=1)
    assert env.unwrapped.robot.time[0] == 0.0
    for k, reward in ((0, 5.0), (1, 1.0), (2, 1.0)):
        assert env.step(k)[1:] == (reward, False, False, {"crashed": False})
    assert env.unwrapped.robot.time[0] == approx(0.3)
    autopilot = env.unwrapped.robot.view(0).autopilot
    assert autopilot.modes.number == MODE[name]
    assert autopilot.arming.armed == 1


def test_the_rover_drives_at_the_papers_speed_and_turns_left_for_left():
    env = gym.make(ROVER)
    env.reset(seed=1)
    for _ in range(30):
        env.step(0)
    assert env.unwrapped.robot.velocity[0, 0] == approx(1.59, abs=0.05)
    heading = {}
    for action in (1, 2):
        env.reset()
        for _ in range(15):
            env.step(action)
        heading[action] = env.unwrapped.robot.pose[0, 3]
    assert heading[1] > 0.2 and heading[2] < -0.2


def test_the_copter_hovers_at_a_metre_and_leans_where_it_is_told():
    env = gym.make(COPTER)
    env.reset(seed=1)
    assert env.unwrapped.robot.pose[0, 2] == approx(1.0, abs=0.15)
    for action, axis, sign in ((0, 0, 1.0), (1, 1, 1.0), (2, 1, -1.0)):
        env.reset()
        for _ in range(10):
            env.step(action)
        assert sign * env.unwrapped.robot.velocity[0, axis] > 0.4
        assert env.unwrapped.robot.pose[0, 2] == approx(1.0, abs=0.2)


@pytest.mark.parametrize(("name", "nearest"), [(ROVER, 1.5), (COPTER, 0.2)])
def test_going_straight_on_ends_in_a_crash(name, nearest):
    env = gym.make(name)
    env.reset(seed=1)
    for _ in range(200):
        _, reward, terminated, _, info = env.step(0)
        if terminated:
            break
        assert env.unwrapped.robot.scan.min() >= nearest
    assert terminated and reward == -200.0 and info == {"crashed": True}
    env.reset()
    assert not env.step(0)[2]


@pytest.mark.parametrize("name", MODE)
def test_touching_a_wall_ends_the_episode_without_the_lidar(name):
    env = gym.make(name, task=Task(crash_range=0.0))
    env.reset(seed=1)
    ends = [env.step(0)[2] for _ in range(1)]
    while not ends[-1]:
        ends.append(env.step(0)[2])
        assert len(ends) < 300
    assert env.unwrapped.robot.collided[0] == 1
    env = gym.make(name, task=Task(crash_range=0.0, contact_ends=False))
    env.reset(seed=1)
    assert not any(env.step(0)[2] for _ in range(len(ends) + 5))


EPISODES = """
import hashlib, sys, gymnasium, envs
env = gymnasium.make(sys.argv[1], observation="scan+pose")
env.action_space.seed(3)
observation, _ = env.reset(seed=11)
digest = hashlib.sha256(observation["scan"].tobytes() + observation["pose"].tobytes())
for k in range(150):
    observation, reward, terminated, truncated, _ = env.step(0 if k % 3 else env.action_space.sample())
    digest.update(observation["scan"].tobytes() + observation["pose"].tobytes() + repr((reward, terminated)).encode())
    if terminated or truncated:
        digest.update(env.reset()[0]["scan"].tobytes())
print(digest.hexdigest())
"""


@pytest.mark.parametrize("name", MODE)
def test_same_seed_and_actions_in_another_process(name):
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-c", EPISODES, name]
    out = [subprocess.run(command, env=env, capture_output=True, text=True) for _ in range(2)]
    assert out[0].returncode == 0, out[0].stderr
    assert out[0].stdout == out[1].stdout


def trace(env, actions):
    out = []
    for action in actions:
        observation, reward, terminated, truncated, _ = env.step(action)
        out.append((observation["scan"].tobytes(), observation["pose"].tobytes(), reward, terminated, truncated))
        if terminated or truncated:
            out.append(env.reset()[0]["pose"].tobytes())
    return out


def test_other_seeds_have_other_noise():
    env = gym.make(ROVER, observation="scan+pose")
    traces = []
    for seed in (1, 1, 2):
        env.reset(seed=seed)
        traces.append(trace(env, [0] * 10))
    assert traces[0] == traces[1] != traces[2]


@pytest.mark.parametrize("name", MODE)
def test_snapshot_and_pickle_go_on_bit_for_bit(name):
    env = gym.make(name, observation="scan+pose")
    env.reset(seed=4)
    env.step(1)
    kept = pickle.loads(pickle.dumps(env.unwrapped.snapshot()))
    copy = pickle.loads(pickle.dumps(env.unwrapped))
    actions = [0] * 20 + [k // 5 % 3 for k in range(60)]
    first = trace(env.unwrapped, actions)
    assert trace(copy, actions) == first
    other = gym.make(name, observation="scan+pose")
    other.reset(seed=99)
    other.unwrapped.restore(kept)
    again = other.unwrapped.snapshot()
    assert pickle.dumps(again.robot.telemetry) == pickle.dumps(kept.robot.telemetry), "times of what was told, too"
    assert (again.robot.origin, again.robot.began_us) == (kept.robot.origin, kept.robot.began_us)
    assert trace(other.unwrapped, actions) == first


CASES = [
    (ROVER, {"observation": "scan+pose"}, 60),
    (COPTER, {}, 60),
    ("sitl/Navigate-v0", {"robot": "erle_rover", "world": "maze_erlerover", "action": "continuous",
                          "start": lambda rng: (rng.uniform(-2.0, 2.0), 0.0, 0.0)}, 30),
]  # fmt: skip


def same(a, b):
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[k], b[k]) for k in a)
    return a.dtype == b.dtype and np.array_equal(a, b)


@pytest.mark.parametrize(("name", "options", "steps"), CASES)
def test_vector_equals_singles(name, options, steps):
    vector = gym.make_vec(name, num_envs=3, vectorization_mode="vector_entry_point", threads=2, **options)
    singles = gym.make_vec(name, num_envs=3, vectorization_mode="sync", **options)
    assert vector.unwrapped.robot.count == 3
    vector.action_space.seed(2)
    assert same(vector.reset(seed=8)[0], singles.reset(seed=8)[0])
    for k in range(steps):
        actions = vector.action_space.sample()
        if k > 15 and actions.dtype == np.int64:
            actions[0] = 0  # straight on: this one crashes and starts again
        got, expected = vector.step(actions), singles.step(actions)
        assert same(got[0], expected[0])
        for a, b in zip(got[1:4], expected[1:4]):
            assert same(a, b)


def test_steps_of_other_lengths_end_with_fresh_telemetry():
    env = gym.make(COPTER, step_time=0.35, observation="scan+pose")
    env.reset(seed=1)
    for _ in range(4):
        env.step(0)
        robot = env.unwrapped.robot
        v = robot.view(0)
        assert robot.pose[0, 2] == approx(-float(v.autopilot.estimate.pos[2]), abs=0.09)
        assert robot.velocity[0, 2] == np.float32(-float(v.autopilot.estimate.vel[2]))
    assert robot.time[0] == approx(1.4)


def test_a_view_follows_the_vehicle_and_a_simulation_is_a_copy():
    robot = (env := gym.make(COPTER)).unwrapped.robot
    env.reset(seed=1)
    view, copy = robot.view(0), robot.simulation(0)
    assert robot.link(0) is None and view.time_us == copy.v.time_us
    began_us, state = view.time_us, bytes(view._bytes)
    copy.advance(1.0)
    assert bytes(view._bytes) == state
    env.step(0)
    assert view.time_us == began_us + 100_000 and robot.view(0) is view


def test_properties_are_drawn_anew():
    env = gym.make(ROVER, randomise={"mass": (700.0, 900.0)})
    masses = []
    for seed in (1, 2, 1):
        env.reset(seed=seed)
        masses.append(float(env.unwrapped.robot.view(0).physics.airframe.mass))
    assert masses[0] == masses[2] != masses[1]


def test_a_file_of_parameters_is_taken_as_a_vehicle_takes_it(tmp_path):
    (tmp_path / "mine.params").write_text("1\t1\tWP_SPEED\t1.5\t9\n1\t1\tLOG_BACKEND_TYPE\t2\t2\n1\t1\tNO_SUCH\t1\t9\n")
    with pytest.warns(ParameterWarning) as told:
        env = gym.make(ROVER, params=tmp_path / "mine.params", randomise={"mass": (700.0, 900.0)})
        env.reset(seed=1)
        env.reset(seed=2)
    values = env.unwrapped.robot.simulation(0).parameters
    assert (values["WP_SPEED"], values["LOG_BACKEND_TYPE"]) == (1.5, 2.0)
    said = [str(w.message) for w in told]
    assert len(said) == 2 and "NO_SUCH" in said[0] and "LOG_BACKEND_TYPE 2 (1)" in said[1], (
        "told once, not each episode"
    )
    env.close()


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"frame": "skid_rover"}, "observation and task: lidar readings are needed, and 'skid_rover' has no lidar"),
        ({"frame": "no_rover"}, "'no_rover' is not known"),
        ({"take_of": 2.0}, "did you mean 'take_off'"),
        ({"setpoint": "drive"}, "takes velocity, rc, position, attitude"),
        ({"step_time": 0.01}, "whole number of 0.02 s"),
        ({"connection": "http:1"}, "is none of"),
        ({"connection": "tcp:127.0.0.1:1", "params": {"WP_SPEED": 1.0}}, "leads to one vehicle"),
        ({"gcs": "udpout:14550"}, "gcs: link 'udpout:14550': the host is missing"),
        ({"params": {"WP_SPEED": float("nan")}}, "WP_SPEED"),
        ({"threads": 0}, "threads = 0; a whole number from 1 on"),
        ({"threads": 2, "physics": "pybullet"}, "threads = 2: only vehicles in process on native physics"),
        ({"threads": 2, "gcs": "udpout:127.0.0.1:14550"}, "threads = 2: only"),
        ({"action": "discrete", "setpoint": "position"}, "no discrete actions for setpoint 'position'"),
    ],
)
def test_wrong_options_are_refused(options, text):
    with pytest.raises(EnvOptionError, match=text):
        gym.make(ROVER, **options).reset()


@pytest.mark.parametrize(("name", "action"), [(ROVER, 3), (COPTER, -1), (COPTER, 0.5)])
def test_actions_outside_the_space_are_refused(name, action):
    env = gym.make(name, disable_env_checker=True)
    env.reset()
    with pytest.raises(InvalidAction, match="forward"):
        env.step(action)
    env = gym.make(
        name, task="wander", action="continuous", setpoint="velocity", clip_actions=False, disable_env_checker=True
    )
    env.reset()
    with pytest.raises(InvalidAction, match="forward"):
        env.step(np.full(env.action_space.shape, 9.0))


def test_a_ground_station_sees_the_vehicle():
    import socket

    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as station:
        station.bind(("127.0.0.1", 0))
        station.settimeout(5.0)
        plain = gym.make(ROVER, observation="scan+pose")
        watched = gym.make(ROVER, observation="scan+pose", gcs=f"udpout:127.0.0.1:{station.getsockname()[1]}")
        for env in (plain, watched):
            env.reset(seed=3)
        assert trace(plain, [0] * 30) == trace(watched, [0] * 30)
        assert station.recv(2048)[0] == 0xFD
        watched.close()


def test_a_closed_environment_is_opened_by_reset() -> None:
    env = gym.make("GazeboMazeErleRoverLIDAR-v0").unwrapped
    first, _ = env.reset(seed=1)
    env.close()
    env.close()
    with pytest.raises(LinkLostError, match=r"is not open; reset\(\) opens it"):
        env.step(0)
    again, _ = env.reset(seed=1)
    assert np.array_equal(again, first)
    env.step(0)
