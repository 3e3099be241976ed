# SPDX-License-Identifier: BSD-3-Clause
"""The Turtlebot: drift, time-out, limits, walls, noise, repeats, compiled against plain Python."""

from __future__ import annotations

import math
import os
import pickle
import subprocess
import sys

import numpy as np
import pytest
from pytest import approx

from sitl.core.records import first_difference
from sitl.physics.native.turtlebot.state import Body, Command
from sitl.physics.native.turtlebot.state import Turtlebot as TurtlebotRecord
from sitl.physics.native.turtlebot.step import WheelSpeeds, commanded, move, wheel_speeds
from sitl.turtlebots.native import Turtlebot, Turtlebots
from sitl.vehicles import AirframeError
from sitl.vehicles.turtlebot import AIRFRAME, Lidar
from sitl.worlds import Box, Start, World

OPEN = World("open", (), (Start("origin", (0.0, 0.0, 0.0), 0.0),))
WALL = World("wall", (Box((1.0, 0.0, 0.5), (0.2, 4.0, 1.0)),), OPEN.starts)
EVEN = AIRFRAME.changed(wheel_radius_left=0.035)
"""Without the drift."""


def properties(airframe=AIRFRAME):
    fleet = TurtlebotRecord.fleet(1)
    fleet["airframe"] = airframe.record()
    return TurtlebotRecord.of(fleet, 0).airframe


def test_wheels_follow_speed_and_turn():
    assert wheel_speeds(properties(EVEN), 0.3, 0.0) == approx((0.3, 0.3))
    assert wheel_speeds(properties(EVEN), 0.0, 1.0) == approx((-0.115, 0.115))


def test_wheels_are_limited_one_by_one():
    assert wheel_speeds(properties(EVEN), 5.0, 0.0) == approx((0.7, 0.7))
    assert wheel_speeds(properties(EVEN), 0.6, 2.0) == approx((0.37, 0.7))
    assert wheel_speeds(properties(EVEN), -9.0, 0.0) == approx((-0.7, -0.7))


def test_straight_command_drifts_to_the_right():
    robot = Turtlebot(OPEN)
    for _ in range(10):
        robot.command(0.3, 0.0)
        robot.advance(0.5)
    x, y, _, yaw = robot.pose
    assert yaw == approx(-0.3 * (0.0352 / 0.035 - 1.0) / 0.23 * 5.0, rel=1e-6)  # about 0.007 rad/s
    assert 1.49 < x < 1.51
    assert y == approx(0.5 * x * yaw, rel=0.01)


def test_turn_is_counter_clockwise_and_an_exact_arc():
    robot = Turtlebot(OPEN, EVEN)
    robot.command(0.2, 0.5)
    robot.advance(0.6)
    x, y, _, yaw = robot.pose
    assert yaw == approx(0.3)
    assert (x, y) == approx((0.4 * math.sin(0.3), 0.4 * (1.0 - math.cos(0.3))), abs=1e-6)


@pytest.mark.parametrize("heading", [0.0, 1.0, 3.14, -3.14])
def test_wheels_turn_and_move_a_body_by_their_mean_and_difference(heading):
    body, airframe = Body(), TurtlebotRecord().airframe
    body.heading, airframe.wheel_separation = heading, 0.2
    move(body, airframe, WheelSpeeds(0.3, 0.1), np.empty((0, 9)))
    turned = (0.3 - 0.1) / 0.2 * 0.01
    assert math.remainder(body.heading - heading - turned, math.tau) == approx(0.0, abs=1e-12)
    assert math.hypot(body.north, body.east) == approx(0.2 * 0.01)
    course = math.atan2(body.east, body.north)
    assert math.remainder(course - heading - 0.5 * turned, math.tau) == approx(0.0, abs=1e-12) and not body.collided


def test_a_command_holds_until_its_time_out():
    command, airframe = Command(), TurtlebotRecord().airframe
    airframe.wheel_radius = airframe.wheel_radius_left = airframe.wheel_radius_right = 0.04
    airframe.wheel_speed_max, airframe.command_timeout = 1.0, 0.6
    command.forward, command.time_us = 0.3, 1_000_000
    assert commanded(airframe, command, 1_590_000) == approx((0.3, 0.3))
    assert commanded(airframe, command, 1_600_000) == (0.0, 0.0)


def test_wheels_stop_when_the_command_is_too_old():
    robot = Turtlebot(OPEN, EVEN)
    robot.command(0.3, 0.0)
    robot.advance(1.0)
    assert robot.pose[0] == approx(0.18)
    robot.advance(0.5)
    assert robot.pose[0] == approx(0.18)
    assert robot.time == approx(1.5)
    robot.command(0.3, 0.0)
    robot.advance(0.3)
    assert robot.pose[0] == approx(0.27)


def test_wall_stops_it_where_it_touches():
    robot = Turtlebot(WALL, EVEN)
    for _ in range(10):
        robot.command(0.3, 0.0)
        robot.advance(0.6)
    assert robot.collided
    gap = 0.9 - 0.178 - robot.pose[0]
    assert 0.0 <= gap < 0.003  # a tick's way
    robot.command(0.0, 0.5)
    robot.advance(0.6)
    assert not robot.collided
    assert robot.pose[3] == approx(0.3)
    robot.command(-0.3, 0.0)
    robot.advance(0.6)
    assert not robot.collided
    assert robot.pose[0] < 0.7


@pytest.mark.parametrize(("low", "high", "stops"), [(0.0, 0.1, True), (0.55, 1.0, False), (-1.0, 0.01, False)])
def test_what_lies_above_or_below_it_does_not_stop_it(low, high, stops):
    wall = Box((1.0, 0.0, 0.5 * (low + high)), (0.2, 4.0, high - low))
    robot = Turtlebot(World("lintel", (wall,), OPEN.starts), EVEN)
    for _ in range(10):
        robot.command(0.3, 0.0)
        robot.advance(0.6)
    assert robot.collided == stops
    assert (robot.pose[0] > 1.5) != stops


def test_robot_set_into_a_wall_can_leave_it_only():
    robot = Turtlebot(WALL, EVEN)
    robot.reset((0.85, 0.0, 0.0))
    robot.command(0.3, 0.0)
    robot.advance(0.3)
    assert robot.collided and robot.pose[0] == approx(0.85)
    robot.command(-0.3, 0.0)
    robot.advance(0.6)
    assert not robot.collided and robot.pose[0] == approx(0.67)


def test_scan_sees_the_wall_ahead_and_nothing_behind():
    robot = Turtlebot(WALL, lidar=Lidar(5, 5, math.radians(270.0)))
    assert robot.scan[2] == approx(0.9, abs=1e-6)
    assert np.isinf(robot.scan[[0, 4]]).all()
    robot.reset((0.0, 0.0, math.radians(67.5)))
    assert robot.scan[1] == approx(0.9, abs=1e-6)


def test_noise_is_that_of_the_seed():
    noisy = AIRFRAME.changed(range_noise=0.05)
    robots = [Turtlebot("circuit2", noisy) for _ in range(3)]
    for robot, seed in zip(robots, (1, 1, 2)):
        robot.reset(seed=seed)
    a, b, c = (robot.scan for robot in robots)
    assert np.array_equal(a, b) and not np.array_equal(a, c)
    errors = a - Turtlebot("circuit2").scan
    assert 0.01 < errors.std() < 0.12


def test_snapshot_and_pickle_go_on_bit_for_bit():
    robot = Turtlebot("maze", AIRFRAME.changed(range_noise=0.01))
    robot.command(0.2, 0.3)
    robot.advance(0.25)
    kept, copy = robot.snapshot(), pickle.loads(pickle.dumps(robot))
    ends = []
    for each in (robot, copy):
        each.advance(0.6)
        ends.append((each.pose, each.scan.tobytes()))
    robot.restore(kept)
    robot.advance(0.6)
    ends.append((robot.pose, robot.scan.tobytes()))
    assert ends[0] == ends[1] == ends[2]


def test_fleet_is_the_same_as_single_robots():
    fleet = Turtlebots("round", 3)
    singles = [Turtlebot("round") for _ in range(3)]
    for i, robot in enumerate(singles):
        fleet.reset(i, (0.1 * i, 0.0, 0.2 * i))
        robot.reset((0.1 * i, 0.0, 0.2 * i))
    for step in range(20):
        for i, robot in enumerate(singles):
            fleet.commands[i] = 0.05 * i + 0.1, 0.1 * (step % 3 - 1)
            robot.command(*fleet.commands[i])
            robot.advance(0.6)
        fleet.advance(0.6)
        for i, robot in enumerate(singles):
            assert fleet.pose(i) == robot.pose
            assert np.array_equal(fleet.scan[i], robot.scan)


DRIVE = """
import hashlib
from sitl.turtlebots.native import Turtlebot
from sitl.vehicles.turtlebot import AIRFRAME
robot = Turtlebot("round", AIRFRAME.changed(range_noise=0.01))
robot.reset(seed=5)
digest = hashlib.sha256()
for step in range(12):
    robot.command(0.3, 0.4 * (step % 3 - 1))
    robot.advance(0.4)
    digest.update(robot.fleet.fleet.tobytes() + robot.scan.tobytes())
print(digest.hexdigest())
"""


def test_compiled_and_plain_python_give_the_same_bits():
    out = []
    for jit in ("0", "1"):
        env = {**os.environ, "NUMBA_DISABLE_JIT": jit, "PYTHONPATH": os.pathsep.join(sys.path)}
        run = subprocess.run([sys.executable, "-c", DRIVE], env=env, capture_output=True, text=True)
        assert run.returncode == 0, run.stderr
        out.append(run.stdout)
    assert out[0] == out[1]


@pytest.mark.parametrize("seconds", [0.005, 0.123, -0.1, math.nan, math.inf])
def test_time_is_a_whole_number_of_physics_steps(seconds):
    with pytest.raises(ValueError, match=r"physics steps of 0.01 s"):
        Turtlebot(OPEN).advance(seconds)


@pytest.mark.parametrize("pose", [(1.0,), (1.0, 2.0, math.nan), "abc", None.__class__, (1, 2, 3, 4, 5)])
def test_bad_poses_are_refused(pose):
    with pytest.raises(ValueError, match="pose"):
        Turtlebot(OPEN).reset(pose)


def test_bad_properties_lidars_counts_and_commands_are_refused():
    fleet = Turtlebots(OPEN)
    with pytest.raises(AirframeError, match=r"unknown property 'radios'"):
        fleet.set_property(0, "radios", 1.0)
    with pytest.raises(AirframeError, match=r"range_noise = -1.0 is outside 0"):
        fleet.set_property(0, "range_noise", -1.0)
    with pytest.raises(ValueError, match="readings must be"):
        Turtlebots(OPEN, lidar=Lidar(10, 20, 1.0))
    with pytest.raises(ValueError, match="count = 0"):
        Turtlebots(OPEN, 0)
    with pytest.raises(ValueError, match="finite"):
        Turtlebot(OPEN).command(math.nan, 0.0)
    with pytest.raises(ValueError, match="snapshot"):
        fleet.restore((b"", b""))


def test_properties_are_of_one_robot():
    fleet = Turtlebots(OPEN, 2)
    fleet.set_property(1, "wheel_radius_left", 0.036)
    fleet.commands[:] = 0.3, 0.0
    fleet.advance(0.6)
    assert fleet.pose(1)[3] < fleet.pose(0)[3] < 0.0
    assert first_difference(fleet.fleet[0]["airframe"], fleet.fleet[1]["airframe"]).startswith("wheel_radius_left")
