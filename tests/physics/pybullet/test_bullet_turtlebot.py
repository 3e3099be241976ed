# SPDX-License-Identifier: BSD-3-Clause
"""Turtlebots in Bullet: drift, arcs, time-out, walls, lidar, repeats; and in an environment."""

from __future__ import annotations

import math
import pickle

import gymnasium as gym
import numpy as np
import pytest

pytest.importorskip("pybullet")

from gymnasium.utils.env_checker import check_env
from pytest import approx

import sitl.envs  # noqa: F401
from sitl.envs.options import EnvOptionError
from sitl.envs.robots.turtlebot import Turtlebot
from sitl.turtlebots.bullet import BulletTurtlebots
from sitl.turtlebots.native import Turtlebots
from sitl.vehicles.turtlebot import AIRFRAME
from sitl.worlds import Box, Start, World

OPEN = World("open", (), (Start("origin", (0.0, 0.0, 0.0), 0.0),))
WALL = World("wall", (Box((1.0, 0.0, 0.5), (0.2, 4.0, 1.0)),), OPEN.starts)
EVEN = AIRFRAME.changed(wheel_radius_left=0.035)
"""Without the drift."""


def drive(robots: Turtlebots, seconds: float, forward: float, turn: float) -> None:
    """Steps of 0.5 s under one command."""
    for _ in range(round(2.0 * seconds)):
        robots.commands[:] = forward, turn
        robots.advance(0.5)


@pytest.mark.parametrize(("forward", "turn"), [(0.3, 0.0), (0.2, 0.5), (0.0, -0.8), (-0.2, 0.1)])
def test_drives_as_native_physics(forward: float, turn: float) -> None:
    """But for the moment in which its wheels get going; the drift of unequal wheels comes from rolling."""
    bullet, native = BulletTurtlebots(OPEN), Turtlebots(OPEN)
    for robots in (bullet, native):
        drive(robots, 5.0, forward, turn)
    assert bullet.pose() == approx(native.pose(), abs=0.02)
    ours, theirs = bullet.views[0].body, native.views[0].body
    assert (ours.speed, ours.yaw_rate) == approx((theirs.speed, theirs.yaw_rate), abs=2e-3)


def test_wheels_stop_when_the_command_is_too_old() -> None:
    robots = BulletTurtlebots(OPEN, airframe=EVEN)
    robots.commands[:] = 0.3, 0.0
    robots.advance(1.0)
    assert robots.pose()[0] == approx(0.18, abs=0.01)
    place = robots.pose()[0]
    robots.commands[:] = math.nan
    robots.advance(1.0)
    assert robots.pose()[0] == approx(place, abs=1e-4)
    assert robots.views[0].time_us == 2_000_000


def test_wall_stops_it_and_a_slant_lets_it_slide() -> None:
    robots = BulletTurtlebots(WALL, airframe=EVEN)
    drive(robots, 4.0, 0.3, 0.0)
    assert robots.fleet["body"]["collided"][0] == 1
    assert robots.pose()[0] == approx(0.9 - 0.178, abs=0.003)
    drive(robots, 1.0, -0.3, 0.0)
    assert robots.fleet["body"]["collided"][0] == 0 and robots.pose()[0] < 0.55
    robots.reset(0, (0.5, 0.0, math.radians(60.0)))
    drive(robots, 4.0, 0.3, 0.0)
    assert robots.fleet["body"]["collided"][0] == 1
    assert robots.pose()[1] > 0.5


def test_lidar_reads_what_native_physics_reads() -> None:
    noisy = AIRFRAME.changed(range_noise=0.01)
    bullet, native = BulletTurtlebots("maze", airframe=noisy), Turtlebots("maze", airframe=noisy)
    for robots in (bullet, native):
        robots.reset(0, None, 7)
        robots.look()
    assert bullet.scan == approx(native.scan, abs=1e-4)


def test_snapshot_and_pickle_go_on_bit_for_bit() -> None:
    robots = BulletTurtlebots("maze", 2, AIRFRAME.changed(range_noise=0.01))
    drive(robots, 1.0, 0.2, 0.3)
    robots.commands[:] = math.nan
    kept, copy = robots.snapshot(1), pickle.loads(pickle.dumps(robots))
    ends = []
    for each in (robots, copy):
        each.advance(0.6)
        ends.append((each.fleet[1].tobytes(), each.scan[1].tobytes()))
    robots.restore(kept, 1)
    copy.restore(kept, 0)
    for index, each in ((1, robots), (0, copy)):
        each.advance(0.6)
        ends.append((each.fleet[index].tobytes(), each.scan[index].tobytes()))
    assert len(set(ends)) == 1


@pytest.mark.parametrize("name", ["maze", "round"])
def test_what_it_ran_into_is_forgotten(name: str) -> None:
    """By restoring and by a reset: all goes on bit for bit as with a robot that has never touched anything."""
    robots, dice, collided = BulletTurtlebots(name), np.random.default_rng(5), 0

    def go(some: BulletTurtlebots) -> bytes:
        for turn in (-0.7, 0.2, 0.9):
            some.commands[0] = (0.3, turn)
            some.advance(0.6)
        return some.fleet.tobytes() + some.scan.tobytes()

    for k in range(25):
        for _ in range(6):
            robots.commands[0] = (dice.choice([0.3, 0.3, -0.3]), dice.choice([-1.0, -0.3, 0.0, 0.3, 1.0]))
            robots.advance(0.1 * int(dice.integers(1, 12)))
            collided += int(robots.fleet["body"]["collided"][0])
        snapshot, pose, end = robots.snapshot(), robots.pose(), go(robots)
        for again in (robots, BulletTurtlebots(name)):
            again.restore(snapshot)
            assert go(again) == end, k
        ends = []
        for again in (robots, BulletTurtlebots(name)):
            again.reset(0, pose, seed=3)
            ends.append(go(again))
        assert ends[0] == ends[1], k
        robots.restore(snapshot)
    assert collided > 5


def test_snapshots_of_others_are_refused() -> None:
    robots = BulletTurtlebots(OPEN)
    record, scan = Turtlebots(OPEN).snapshot()
    with pytest.raises(ValueError, match="snapshot"):
        robots.restore((record, scan))
    before = robots.pose()
    with pytest.raises(ValueError, match="snapshot"):
        robots.restore((record, scan, b"none"))
    assert robots.pose() == before


def test_properties_are_of_one_robot() -> None:
    robots = BulletTurtlebots(OPEN, 2)
    robots.set_property(1, "wheel_radius_left", 0.037)
    drive(robots, 2.0, 0.3, 0.0)
    assert robots.pose(1)[3] < 2.0 * robots.pose(0)[3] < 0.0


@pytest.mark.parametrize("name", ["GazeboCircuit2TurtlebotLIDAR-v0", "GazeboMazeTurtlebotLIDAR-v0"])
def test_environment(name: str) -> None:
    """Its contract, the paper's first observation, and an episode that a wall ends."""
    env = gym.make(name, physics="pybullet")
    check_env(env.unwrapped, skip_render_check=True)
    first, _ = env.reset(seed=1)
    assert first.tolist() == gym.make(name).reset(seed=1)[0].tolist()
    for _ in range(60):
        _, reward, terminated, _, _ = env.step(0)
        if terminated:
            break
    assert terminated and reward < 0.0
    env.close()


def test_physics_that_knows_no_turtlebot() -> None:
    with pytest.raises(EnvOptionError, match="'jsbsim' cannot move a Turtlebot"):
        Turtlebot("circuit2", physics="jsbsim")
