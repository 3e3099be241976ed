# SPDX-License-Identifier: BSD-3-Clause
"""Free ways: how far it is to a goal around a world's solids, and the task that is paid by them."""

from __future__ import annotations

import math
from types import SimpleNamespace

import gymnasium as gym
import numpy as np
import pytest

from sitl.core.algebra import ZERO2
from sitl.envs import shortest_paths
from sitl.envs.options import EnvOptionError
from sitl.envs.parts import Route
from sitl.envs.shortest_paths import ShortestPaths
from sitl.envs.targets.among import Among
from sitl.worlds.contact import Volume
from sitl.worlds.making import wall
from sitl.worlds.shapes import Start
from sitl.worlds.world import World

RADIUS = 0.3
TEE = [wall((0.0, -10.0), (0.0, 4.0), "wall"), *(
    wall(a, b, f"outer {k}")
    for k, (a, b) in enumerate([
        ((-10.0, -10.0), (10.0, -10.0)), ((10.0, -10.0), (10.0, 10.0)),
        ((10.0, 10.0), (-10.0, 10.0)), ((-10.0, 10.0), (-10.0, -10.0)),
    ])
)]  # fmt: skip
"""A square with a wall from below that leaves a passage above y = 4 m."""


def robot_in(solids, count=2, start=(-5.0, -5.0, 0.0)):
    """What free ways look at of a robot."""
    world = World("tee", tuple(solids), (Start("here", start, 0.0),), "", plan_height=1.0)
    return SimpleNamespace(
        world=world, name="disc", count=count, crash_range=0.0, volume=Volume(ZERO2, 0.5, 0.0, RADIUS),
        pose=np.zeros((count, 4)),
    )  # fmt: skip


def test_the_way_leads_round_the_end_of_a_wall():
    ways = ShortestPaths(robot_in(TEE))
    ways.aim(0, 5.0, -5.0)
    ways.aim(1, -5.0, 5.0)
    around, straight = ways.lengths(np.array([[-5.0, -5.0], [-5.0, -5.0]])).tolist()
    corner = 4.05 + RADIUS + 0.1  # of the wall's end, with the room that the robot keeps
    expected = 2.0 * math.hypot(5.0 - 0.45, 5.0 + corner) + 2.0 * 0.45
    assert around == pytest.approx(expected, rel=0.03)
    assert straight == pytest.approx(10.0, rel=0.01)


def test_without_solids_between_it_is_the_straight_distance():
    ways = ShortestPaths(robot_in(TEE[1:], count=1))
    ways.aim(0, 3.0, 4.0)
    rng = np.random.default_rng(0)
    for x, y in rng.uniform(-9.0, 9.0, (50, 2)):
        assert ways.lengths(np.array([[x, y]]))[0] == pytest.approx(math.hypot(x - 3.0, y - 4.0), rel=0.03, abs=0.15)


def test_it_falls_towards_the_goal_from_everywhere():
    ways = ShortestPaths(robot_in(TEE, count=1))
    ways.aim(0, 5.0, -5.0)
    place, step = np.array([-5.0, -5.0]), 0.1
    for _ in range(400):
        tries = [place + step * np.array([math.cos(a), math.sin(a)]) for a in np.linspace(0.0, math.tau, 16)]
        lengths = [float(ways.lengths(p[None])[0]) for p in tries]
        place = tries[int(np.argmin(lengths))]
        if math.hypot(place[0] - 5.0, place[1] + 5.0) < 0.3:
            return
    pytest.fail(f"the steepest way ends at {place}")


def test_places_without_room_are_as_far_as_the_nearest_with_room():
    ways = ShortestPaths(robot_in(TEE, count=1))
    ways.aim(0, -5.0, -5.0)
    beside, inside = (float(ways.lengths(np.array([[x, -5.0]]))[0]) for x in (-1.0, -0.3))
    assert inside == pytest.approx(beside + 0.7, abs=0.15)
    ways.aim(0, -0.3, -5.0)
    assert float(ways.lengths(np.array([[-5.0, -5.0]]))[0]) == pytest.approx(4.7, abs=0.2)


def planned(solids, *goal):
    ways = ShortestPaths(robot_in(solids))
    ways.plan_routes()
    for index in range(2):
        ways.aim(index, *goal)
    return ways


def ends(pose, out):
    """Where routes lead, in the world."""
    c, s = np.cos(pose[:, 3]), np.sin(pose[:, 3])
    return pose[:, :2] + np.column_stack((out[:, 0] * c - out[:, 1] * s, out[:, 0] * s + out[:, 1] * c))


@pytest.mark.parametrize("size", [(1, 1), (1, 40), (40, 1), (37, 52)])
@pytest.mark.parametrize("share", [0.01, 0.2, 0.95, 1.0])
def test_the_nearest_free_cell_is_found(size: tuple[int, int], share: float) -> None:
    rng = np.random.default_rng(3)
    free = rng.random(size) < share
    free[0, 0] = True
    nearest, distance = shortest_paths._nearest(free)
    places, cells = np.argwhere(free), np.argwhere(np.ones(size, np.bool_))
    squares = ((cells[:, None] - places) ** 2).sum(axis=2)
    i, j = np.divmod(nearest.ravel(), size[1])
    assert free[i, j].all()
    own = (cells[:, 0] - i) ** 2 + (cells[:, 1] - j) ** 2
    assert (distance.ravel() == np.sqrt(own)).all()
    assert (own == squares.min(axis=1)).mean() > 0.99  # spread from cell to cell, it may miss one around a corner


def test_the_route_leads_so_far_along_a_way_that_keeps_clear_of_walls():
    ways, rng, out = planned(TEE, 5.0, -5.0), np.random.default_rng(1), np.zeros((2, 4))
    for _ in range(40):
        pose = np.column_stack(
            (rng.uniform(-8.5, -1.6, 2), rng.uniform(-8.5, 8.5, 2), (0.0, 0.0), rng.uniform(-3.0, 3.0, 2))
        )
        ways.follow(pose, 2.0, out, 1)
        length = ways.lengths(pose).copy()
        assert np.array_equal(out[:, 3], length) and np.all(out[:, 0] == 0.0)
        there = ends(pose, out[:, 1:])
        assert np.all(np.hypot(out[:, 1], out[:, 2]) <= 2.0 + 1e-9)
        assert np.all(ways.lengths(there) < length - 1.3)
        assert np.all(there[:, 0] < -1.0) or np.all(there[there[:, 0] >= -1.0, 1] > 5.0)


def test_a_route_passes_the_end_of_a_wall_in_the_middle_of_the_passage_and_the_shortest_way_close_by():
    ways, out = planned(TEE, 5.0, -5.0), np.zeros((2, 3))
    pose, passed = np.array([[-5.0, -5.0, 0.0, 0.0], [5.0, 5.0, 0.0, 0.0]]), []
    for _ in range(400):
        ways.follow(pose, 0.1, out)
        pose[:, :2] = ends(pose, out)
        if abs(pose[0, 0]) < 0.1:
            passed.append(pose[0, 1])
    assert np.allclose(pose[:, :2], (5.0, -5.0), atol=0.3)
    assert 5.0 < min(passed) < 9.0  # the shortest way: 4.05 m + 0.4 m


def test_the_route_ends_at_the_goal_and_no_way_leads_nowhere():
    ways, out = planned(TEE[1:], 3.0, 4.0), np.zeros((2, 3))
    ways.follow(np.array([[3.0, 3.0, 0.0, 0.0], [3.01, 4.02, 0.0, 0.0]]), 2.0, out)
    assert np.hypot(out[:, 0], out[:, 1] - (1.0, 0.0)) == pytest.approx((0.0, 0.0), abs=0.25)
    ways._fields[:] = ways._routes[:] = np.inf
    ways.follow(np.array([[3.0, 3.0, 0.0, 0.0], [np.nan, 4.02, 0.0, 0.0]]), 2.0, out)
    assert out[0].tolist() == [0.0, 0.0, np.inf] and np.isnan(out[1, :2]).all()


@pytest.mark.parametrize("robots", [1, 3])
def test_the_observation_is_told_from_the_estimate(robots):
    many = gym.make_vec(
        "sitl/RoverLabyrinth-v1", robots, vectorization_mode="vector_entry_point", observation=["goal", "route"]
    )
    seen, _ = many.reset(seed=4)
    task, robot = many.unwrapped.session.task, many.unwrapped.session.robot
    expected = np.zeros((robots, 3))
    for _ in range(3):
        task._paths.follow(robot.state, 2.0, expected)
        assert np.array_equal(seen[:, 3:], expected.astype(np.float32))
        assert not np.allclose(robot.state[:, :2], robot.true_state()[:, :2], atol=0.01)
        seen, *_ = many.step(np.tile(np.array([0.8, 0.3], np.float32), (robots, 1)))
    slow, part = np.zeros((robots, 3), np.float32), Route()
    part.prepare(many.unwrapped.session)
    part.write(slow)
    assert np.array_equal(slow, seen[:, 3:])


def test_a_route_of_another_length():
    envs = [gym.make("sitl/CopterForest-v1", observation=["route", Route(4.0)]).unwrapped for _ in range(2)]
    seen = [env.reset(seed=1)[0] for env in envs]
    assert np.array_equal(*seen)
    near, far = seen[0][:3], seen[0][3:]
    assert near[2] == far[2] > 4.0
    assert np.hypot(*near[:2]) == pytest.approx(2.0, abs=0.1) and np.hypot(*far[:2]) == pytest.approx(4.0, abs=0.3)


@pytest.mark.parametrize("ahead", [0.0, -1.0, math.nan, math.inf])
def test_a_route_of_no_length_is_refused(ahead):
    with pytest.raises(EnvOptionError, match=rf"Route\(ahead={ahead!r}\); it must be above 0"):
        Route(ahead)


def test_a_task_without_obstacles_has_no_route():
    with pytest.raises(EnvOptionError, match=r'observation "route": task .* plans no path.*RoverLabyrinth'):
        gym.make("sitl/CopterHover-v1", observation=["goal", "route"]).reset(seed=0)


def make(**options):
    return gym.make("sitl/RoverLabyrinth-v0", world="labyrinth:seed=1,size=20,scale=2,difficulty=0.2", **options)


def test_a_step_pays_what_the_free_way_is_shorter():
    with make() as env:
        env.reset(seed=3)
        task = env.unwrapped.session.task
        before = float(task._paths.lengths(task._robot.pose)[0])
        assert before >= float(task._distance[0]) - 0.5
        for _ in range(5):
            *_, terminated, _, info = env.step(np.array([0.5, 0.0], np.float32))
            now = float(task._paths.lengths(task._robot.pose)[0])
            assert not terminated and info["reward_progress"] == pytest.approx(before - now, abs=1e-9)
            before = now


def test_places_that_are_passed_give_the_next_ones_way():
    near = [(0.4, 0.0, 0.0), (2.5, 0.0, 0.0)]
    with gym.make(
        "sitl/RoverWaypoint-v0", task=Among(places=near, radius=1.0), world="labyrinth:seed=1,size=60,scale=3"
    ) as env:
        env.reset(seed=0)
        task = env.unwrapped.session.task
        *_, info = env.step(np.array([0.0, 0.0], np.float32))
        assert info["passed"] == 1
        x, y = task._robot.pose[0, :2].tolist()
        assert float(task._left[0]) == pytest.approx(math.hypot(2.5 - x, y), abs=0.2)


def test_a_ceiling_ends_the_episode_of_a_copter():
    with gym.make("sitl/CopterRooms-v0") as env:
        env.reset(seed=0)
        for _ in range(60):
            _, reward, terminated, _, info = env.step(np.array([0.0, 0.0, 1.0, 0.0], np.float32))
            if terminated:
                break
        assert terminated and not info["crashed"] and reward < -9.0
        assert env.unwrapped.session.robot.pose[0, 2] == pytest.approx(3.0, abs=0.2)


def test_mistakes_are_told():
    with pytest.raises(EnvOptionError, match=r"Among\(ceiling=0.0\); it must be above 0 m"):
        Among(ceiling=0.0)
