# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles with an autopilot find their way under velocity set-points, and follow the other kinds, too."""

from __future__ import annotations

import math

import gymnasium as gym
from pytest import approx

MAZE = [(7.5, 0.0), (7.5, 9.7), (-11.0, 9.7), (-11.0, -9.5), (-2.5, -10.0)]
"""Through the first corridors of the rover's maze [m]."""
OFFICE = [(-9.0, 1.0), (-12.0, -2.0), (-9.0, 2.0), (1.5, 1.0), (1.5, -9.0)]
"""From room to room."""


def go(env, places, action_of, near, most):
    """From place to place; returns the steps. Fails on a crash and after ``most`` steps."""
    steps = 0
    for place in places:
        while True:
            x, y, _, yaw = env.unwrapped.robot.pose[0].tolist()
            distance = math.dist((x, y), place)
            if distance < near:
                break
            bearing = math.remainder(math.atan2(place[1] - y, place[0] - x) - yaw, 2.0 * math.pi)
            _, _, terminated, _, info = env.step(action_of(distance, bearing))
            assert not terminated, f"{info} at {x:.1f}, {y:.1f} on the way to {place}"
            steps += 1
            assert steps < most
    return steps


def test_the_rover_gets_through_the_first_corridors_of_the_maze():
    env = gym.make("sitl.envs:sitl/Navigate-v0", robot="erle_rover", world="maze_erlerover", action="continuous",
                   setpoint="velocity", max_episode_steps=-1)  # fmt: skip
    env.reset(seed=1)

    def drive(distance, bearing):
        return [1.2 if abs(bearing) < 0.5 else 0.8, max(-0.45, min(0.45, 1.2 * bearing))]

    steps = go(env, MAZE, drive, near=1.5, most=1500)
    assert steps > 400
    assert env.unwrapped.robot.view(0).physics.obstacles.hit_count == 0


def test_the_copter_flies_through_the_office():
    env = gym.make("sitl.envs:sitl/Navigate-v0", robot="erle_copter", world="office_erlecopter", action="continuous",
                   setpoint="velocity", max_episode_steps=-1)  # fmt: skip
    env.reset(seed=1)

    def fly(distance, bearing):
        height = 1.2 - env.unwrapped.robot.pose[0, 2]
        speed = min(0.9, distance)
        return [speed * math.cos(bearing), speed * math.sin(bearing), max(-0.4, min(0.4, height)),
                max(-0.8, min(0.8, bearing))]  # fmt: skip

    steps = go(env, OFFICE, fly, near=0.5, most=1200)
    assert steps > 300
    assert env.unwrapped.robot.pose[0, 2] == approx(1.2, abs=0.15)


def test_the_copter_goes_to_a_place_and_turns_there():
    env = gym.make("sitl.envs:sitl/Navigate-v0", robot="erle_copter", world="office_erlecopter", action="continuous",
                   setpoint="position")  # fmt: skip
    env.reset(seed=1)
    for _ in range(80):
        assert not env.step([-4.0, 1.0, 1.5, 1.0])[2]
    assert env.unwrapped.robot.pose[0].tolist() == approx([-4.0, 1.0, 1.5, 1.0], abs=0.25)


def test_the_rover_goes_to_a_place():
    env = gym.make("sitl.envs:sitl/Navigate-v0", robot="erle_rover", world="maze_erlerover", action="continuous",
                   setpoint="position")  # fmt: skip
    env.reset(seed=1)
    for _ in range(100):
        assert not env.step([6.0, 0.0])[2]
    x, y, _, _ = env.unwrapped.robot.pose[0]
    assert math.dist((x, y), (6.0, 0.0)) < 2.1  # WP_RADIUS


def test_attitude_set_points_are_followed():
    env = gym.make("sitl.envs:sitl/Navigate-v0", robot="erle_copter", world="office_erlecopter", action="continuous",
                   setpoint="attitude")  # fmt: skip
    env.reset(seed=1)
    for _ in range(10):
        env.step([0.05, 0.0, 0.0, 0.3])
    assert env.unwrapped.robot.view(0).autopilot.estimate.euler[0] == approx(0.05, abs=0.02)
    assert env.unwrapped.robot.velocity[0, 1] < -0.2
    assert env.unwrapped.robot.velocity[0, 2] > 0.2
    env = gym.make("sitl.envs:sitl/Navigate-v0", robot="erle_rover", world="maze_erlerover", action="continuous",
                   setpoint="attitude")  # fmt: skip
    env.reset(seed=1)
    for _ in range(40):
        env.step([0.3, 0.8])
    assert env.unwrapped.robot.velocity[0, 0] == approx(0.96, abs=0.1)
    assert env.unwrapped.robot.velocity[0, 3] == approx(0.3, abs=0.1)
