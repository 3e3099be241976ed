# SPDX-License-Identifier: BSD-3-Clause
"""Targets of episodes without a simulation: how far from the start they are drawn, and how fast they move."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sitl.envs.arena import Arena
from sitl.envs.robots.robot import Volume
from sitl.envs.targets.gates import Gate, Gates
from sitl.envs.targets.hold import Hold
from sitl.envs.targets.landing import Land
from sitl.envs.targets.moving import CURVES, Follow, Trajectory
from sitl.envs.targets.parking import Park
from sitl.envs.targets.waypoints import Waypoints
from sitl.worlds import World
from sitl.worlds.shapes import Start

FLOOR = -1.0
HERE = (3.0, -2.0, 4.0, 0.5)
"""Where robots start: x, y, z [m], yaw [rad]."""
WIDE = Arena((-500.0, -500.0, -500.0), (500.0, 500.0, 500.0))
EPISODES = 400


class Toy:
    """Robots that stand at ``HERE`` in an empty world, whose floor is at ``FLOOR``; they fly, or drive."""

    name, count, range_max, crash_range, volume = "toy", 2, 5.0, 0.0, Volume(0.3, 0.0, 0.3)
    world = World("plain", (), (Start("middle", HERE[:3], 0.0),), floor_z=FLOOR)

    def __init__(self, flies: bool = True) -> None:
        self.kind = SimpleNamespace(takes_off=flies)
        self.state = np.zeros((self.count, 12))
        self.state[:, :4] = HERE
        self.pose, self.velocity = self.state[:, :4], self.state[:, 4:8]
        self.scan, self.collided = np.full((self.count, 1), np.inf, np.float32), np.zeros(self.count, np.int64)
        self.time, self.reports = np.zeros(self.count), np.zeros((self.count, 10))

    def true_state(self) -> Any:
        return self.state

    judged_state = true_state

    def true_reports(self) -> Any:
        return np.zeros((self.count, 9))

    def ask_for(self, message: str) -> None:
        pass

    def has_landed(self) -> Any:
        return np.zeros(self.count, bool)

    def let_down(self, height: float) -> bool:
        return False


def prepared(task: Any, flies: bool = True) -> Any:
    task.prepare(Toy(flies))
    return task


def episodes(task: Any, count: int = EPISODES) -> Any:
    """Begins episodes of the second robot, one after another."""
    for seed in range(count):
        task.start(1, task._robot, np.random.default_rng(seed))
        yield task


def spread_over(values: Any, low: float, high: float) -> bool:
    """Whether values are within limits and fill them evenly: mean and standard deviation are those of equally likely
    numbers, to a twelfth of the range: five standard deviations of the mean of so many are less."""
    values, width = np.asarray(values), high - low
    near = abs(values.mean() - 0.5 * (low + high)) < width / 12.0
    wide = abs(values.std() - width / math.sqrt(12.0)) < width / 12.0
    return bool(near and wide and values.min() >= low and values.max() <= high)


# ---------------------------------------------------------------- targets that stay


@pytest.mark.parametrize("flies", [True, False])
def test_a_position_to_hold_is_near_the_start(flies: bool) -> None:
    """Within three metres along each horizontal axis, and one of height, in which robots that drive stay."""
    task = prepared(Hold(offset=(3.0, 1.0), arena=WIDE), flies)
    found = np.array([each.positions[1, 0] - HERE[:3] for each in episodes(task)])
    assert spread_over(found[:, 0], -3.0, 3.0) and spread_over(found[:, 1], -3.0, 3.0)
    assert spread_over(found[:, 2], -1.0, 1.0) if flies else not found[:, 2].any()
    assert abs(np.corrcoef(found[:, 0], found[:, 1])[0, 1]) < 0.2, "axes are independent"


def test_a_position_to_hold_is_in_the_arena() -> None:
    box = Arena((2.5, -2.5, 3.75), (3.5, -1.5, 4.25))
    found = np.array([each.positions[1, 0].copy() for each in episodes(prepared(Hold(offset=(3.0, 1.0), arena=box)))])
    assert (found >= box.low).all() and (found <= box.high).all()
    for axis in range(3):
        assert {box.low[axis], box.high[axis]} <= set(found[:, axis].tolist()), "what is outside goes to the edge"


@pytest.mark.parametrize("apart", [0.0, 6.0])
def test_waypoints_fill_the_arena_and_keep_apart(apart: float) -> None:
    box = Arena((-5.0, -6.0, 1.0), (15.0, 10.0, 8.0))
    task = prepared(Waypoints(3, apart=apart, arena=box))
    assert task.positions.shape == (2, 3, 3)
    found = np.array([each.positions[1].copy() for each in episodes(task)])
    steps = np.diff(np.concatenate((np.tile(HERE[:3], (EPISODES, 1, 1)), found), axis=1), axis=1)
    apart_by = np.sqrt((steps * steps).sum(axis=2))
    assert (apart_by >= apart).all() and (apart_by.min(axis=0) < apart + 2.0).all()
    assert (found >= box.low).all() and (found <= box.high).all()
    for axis in range(3) if apart == 0.0 else ():
        assert spread_over(found[:, :, axis], box.low[axis], box.high[axis])
    assert task._distance[1] == pytest.approx(apart_by[-1, 0]) and task.at[1] == 0


def test_where_nothing_is_far_enough_some_waypoint_is_taken() -> None:
    box = Arena((2.0, -3.0, 3.5), (4.0, -1.0, 4.5))
    found = next(episodes(prepared(Waypoints(2, apart=50.0, arena=box)))).positions[1]
    assert (found >= box.low).all() and (found <= box.high).all()


@pytest.mark.parametrize(("flies", "away"), [(True, 13.0), (False, 5.0)])
def test_waypoints_that_were_given_come_in_their_order(flies: bool, away: float) -> None:
    """The first is 3 m, 4 m and 12 m from the start; heights do not count for robots that drive."""
    given = [(6.0, 2.0, 16.0), (1.0, 1.0, 2.0)]
    task = next(episodes(prepared(Waypoints(places=given), flies)))
    assert task.positions[1].tolist() == [list(each) for each in given]
    assert task._distance[1] == pytest.approx(away) and task.targets[1].tolist() == list(given[0])
    task.at[1] = 1
    assert task.targets[1].tolist() == list(given[1])
    task.at[1] = 2
    assert task.targets[1].tolist() == list(given[1]), "the last one stays"


@pytest.mark.parametrize("laps", [1, 3])
def test_gates_come_again_in_each_lap(laps: int) -> None:
    gates = [Gate(5.0, 1.0, 2.0, 0.1), Gate(8.0, 4.0, 3.0, 0.2)]
    task = next(episodes(prepared(Gates(gates, laps=laps))))
    assert task.positions[1].tolist() == [[5.0, 1.0, 2.0], [8.0, 4.0, 3.0]] * laps
    assert task.gates_at(1) == gates and task.per_robot == 2 * laps


def test_bays_are_equally_likely_at_the_height_of_the_car() -> None:
    bays = [(5.0, 6.0, 0.1), (7.0, 8.0, -0.2), (9.0, 1.0, 3.0)]
    task = prepared(Park(bays), flies=False)
    found = [(*each.positions[1, 0].tolist(), float(each.headings[1])) for each in episodes(task)]
    for x, y, yaw in bays:
        assert found.count((x, y, HERE[2], yaw)) == pytest.approx(EPISODES / 3, rel=0.25)


# ---------------------------------------------------------------- targets that move


def ways(task: Any, seconds: float, apart: float = 0.01) -> tuple[Any, Any]:
    """Positions of the second robot's target from the beginning on, and its speeds along x, y, z."""
    times = np.arange(0.0, seconds, apart)
    at = task.along(np.tile(times, (2, 1)))[1]
    return at, np.diff(at, axis=0) / apart


@pytest.mark.parametrize("size", [2.0, 5.0])
@pytest.mark.parametrize("curve", CURVES)
def test_a_curve_is_followed_at_its_speed(curve: str, size: float) -> None:
    """Horizontally, over whole rounds: the circle is 2 pi sizes long, the figure of eight somewhat less."""
    speed = 2.0
    task = next(episodes(prepared(Trajectory(curve, size, speed))))
    at, velocity = ways(task, 60.0, 0.005)
    behind = np.hypot(*(at[:, :2] - HERE[:2]).T)
    away = np.flatnonzero(behind > 0.9 * size)[0]
    back = away + np.argmin(behind[away : away + round(7.0 * size / speed / 0.005)])
    if curve == "eight":  # it crosses its beginning in the middle of a round
        back *= 2
    assert behind[back] < 0.02
    assert np.hypot(*velocity[:back, :2].T).mean() == pytest.approx(speed, rel=2e-3)


@pytest.mark.parametrize("curve", CURVES)
def test_a_curve_begins_at_the_start_in_the_robots_heading(curve: str) -> None:
    """The figure of eight crosses its middle at 45 degrees to the left."""
    task = next(episodes(prepared(Trajectory(curve, 4.0, 1.0))))
    assert task.positions[1, 0].tolist() == pytest.approx(HERE[:3])
    at, velocity = ways(task, 0.1)
    heading = HERE[3] + (math.pi / 4 if curve == "eight" else 0.0)
    assert at[0] == pytest.approx(HERE[:3])
    assert math.atan2(velocity[0, 1], velocity[0, 0]) == pytest.approx(heading, abs=0.01)


def test_speeds_of_curves_are_drawn_evenly_from_their_range() -> None:
    task = prepared(Trajectory("circle", 3.0, (1.0, 4.0)))
    speeds = [float(np.hypot(*ways(each, 0.03)[1][0, :2])) for each in episodes(task)]
    assert spread_over(np.array(speeds) / (1.0 - 1e-4), 1.0 - 1e-3, 4.0 + 1e-3)


@pytest.mark.parametrize(("flies", "height"), [(True, 1.0), (True, 0.0), (False, 1.0)])
def test_what_is_followed_stays_near_and_is_no_faster_than_it_may_be(flies: bool, height: float) -> None:
    size, speed = 6.0, 2.0
    task = prepared(Follow(size, speed, height), flies)
    reached, fastest = np.zeros(3), 0.0
    for each in episodes(task, 20):
        assert each.positions[1, 0].tolist() == pytest.approx(HERE[:3])
        at, velocity = ways(each, 60.0, 0.05)
        reached = np.maximum(reached, np.abs(at - HERE[:3]).max(axis=0))
        fastest = max(fastest, float(np.hypot(*velocity[:, :2].T).max()))
    assert (reached <= (size, size, height if flies else 0.0)).all() and fastest <= speed
    assert (reached[:2] > 0.7 * size).all() and fastest > 0.7 * speed
    assert reached[2] > 0.7 * height if flies and height else reached[2] == 0.0


@pytest.mark.parametrize("speed", [0.0, 0.8])
def test_a_pad_lies_on_the_floor_and_goes_anywhere(speed: float) -> None:
    task = prepared(Land(offset=5.0, speed=speed))
    places, moves = [], []
    for each in episodes(task):
        at, velocity = ways(each, 0.03)
        places.append(at[0])
        moves.append(velocity[0])
        assert each.positions[1, 0] == pytest.approx(at[0]) and each._sinking[1] == 0.0
        assert each._distance[1] == pytest.approx(math.dist(at[0], HERE[:3]))
        assert each._touched[1] == pytest.approx(at[0] - HERE[:3])
    found, gone = np.array(places), np.array(moves)
    for axis in range(2):
        assert spread_over(found[:, axis], HERE[axis] - 5.0, HERE[axis] + 5.0)
    assert (found[:, 2] == FLOOR).all() and not gone[:, 2].any()
    assert np.hypot(*gone[:, :2].T) == pytest.approx(np.full(EPISODES, speed), abs=1e-9)
    if speed:
        assert spread_over(np.arctan2(gone[:, 1], gone[:, 0]), -math.pi, math.pi)
