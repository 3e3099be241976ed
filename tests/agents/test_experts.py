# SPDX-License-Identifier: BSD-3-Clause
"""The autopilot shows how tasks are done, by actions that can be done again."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest

from sitl.agents.errors import AgentError
from sitl.agents.experts import AUTOPILOTS
from sitl.agents.grid_a_star import GridAStar
from sitl.agents.pilot import Pilot
from sitl.envs.actions import VELOCITY, Continuous, Discrete, Normalised
from sitl.envs.starts import ReachableCells
from sitl.worlds.contact import distance
from sitl.worlds.shapes import to_ned
from tests.envs.vector_equality import same


def flown(env, expert, seed):
    """Actions, observations and rewards of an episode, and whether it was a success."""
    observation, _ = env.reset(seed=seed)
    expert.begin(seed)
    actions, seen, rewards, info = [], [observation], [], {}
    ended = False
    while not ended:
        actions.append(expert.act(observation))
        observation, reward, terminated, truncated, info = env.step(actions[-1])
        seen.append(observation)
        rewards.append(reward)
        ended = terminated or truncated
    return actions, seen, rewards, info["is_success"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "expert"),
    [
        ("sitl/CopterWaypoint-v0", "guided"),
        ("sitl/CopterWaypoint-v0", "auto"),
        ("sitl/CopterHover-v0", "guided"),
        ("sitl/CopterGates-v0", "auto"),
        ("sitl/RoverWaypoint-v0", "guided"),
        ("sitl/RoverWaypoint-v0", "auto"),
        ("sitl/RoverWaypointDiscrete-v0", "guided"),
        ("sitl/CopterForest-v0", "pilot"),
        ("sitl/CopterFollow-v0", "pilot"),
        ("sitl/CopterLandMoving-v0", "pilot"),
        ("sitl/CopterRoomsDiscrete-v0", "pilot"),
        ("sitl/RoverLabyrinth-v0", "pilot"),
        ("sitl/RoverReachGoal-v0", "pilot"),
        ("sitl/RoverSlalom-v0", "pilot"),
    ],
)
def test_an_expert_does_the_task_and_its_actions_do_it_again(name, expert):
    env = gym.make(name)
    pilot = AUTOPILOTS[expert](env)
    for seed in (0, 1):
        actions, seen, rewards, success = flown(env, pilot, seed)
        assert success
        assert all(env.action_space.contains(action) for action in actions)
        env.reset(seed=seed)
        again = [env.step(action)[:2] for action in actions]
        assert all(same(one, other) for one, (other, _) in zip(seen[1:], again, strict=True))
        assert rewards == [reward for _, reward in again]
    env.close()


@pytest.mark.parametrize(
    ("name", "options", "needed"),
    [
        ("GazeboCircuit2TurtlebotLIDAR-v0", {}, "no vehicle with an autopilot"),
        ("sitl/CopterWaypoint-v0", {"setpoint": "attitude"}, "'attitude' set-points; it shows velocities"),
        ("sitl/Navigate-v0", {"robot": "erle_copter", "world": "office_erlecopter"}, "task Task of .* has no targets"),
    ],
)
@pytest.mark.parametrize("expert", ["guided", "auto"])
def test_what_an_expert_cannot_show_is_refused(name, options, needed, expert):
    env = gym.make(name, **options)
    with pytest.raises(AgentError, match=needed):
        AUTOPILOTS[expert](env)
    env.close()


@pytest.mark.parametrize(
    ("name", "options", "needed"),
    [
        ("sitl/CopterWaypoint-v0", {"setpoint": "attitude"}, "'attitude' set-points; it shows velocities"),
        ("sitl/Navigate-v0", {"action": "continuous"}, '"forward", "left" and "right"'),
    ],
)
def test_what_the_pilot_cannot_show_is_refused(name, options, needed):
    env = gym.make(name, **options)
    with pytest.raises(AgentError, match=needed):
        Pilot(env)
    env.close()


def test_the_pilot_drives_by_lidar_where_there_are_no_places():
    env = gym.make("GazeboCircuit2TurtlebotLIDAR-v0", max_episode_steps=400)
    pilot = Pilot(env)
    observation, _ = env.reset(seed=1)
    pilot.begin(1)
    rewards, ended = [], False
    while not ended:
        observation, reward, terminated, ended, _ = env.step(pilot.act(observation))
        rewards.append(reward)
        assert not terminated
    assert sum(rewards) > 1200, "most of the way straight on"
    env.close()


def test_ways_lead_around_solids_with_room_to_spare():
    env = gym.make("sitl/CopterRooms-v0")
    robot = env.unwrapped.robot
    ways, cells, rng = GridAStar(robot, 10.0, 0.8), ReachableCells(robot, 0.0), np.random.default_rng(1)
    for _ in range(5):
        here, there = np.array(cells.draw(rng)), np.array(cells.draw(rng))
        way = ways.path(here, there)
        assert np.array_equal(way[0], here) and np.array_equal(way[-1], there)
        assert np.hypot(*np.diff(way, axis=0).T).max() < 0.5, "no jumps"
        assert all(_room(robot, *place) > 0.0 for place in way)
    env.close()


def _room(robot, x, y):
    """Distance to the nearest solid of a robot at x, y [m]."""
    north, east, down = to_ned(x, y, robot.world.start(robot.name).position[2])
    volume = robot.volume
    return distance(robot.world.geometry, north, east, down - volume.top, down - volume.bottom, volume.radius)


def test_the_nearest_action_is_found():
    table = Discrete(VELOCITY, {"stay": (0, 0, 0, 0), "ahead": (1, 0, 0, 0), "left": (0, 1, 0, 0.5)})
    rows = (0.9, 0.2, 0, 0), (0.1, 0.3, 0, 0.4), (0.2, 0.1, 3, 0)
    assert [table.nearest(np.array(row)) for row in rows] == [1, 2, 0]
    box = Continuous(VELOCITY, [-2.0, -4.0], [2.0, 0.0], [0, 3])
    assert box.nearest(np.array([1.0, 9.0, 9.0, -5.0])).tolist() == [1.0, -4.0]
    assert Normalised(box).nearest(np.array([1.0, 9.0, 9.0, -2.5])).tolist() == [0.5, -0.25]
