# SPDX-License-Identifier: BSD-3-Clause
"""Episodes begin with one prepared vehicle that is moved; boot and take-off at each start can still be had."""

from __future__ import annotations

import math
import pickle

import gymnasium as gym
import numpy as np
import pytest

import sitl.envs  # noqa: F401
from sitl.envs.options import EnvOptionError
from sitl.envs.robots import in_process
from sitl.envs.robots.starts import Starts

COPTER, ROVER = "GazeboOfficeErleCopterLIDAR-v0", "GazeboMazeErleRoverLIDAR-v0"
PROPERTIES = {
    COPTER: {
        "mass": (1.0, 1.3),
        "wind_speed": (0.0, 3.0),
        "wind_direction": (0.0, 360.0),
        "wind_turbulence": (0.0, 1.0),
    },
    ROVER: {"mass": (2.0, 3.0), "lidar_noise": (0.0, 0.05)},
}
POSES = {COPTER: [(-1.0, 0.5, 0.08, 1.0), (1.5, -1.0, 0.08, -2.5)], ROVER: [(1.0, 0.5, 0.7), (0.5, -0.5, -3.0)]}


def make(name: str, **options):
    return gym.make(name, observation="scan", **options).unwrapped


def record(env) -> bytes:
    return env.robot._vehicles.fleet.records.tobytes()


@pytest.fixture
def starts(monkeypatch):
    monkeypatch.setattr(in_process, "STARTS", Starts())
    return in_process.STARTS


@pytest.mark.parametrize("name", (COPTER, ROVER))
def test_the_usual_start_is_not_moved(name):
    envs = [make(name, begin=begin) for begin in ("move", "boot")]
    for seed in (3, 4):
        assert np.array_equal(*(env.reset(seed=seed)[0] for env in envs))
        for action in (0, 1, 2, 0):
            assert np.array_equal(*(env.step(action)[0] for env in envs))
            assert record(envs[0]) == record(envs[1])


@pytest.mark.parametrize("name", (COPTER, ROVER))
def test_a_start_pose_that_is_given_is_where_the_vehicle_is_prepared(name):
    pose = POSES[name][0]
    envs = [make(name, begin=begin, start=pose) for begin in ("move", "boot")]
    again = pickle.loads(pickle.dumps(envs[0]))
    for env in (*envs, again):
        env.reset(seed=5)
        env.step(1)
    assert record(envs[0]) == record(envs[1]) == record(again)


@pytest.mark.parametrize("name", (COPTER, ROVER))
def test_many_robots_are_as_one_each_and_repeat(name, starts):
    options = {"start": "random", "randomise": PROPERTIES[name]}
    many = gym.make_vec(name, num_envs=3, vectorization_mode="vector_entry_point", observation="scan", **options)
    singles = [make(name, **options) for _ in range(3)]
    kept = []
    for _ in range(2):
        seen = [many.reset(seed=9)[0].copy()]
        seen += [many.step(np.array([k % 3] * 3))[0].copy() for k in range(5)]
        for i, env in enumerate(singles):
            assert np.array_equal(env.reset(seed=9 + i)[0], seen[0][i])
            for k in range(5):
                assert np.array_equal(env.step(k % 3)[0], seen[k + 1][i])
        kept.append(seen)
    assert np.array_equal(kept[0], kept[1])
    assert len(starts) == 1


@pytest.mark.parametrize("name", (COPTER, ROVER))
def test_a_moved_episode_is_like_one_that_was_booted_there(name):
    """Where it is, where it thinks to be, what it sees at first, and where it gets within some seconds."""
    for pose in POSES[name]:
        ends, errors, scans = [], [], []
        for begin in ("move", "boot"):
            env = make(name, begin=begin, setpoint="velocity" if name == COPTER else "rc")
            env.reset(seed=1, options={"pose": pose})
            body = env.robot.view(0).physics.body
            before = np.array(body.pos)
            yaw = math.atan2(2.0 * (body.q.w * body.q.z + body.q.x * body.q.y), 1.0 - 2.0 * (body.q.y**2 + body.q.z**2))
            assert math.hypot(before[0] - pose[0], -before[1] - pose[1]) < (1.0 if begin == "boot" else 0.25)
            assert math.remainder(-yaw - pose[-1], math.tau) == pytest.approx(0.0, abs=0.03)
            assert math.remainder(env.robot.pose[0, 3] - pose[-1], math.tau) == pytest.approx(0.0, abs=0.05)
            errors.append(math.hypot(*(env.robot.pose[0, :2] - pose[:2])))
            scans.append(env.robot.scan[0].copy())
            e = env.robot.view(0).autopilot.estimate
            resets = e.reset_ne_count, e.reset_d_count, e.reset_yaw_count
            for _ in range(12):
                env.step(0)
                assert max(e.variance_pos, e.variance_vel, e.variance_hgt, e.variance_mag) < 0.6
            assert (e.reset_ne_count, e.reset_d_count, e.reset_yaw_count) == resets
            ends.append(np.array(body.pos) - before)
        assert np.linalg.norm(ends[0] - ends[1]) < 0.15
        assert max(errors) < 2.5
        near = np.maximum(*scans) < 9.0
        assert np.median(np.abs(scans[0][near] - scans[1][near])) < (0.01 if name == ROVER else 0.8)


def test_another_pose_costs_no_other_preparation_and_boot_does(starts):
    moved, booted = make(COPTER), make(COPTER, begin="boot")
    for env, count in ((moved, 1), (booted, 3)):
        for pose in POSES[COPTER]:
            env.reset(seed=1, options={"pose": pose})
        assert len(starts) == count


def test_snapshots_go_on_from_a_moved_start():
    env = make(COPTER, start="random", randomise=PROPERTIES[COPTER])
    env.reset(seed=8)
    for steps in (0, 2):
        for _ in range(steps):
            env.step(0)
        kept = pickle.loads(pickle.dumps(env.snapshot()))
        first = [env.step(k % 3)[0] for k in range(4)]
        env.restore(kept)
        assert all(np.array_equal(a, env.step(k % 3)[0]) for k, a in enumerate(first))


def test_the_kind_of_set_point_can_change_between_episodes():
    env = make(COPTER, start="random")
    env.reset(seed=1)
    env.step(0)
    env.reset(seed=2)
    one = env.step(1)[0]
    fresh = make(COPTER, start="random")
    fresh.reset(seed=2)
    assert np.array_equal(fresh.step(1)[0], one)


def test_what_cannot_be_is_refused():
    with pytest.raises(EnvOptionError, match="begin 'teleport'"):
        make(COPTER, begin="teleport")
    env = make(ROVER)
    env.reset(seed=0)
    for pose, complaint in (
        ((math.nan, 0.0, 0.0), "start"),
        ((0.0, math.inf, 0.0), "start"),
        ((0.0, 0.0, 3.0, 0.0), "on the floor"),
    ):
        with pytest.raises(EnvOptionError, match=complaint):
            env.reset(options={"pose": pose})
    heavy = make(COPTER, randomise={"mass": lambda rng: 25.0})
    with pytest.raises(EnvOptionError, match="does not hover with properties"):
        heavy.reset(seed=0)
