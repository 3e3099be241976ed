# SPDX-License-Identifier: BSD-3-Clause
"""What vehicles tell by messages of their own: acceleration, battery, wind, range-finder."""

from __future__ import annotations

import pickle

import gymnasium as gym
import numpy as np
import pytest

import sitl.envs  # noqa: F401
from sitl.envs import EnvOptionError
from sitl.envs.robots import autopilot
from sitl.envs.robots.in_process import InProcessVehicles
from sitl.errors import NotReadyError
from tests.envs import lockstep_vehicle
from tests.envs.test_autopilot_sockets import Lossy
from tests.envs.vector_equality import same
from tests.ports import free_port

TOLD = ["acceleration", "battery", "wind", "range_finder"]
COPTER = "sitl/CopterForest-v0"
ROVER = {"robot": "erle_rover", "world": "maze_erlerover", "observation": ["acceleration", "battery"]}


def test_they_are_what_the_vehicle_measures():
    env = gym.make(COPTER, observation=TOLD)
    env.reset(seed=1)
    for _ in range(10):
        row, *_ = env.step(np.zeros(4, np.float32))
    assert row.dtype == np.float32
    assert env.observation_space.contains(row)
    record = env.unwrapped.robot.view(0)
    forward, left, up, voltage, current, remaining, ahead, aside, below = row.tolist()
    assert up == pytest.approx(9.81, abs=1.5)
    assert abs(forward) + abs(left) < 2.0
    assert voltage == pytest.approx(record.autopilot.battery.voltage, abs=1e-3)
    assert current == pytest.approx(record.autopilot.battery.current, abs=0.011), "whole cA"
    assert remaining == pytest.approx(0.01 * record.autopilot.battery.remaining_pct, abs=0.01)
    assert ahead == aside == 0.0, "the copter's estimator knows no wind"
    assert below == pytest.approx(float(record.sensors.rangefinder_range[0]))
    assert below == pytest.approx(-record.physics.body.pos.z, abs=0.2)


def test_a_push_shows_in_the_acceleration():
    env = gym.make(COPTER, observation=["acceleration"])
    env.reset(seed=1)
    seen = [env.step(np.array([1.0, 0.0, 0.0, 0.0], np.float32))[0] for _ in range(8)]
    assert max(abs(row[0]) for row in seen) > 0.3


def test_vector_equals_singles_from_moved_starts():
    options = {"observation": [*TOLD, "velocity"], "start": "random", "randomise": {"mass": (1.0, 1.4)}}
    vector = gym.make_vec(COPTER, num_envs=3, **options)
    singles = gym.make_vec(COPTER, num_envs=3, vectorization_mode="sync", **options)
    vector.action_space.seed(2)
    first = vector.reset(seed=8)[0]
    assert same(first, singles.reset(seed=8)[0])
    assert (first[:, 2] > 5.0).all(), "told at the first moment, too"
    for _ in range(40):
        actions = vector.action_space.sample()
        assert same(vector.step(actions)[0], singles.step(actions)[0])
    kept, copy = vector.unwrapped.snapshot(), pickle.loads(pickle.dumps(vector))
    after = vector.step(actions)[0]
    assert same(copy.step(actions)[0], after)
    vector.unwrapped.restore(kept)
    assert same(vector.step(actions)[0], after)


def test_one_vehicle_with_a_link_of_its_own_tells_the_same(monkeypatch):
    options = {"observation": [*TOLD, "pose", "velocity"], "begin": "boot"}
    fleet = gym.make(COPTER, **options)
    a = fleet.reset(seed=3)[0]
    monkeypatch.setattr(autopilot, "make_vehicles", lambda setup, choice: InProcessVehicles(setup))
    alone = gym.make(COPTER, **options)
    b = alone.reset(seed=3)[0]
    for k in range(30):
        assert np.array_equal(a, b), k
        action = np.array([0.5, -0.2, 0.1, 0.3], np.float32)
        a, b = fleet.step(action)[0], alone.step(action)[0]


def test_by_udp_in_lockstep_with_lost_datagrams_it_is_the_same(tmp_path, monkeypatch):
    monkeypatch.setattr("sitl.client.connection._REPEAT_S", 0.05)
    port = free_port()
    options = ("--lockstep", "--out", f"udp:127.0.0.1:{port}")
    with lockstep_vehicle.vehicle(tmp_path, "rover", "maze_erlerover", *options):
        here = gym.make("sitl/Navigate-v1", **ROVER, boots=1)  # the vehicle over there has booted with seed 0
        there = gym.make("sitl/Navigate-v1", **ROVER, connection=f"udp:127.0.0.1:{port}")
        a, b = here.reset(seed=5)[0], there.reset(seed=5)[0]
        link = there.unwrapped.robot.link(0)
        link.stream = link.endpoint.link = lossy = Lossy(link.stream, 5)
        for k in range(30):
            assert np.array_equal(a, b), k
            a, b = here.step(k // 10 % 3)[0], there.step(k // 10 % 3)[0]
        assert lossy.lost > 5
        there.close()


def test_what_a_robot_does_not_tell_is_refused_by_name():
    with pytest.raises(EnvOptionError, match="'turtlebot' sends no SYS_STATUS"):
        gym.make("sitl/Navigate-v1", observation=["battery"])
    with pytest.raises(EnvOptionError, match="'erle_rover' has no range-finder"):
        gym.make("sitl/Navigate-v1", **{**ROVER, "observation": ["range_finder"]})
    with pytest.raises(NotReadyError, match="does not send WIND every 100 ms"):
        gym.make("sitl/Navigate-v1", **{**ROVER, "observation": ["wind"]}).reset(seed=1)
