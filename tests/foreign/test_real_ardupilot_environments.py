# SPDX-License-Identifier: BSD-3-Clause
"""Environments on a real ArduPilot: SITL_ARDUPILOT names the folder of ``arducopter`` and ``ardurover``."""

from __future__ import annotations

from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest

import sitl.envs  # noqa: F401
from benchmarks.deployment import abroad, run
from sitl.agents import baselines, learnt
from tests.foreign import test_real_ardupilot

pytestmark = test_real_ardupilot.pytestmark


@pytest.mark.filterwarnings("ignore:.*out of date")
@pytest.mark.parametrize(
    "name",
    ["sitl/CopterHover-v0", "sitl/CopterHover-v1", "sitl/CopterForest-v1", "sitl/CopterReachGoalDiscrete-v1",
     "sitl/RoverParking-v1", "sitl/RoverReachGoal-v0"],
)  # fmt: skip
def test_ids_with_wind_many_worlds_and_goals_are_flown(name):
    env = gym.make(name, autopilot=test_real_ardupilot.program("copter" if "Copter" in name else "rover"))
    worlds, winds = set(), set()
    for seed in (1, 2):
        env.reset(seed=seed)
        session = env.unwrapped.session
        link = session.robot.link(0)
        worlds.add(session.robot.world.name)
        wind = link.plant.vehicle.v.physics.wind
        if "wind_speed" in session.randomisation.ranges:
            winds.add(float(wind.speed))
            assert link.parameter("SIM_WIND_SPD") == pytest.approx(wind.speed, abs=1e-3)  # it knows its own wind
            assert wind.speed > 0.0
        for _ in range(5):
            observation, *_ = env.step(env.action_space.sample())
        assert env.observation_space.contains(observation)
    assert len(worlds) == (2 if "Forest" in name or "Parking" in name else 1)
    assert len(winds) == (2 if "Hover" in name else 0)
    env.close()


def test_a_policy_takes_it_over_and_hands_it_over_to_be_landed():
    kind, program = "copter", test_real_ardupilot.program("copter").partition(":")[2]
    with run(kind, 2.0, Path(program)) as (pilot, connection):
        flown = abroad(learnt.load(baselines.find("copter-waypoint")), pilot, connection, 2, 3.0)
        assert len(flown.episodes) == 2 and all(one.solved for one in flown.episodes)
        assert flown.deeds[-1].what == "handed over"
        pilot.wait_mode("BRAKE", 5.0)
        pilot.land()
        assert not pilot.armed


def test_two_drive_side_by_side():
    name, options = "sitl/RoverWaypoint-v1", {"autopilot": test_real_ardupilot.program("rover")}
    env = gym.make_vec(name, num_envs=2, vectorization_mode="vector_entry_point", **options)
    env.reset(seed=1)
    robot = env.unwrapped.session.robot
    for _ in range(10):
        env.step(np.array([[1.0, 0.0], [-1.0, 0.0]], np.float32))
    states = robot.true_state()
    assert states[0, 4] > 0.2 and states[1, 4] < -0.2
    env.close()
