# SPDX-License-Identifier: BSD-3-Clause
"""The autopilot shows how tasks are done, by actions that can be done again."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest

from sitl.agents.errors import AgentError
from sitl.agents.experts import AUTOPILOTS
from sitl.envs.actions import VELOCITY, Continuous, Discrete, Normalised


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
        assert all(np.array_equal(one, other) for one, (other, _) in zip(seen[1:], again, strict=True))
        assert rewards == [reward for _, reward in again]
    env.close()


@pytest.mark.parametrize(
    ("name", "options", "needed"),
    [
        ("GazeboCircuit2TurtlebotLIDAR-v0", {}, "no vehicle with an autopilot"),
        ("sitl/CopterWaypoint-v0", {"setpoint": "attitude"}, "'attitude' set-points; it shows velocities"),
        ("sitl/Navigate-v0", {"robot": "erle_copter", "world": "office_erlecopter"}, "task Task of .* has no places"),
    ],
)
@pytest.mark.parametrize("expert", AUTOPILOTS)
def test_what_an_expert_cannot_show_is_refused(name, options, needed, expert):
    env = gym.make(name, **options)
    with pytest.raises(AgentError, match=needed):
        AUTOPILOTS[expert](env)
    env.close()


def test_the_nearest_action_is_found():
    table = Discrete(VELOCITY, {"stay": (0, 0, 0, 0), "ahead": (1, 0, 0, 0), "left": (0, 1, 0, 0.5)})
    rows = (0.9, 0.2, 0, 0), (0.1, 0.3, 0, 0.4), (0.2, 0.1, 3, 0)
    assert [table.nearest(np.array(row)) for row in rows] == [1, 2, 0]
    box = Continuous(VELOCITY, [-2.0, -4.0], [2.0, 0.0], [0, 3])
    assert box.nearest(np.array([1.0, 9.0, 9.0, -5.0])).tolist() == [1.0, -4.0]
    assert Normalised(box).nearest(np.array([1.0, 9.0, 9.0, -2.5])).tolist() == [0.5, -0.25]
