# SPDX-License-Identifier: BSD-3-Clause
"""The lowest levels of action: sticks within [-1, 1], and a copter's motors driven directly, past the autopilot."""

from __future__ import annotations

import pickle

import gymnasium as gym
import numpy as np
import pytest

import sitl.envs  # noqa: F401
from sitl.autopilot.copter.modes.loiter import LOITER
from sitl.envs import EnvOptionError
from tests.envs.vector_equality import same

TRUTH = ["true_pose", "true_velocity", "true_attitude", "true_rates"]
OPTIONS = {"setpoint": "motors", "observation": TRUTH, "step_time": 0.01}
AHEAD, UP, ROLL = 4, 6, 8
"""Columns."""


def hover(env):
    """The action that the autopilot has just found."""
    controls = env.unwrapped.robot.view(0).actuators.controls[:4]
    return (2.0 * np.array(controls) - 1.0).astype(np.float32)


def test_bounds_are_normalised_and_one_number_a_motor():
    env = gym.make("sitl/CopterHover-v0", **OPTIONS)
    assert env.action_space == gym.spaces.Box(-1.0, 1.0, (4,), np.float32)
    assert env.unwrapped.session.action.limits == 4 * ((0.0, 1.0),)


def test_motors_do_what_they_are_told_and_the_autopilot_does_not_help():
    env = gym.make("sitl/CopterHover-v0", **OPTIONS)
    climbs = []
    for share in (-1.0, 1.0):
        env.reset(seed=1)
        for _ in range(50):
            seen, *_ = env.step(np.full(4, share, np.float32))
        climbs.append(seen[UP])
    assert climbs[0] < -3.5, "it falls"
    assert climbs[1] > 2.0


def test_more_thrust_on_the_left_rolls_to_the_right():
    env = gym.make("sitl/CopterHover-v0", **OPTIONS, randomise=None)  # in calm air: in wind it leans at the start
    env.reset(seed=1)
    turning = np.array([-0.02, 0.02, 0.02, -0.02], np.float32)  # of a quad X: 2 and 3 are on the left
    action = hover(env) + turning
    for _ in range(30):
        seen, *_ = env.step(action)
    assert seen[ROLL] > 0.03


def test_vector_equals_singles_and_goes_on_from_snapshots_and_pickles():
    options = {**OPTIONS, "observation": [*TRUTH, "velocity", "last_action"], "start": "random", "latency": 0.005}
    vector = gym.make_vec("sitl/CopterForest-v0", num_envs=3, **options)
    singles = gym.make_vec("sitl/CopterForest-v0", num_envs=3, vectorization_mode="sync", **options)
    vector.action_space.seed(4)
    assert same(vector.reset(seed=8)[0], singles.reset(seed=8)[0])
    for _ in range(150):
        actions = vector.action_space.sample()
        got, expected = vector.step(actions), singles.step(actions)
        assert same(got[0], expected[0])
        assert same(got[1], expected[1])
    assert np.abs(got[0][:, ROLL : ROLL + 2]).max() > 0.1, "an untrained agent does not fly"
    kept, copy = vector.unwrapped.snapshot(), pickle.loads(pickle.dumps(vector))
    after = vector.step(actions)[0]
    assert same(copy.step(actions)[0], after)
    vector.unwrapped.restore(kept)
    assert same(vector.step(actions)[0], after)


@pytest.mark.parametrize(("fault", "least", "most"), [("motor:1=0.5", 0.1, 0.75), ("motor:1/stuck", 0.3, 0.9)])
def test_a_motor_that_fails_does_so_here_too(fault, least, most):
    env = gym.make("sitl/CopterHover-v0", **OPTIONS, faults={fault: 0.05})
    env.reset(seed=1)
    for k in range(12):
        env.step(np.full(4, 0.3 if k < 5 else 0.8, np.float32))
    command = env.unwrapped.robot.view(0).physics.rotors.command
    assert command[1] == command[2] == command[3]
    assert least < command[0] / command[1] < most


def test_it_is_refused_where_it_cannot_be():
    options = {"setpoint": "motors", "action": "normalised", "world": "open"}
    for others in ({"robot": "erle_rover"}, {"robot": "erle_copter", "connection": "udp:127.0.0.1:1"}):
        with pytest.raises(EnvOptionError, match="driven directly, past the autopilot, by no message of MAVLink"):
            gym.make("sitl/Navigate-v1", **options, **others)


def test_sticks_are_centred_at_zero_and_reach_their_ends():
    env = gym.make("sitl/CopterHover-v0", setpoint="rc", observation=TRUTH, randomise=None)
    assert env.action_space == gym.spaces.Box(-1.0, 1.0, (4,), np.float32)
    assert env.unwrapped.session.action.limits == 4 * ((1100.0, 1900.0),)
    env.reset(seed=1)
    for _ in range(20):
        seen, *_ = env.step(np.zeros(4, np.float32))
    height = seen[2]
    assert abs(seen[UP]) < 0.2
    assert np.abs(seen[ROLL : ROLL + 2]).max() < 0.1
    for _ in range(10):
        seen, *_ = env.step(np.array([0.3, 0.0, 0.5, 0.0], np.float32))
    assert seen[ROLL] > 0.05, "roll right"
    assert seen[2] > height + 0.2, "climb"


def test_sticks_in_loiter_ask_for_velocities_and_centred_they_hold_the_position():
    env = gym.make("sitl/CopterHover-v1", setpoint="loiter", observation=TRUTH, randomise=None)
    assert env.action_space == gym.spaces.Box(-1.0, 1.0, (4,), np.float32)
    assert env.unwrapped.session.action.limits == 4 * ((1100.0, 1900.0),)
    env.reset(seed=1)
    for _ in range(20):
        seen, *_ = env.step(np.array([0.0, -0.3, 0.0, 0.0], np.float32))
    assert env.unwrapped.session.robot.view(0).autopilot.modes.number == LOITER
    assert seen[AHEAD] > 1.0, "pitch down: ahead"
    for _ in range(40):
        seen, *_ = env.step(np.zeros(4, np.float32))
    stopped = seen[:3]
    for _ in range(20):
        seen, *_ = env.step(np.zeros(4, np.float32))
    assert np.linalg.norm(seen[:3] - stopped) < 0.2, "it holds its position"


def test_a_rover_takes_steering_and_throttle_by_sticks_and_speed_and_turn_rate():
    for setpoint, action in (("rc", [0.5, 1.0]), ("velocity", [1.0, -0.5])):
        env = gym.make("sitl/RoverWaypoint-v0", setpoint=setpoint, observation=["velocity"])
        assert env.action_space == gym.spaces.Box(-1.0, 1.0, (2,), np.float32)
        env.reset(seed=1)
        for _ in range(10):
            seen, *_ = env.step(np.array(action, np.float32))
        assert seen[0] > 0.5, setpoint
        assert seen[3] < -0.05, "to the right"
