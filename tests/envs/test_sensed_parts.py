# SPDX-License-Identifier: BSD-3-Clause
"""Parts with noise, bias, rate and latency of their own, and what vehicles would measure without errors."""

from __future__ import annotations

import math
import pickle

import gymnasium as gym
import numpy as np
import pytest

import sitl.envs  # noqa: F401
from sitl.envs import EnvOptionError
from sitl.envs.sensed import Sensed
from tests.envs.vector_equality import same

COPTER = "sitl/CopterForest-v0"
PUSH = np.array([0.6, -0.2, 0.1, 0.3], np.float32)


def flown(observation, steps=12, seed=1, **options):
    """Observations of an episode with the same actions."""
    env = gym.make(COPTER, observation=observation, **options)
    seen = [env.reset(seed=seed)[0], *(env.step(PUSH)[0] for _ in range(steps))]
    assert all(env.observation_space.contains(row) for row in seen)
    env.close()
    return np.array(seen)


@pytest.mark.parametrize("part", ["pose", "scan", "last_action", "goal", "range_finder", "acceleration"])
def test_rate_and_latency_show_earlier_readings(part):
    now, late, slow, both = (
        flown([Sensed(part, **settings)])
        for settings in ({}, {"latency": 0.2}, {"rate": 10 / 3}, {"latency": 0.2, "rate": 10 / 3})
    )
    assert np.array_equal(now, flown([part])), "without errors it is the part itself"
    assert not np.array_equal(now[0], now[9])
    for k in range(13):
        assert np.array_equal(late[k], now[max(k - 2, 0)]), k
        assert np.array_equal(slow[k], now[k // 3 * 3]), k
        assert np.array_equal(both[k], now[max((k - 2) // 3 * 3, 0)]), k


def test_noise_and_bias_have_the_size_that_was_asked_for_and_repeat_with_the_seed():
    clean = flown(["velocity", "velocity"], 60)
    parts = [Sensed("velocity", noise=0.1), Sensed("velocity", bias=(0.5, 0.0, 2.0, 0.0))]
    rows = flown(parts, 60) - clean
    assert np.array_equal(rows, flown(parts, 60) - clean)
    assert np.std(rows[:, :4]) == pytest.approx(0.1, rel=0.15)
    assert np.allclose(rows[:, 4:], rows[0, 4:], atol=1e-5), "a bias stays"
    assert np.all(rows[0, [5, 7]] == 0.0) and np.all(rows[0, [4, 6]] != 0.0)
    biased, exact = (gym.make(COPTER, observation=observation) for observation in (parts, ["velocity"]))
    biases = [biased.reset(seed=seed)[0][4] - exact.reset(seed=seed)[0][0] for seed in range(40)]
    assert 0.3 < np.std(biases) < 0.7


def test_parts_with_the_same_noise_have_noise_of_their_own():
    a, b = np.split(flown([Sensed("velocity", 0.1), {"part": "velocity", "noise": 0.1}], 3), 2, axis=1)
    assert not np.any(a == b)


def test_angles_stay_within_pi():
    yaws = flown([Sensed("pose", noise=(0.0, 0.0, 0.0, 3.0))], 100)[:, 3]
    assert np.abs(yaws).max() <= math.pi + 1e-6
    assert not np.any(np.abs(yaws) == np.float32(math.pi)), "turned, not clipped"


@pytest.mark.parametrize("robot", ["copter", "turtlebot"])
def test_vector_equals_singles_and_goes_on_from_snapshots_and_pickles(robot):
    late = [Sensed("velocity", 0.05, 0.1, latency=1.2, rate=1 / 1.2), Sensed("scan", 0.02), "pose"]
    if robot == "copter":
        name, options = COPTER, {"observation": {"a": late, "b": Sensed("goal", latency=0.6)}, "step_time": 0.6}
    else:
        name, options = "sitl/Navigate-v1", {"world": "maze", "observation": late, "start": "random"}
    vector = gym.make_vec(name, num_envs=3, max_episode_steps=9, **options)
    singles = gym.make_vec(name, num_envs=3, max_episode_steps=9, vectorization_mode="sync", **options)
    vector.action_space.seed(1)
    assert same(vector.reset(seed=3)[0], singles.reset(seed=3)[0])
    for _ in range(25):
        actions = vector.action_space.sample()
        got = vector.step(actions)
        assert same(got[0], singles.step(actions)[0])
    kept, copy = vector.unwrapped.snapshot(), pickle.loads(pickle.dumps(vector))
    after = vector.step(actions)[0]
    assert same(copy.step(actions)[0], after)
    vector.unwrapped.restore(kept)
    assert same(vector.unwrapped.observe(), got[0])
    assert same(vector.step(actions)[0], after)


def test_privileged_parts_are_as_it_really_is():
    told = ["acceleration", "battery", "wind", "height"]
    wind = {"wind_speed": (4.0, 4.0), "wind_direction": (90.0, 90.0)}
    env = gym.make(COPTER, observation=[*told, *(f"true_{part}" for part in told), "true_pose"], randomise=wind)
    env.reset(seed=1)
    for _ in range(30):
        row, *_ = env.step(PUSH)
    at = env.unwrapped.session.observation.slices
    record = env.unwrapped.robot.view(0)
    physics = record.physics
    assert np.allclose(row[at["true_acceleration"]] * (1, -1, -1), physics.body.specific_force, atol=1e-5)
    assert np.allclose(row[at["acceleration"]], row[at["true_acceleration"]], atol=1.0)
    assert np.any(row[at["acceleration"]] != row[at["true_acceleration"]])
    assert row[at["true_battery"]] == pytest.approx(
        [physics.battery.voltage, physics.battery.current, physics.battery.charge]
    )
    yaw = float(row[at["true_pose"]][3])
    north, east, _ = physics.wind.vel
    assert east == pytest.approx(-4.0, abs=0.2) and abs(north) < 0.2
    forward, left, up = row[at["true_wind"]].tolist()
    assert math.hypot(forward, left) == pytest.approx(4.0, abs=0.2) and abs(up) < 1e-3
    to = math.atan2(left, forward) + yaw  # in the world, where y is west
    assert math.remainder(to - math.pi / 2, math.tau) == pytest.approx(0.0, abs=0.05)
    assert row[at["wind"]].tolist() == [0.0, 0.0], "the copter's own estimate knows none"
    assert row[at["true_height"]] == pytest.approx([-physics.body.pos.z], abs=1e-4)


@pytest.mark.parametrize(
    ("piece", "says"),
    [
        (lambda: Sensed("veloc"), "did you mean 'velocity'"),
        (lambda: Sensed("velocity", noise=-1.0), r"sensed_velocity': noise = -1\.0"),
        (lambda: Sensed("velocity", noise=[0.1, 0.2]), "noise has 2 numbers; the part has 4"),
        (lambda: Sensed("velocity", latency=0.25), r"latency = 0\.25 s is not a whole number of steps of 0\.1 s"),
        (lambda: Sensed("velocity", rate=0.0), r"rate = 0\.0; it must be 0\.001"),
        (lambda: Sensed("depth"), "is a picture"),
        (lambda: {"part": "velocity", "noice": 1.0}, "noice"),
    ],
)
def test_what_cannot_be_is_refused_by_name(piece, says):
    with pytest.raises(EnvOptionError, match=says):
        gym.make(COPTER, observation=[piece()])


@pytest.mark.parametrize("part", ["true_wind", "true_battery", "true_acceleration"])
def test_a_turtlebot_has_no_such_truth(part):
    with pytest.raises(EnvOptionError, match=f"'{part}': robot 'turtlebot' has none"):
        gym.make("sitl/Navigate-v1", observation=[part])


@pytest.mark.parametrize("part", ["true_wind", "true_height", "true_pose"])
def test_nobody_knows_the_truth_of_a_vehicle_elsewhere(part):
    with pytest.raises(EnvOptionError, match="udp:127"):
        gym.make(
            "sitl/Navigate-v1", robot="erle_rover", world="maze_erlerover", observation=[part],
            connection="udp:127.0.0.1:1",
        )  # fmt: skip


@pytest.mark.parametrize("value", [-0.1, 1.1e6, math.nan, [0.1, -0.1], [[0.1, 0.1], [0.1, 0.1]], "much", [0.1, "x"]])
@pytest.mark.parametrize("what", ["noise", "bias"])
def test_sizes_are_one_number_or_one_for_each_column(what, value):
    with pytest.raises(EnvOptionError, match=r"must be 0 \.\. 1e6, or one such number for each column"):
        Sensed("velocity", **{what: value})
