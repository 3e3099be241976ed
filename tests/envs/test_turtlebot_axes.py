# SPDX-License-Identifier: BSD-3-Clause
"""A Turtlebot as an environment's robot: its physics engines, and its record in the axes of environments."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

from sitl.envs.actions import DRIVE
from sitl.envs.options import EnvOptionError
from sitl.envs.robots.turtlebot import Turtlebot, _fleet
from sitl.turtlebots.native import Turtlebots


def test_physics_are_native_unless_bullet_is_asked_for() -> None:
    assert _fleet("native") is Turtlebots and type(Turtlebot().robots) is Turtlebots


def test_bullet_moves_it_where_that_is_asked_for() -> None:
    pytest.importorskip("pybullet")
    from sitl.turtlebots.bullet import BulletTurtlebots

    assert _fleet("pybullet") is BulletTurtlebots


@pytest.mark.parametrize("physics", ["jsbsim", "Native", "", "bullet"])
def test_other_engines_cannot_move_it(physics: str) -> None:
    with pytest.raises(
        EnvOptionError, match=f"physics '{physics}' cannot move a Turtlebot; 'native' and 'pybullet' can"
    ):
        Turtlebot(physics=physics)


def test_its_record_is_north_east_down_and_its_pose_is_x_to_the_north_y_to_the_west() -> None:
    """Headings are clockwise from north, yaws counter-clockwise."""
    robot: Any = Turtlebot(count=2)
    robot.reset(0, (0.0, 0.0, 0.0, 0.0), 0)
    robot.reset(1, (1.0, 2.0, 0.0, 0.5), 0)
    assert robot.pose[1].tolist() == pytest.approx([1.0, 2.0, 0.0, 0.5])
    body = robot.robots.fleet["body"]
    assert (body["north"][1], body["east"][1], body["heading"][1]) == pytest.approx((1.0, -2.0, -0.5))
    body["north"][1], body["east"][1], body["down"][1], body["heading"][1] = 3.0, 4.0, -0.25, 0.75
    body["speed"][1], body["yaw_rate"][1] = 0.2, 0.125
    expected = [3.0, -4.0, 0.25, -0.75, 0.2, 0.0, 0.0, -0.125, 0.0, 0.0, 0.0, 0.0]
    assert np.concatenate((robot.pose[1], robot.velocity[1])).tolist() == expected[:8]
    assert robot.state[1].tolist() == robot.true_state()[1].tolist() == robot.judged_state()[1].tolist() == expected
    robot.robots.fleet["time_us"][1] = 1_250_000
    assert robot.time.tolist() == [0.0, 1.25]


def test_it_turns_left_by_a_positive_rate_and_only_the_robots_that_are_meant_move() -> None:
    robot: Any = Turtlebot("open", count=2)
    for index in range(2):
        robot.reset(index, (0.0, 0.0, 0.0, 0.0), 0)
    robot.apply(DRIVE, np.array([(0.2, 0.3), (0.2, 0.3)]))
    robot.advance(0.6, np.array([False, True]))
    assert robot.pose[0].tolist() == [0.0, 0.0, 0.0, 0.0] and robot.time.tolist() == pytest.approx([0.0, 0.6])
    x, y, _, yaw = robot.pose[1]
    assert 0.0 < x < 0.12 and 0.0 < y < x and 0.0 < yaw < 0.18
    robot.advance(0.6)
    assert robot.time.tolist() == pytest.approx([0.6, 1.2]) and robot.pose[0].tolist() == pytest.approx(
        [x, y, 0.0, yaw]
    )
    robot.advance(0.6)
    assert robot.time.tolist() == pytest.approx([1.2, 1.8])


def test_a_look_takes_no_time() -> None:
    robot: Any = Turtlebot(count=2)
    for index in range(2):
        robot.reset(index, (0.0, 0.0, 0.0, 0.0), 0)
    robot.scan[:] = -1.0
    robot.look(np.array([False, True]))
    assert (robot.scan[0] == -1.0).all() and (robot.scan[1] > 0.0).all() and robot.time.tolist() == [0.0, 0.0]
    robot.look()
    assert (robot.scan[0] > 0.0).all() and robot.time.tolist() == [0.0, 0.0]


@pytest.mark.parametrize("form", ["discrete", "continuous", "agile"])
def test_its_actions_are_those_of_the_paper(form: str) -> None:
    action: Any = Turtlebot().action(form, DRIVE)
    if form == "discrete":
        assert action.names == ("forward", "left", "right")
    else:
        assert (action.space.low.tolist(), action.space.high.tolist()) == (
            pytest.approx([0.0, -0.3]), pytest.approx([0.3, 0.3])
        )  # fmt: skip


def test_its_camera_is_where_its_lidar_is() -> None:
    robot = Turtlebot()
    ahead, height = (float(robot.airframe.value(name)) for name in ("lidar_ahead", "lidar_height"))
    assert robot.camera_mount == (ahead, 0.0, height, 0.0) and height > 0.0


def test_what_is_no_snapshot_is_refused() -> None:
    with pytest.raises(EnvOptionError, match=re.escape("snapshot cannot be restored")):
        Turtlebot().restore(0, "nothing")
