# SPDX-License-Identifier: BSD-3-Clause
"""Agents of a swarm see the world and each other: depth, colours, lidar."""

from __future__ import annotations

import pickle
from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip("pettingzoo", reason="PettingZoo is not installed")

from pettingzoo.test import parallel_api_test

from sitl import worlds
from sitl.envs.options import EnvOptionError
from sitl.envs.pictures import Camera, Depth
from sitl.envs.swarm.parallel import SwarmEnv
from sitl.envs.swarm.sight import Onlooker
from sitl.envs.swarm.vector import SwarmVectorEnv
from sitl.vehicle.copter import Copter
from sitl.vehicles import load
from tests.envs.vector_equality import same

FACING = [(0.0, 0.0, 0.0, 0.0), (5.0, 0.0, 0.0, 180.0)]
ALL = {"state": "state", "scan": "scan", "depth": Depth(reach=30.0), "camera": Camera()}
"""A pixel of 1.4 deg: the other one, 0.17 m high, is 2 deg."""
RADIUS = 0.32
"""Of an Erle-Copter's outline [m]."""


def flown(steps=6, seed=1, **options):
    """Observations of an episode of two copters that face each other, and where they really are."""
    env = SwarmEnv("formation", 2, starts=FACING, **options)
    seen, places = [env.reset(seed=seed)[0]], []
    for _ in range(steps):
        found, _, _, _, infos = env.step({agent: np.array([0.1, 0.0, 0.0], np.float32) for agent in env.agents})
        seen.append(found)
        places.append([infos[agent]["true_place"] for agent in env.agents])
    assert all(env.observation_space(agent).contains(found[agent]) for agent in env.agents)
    env.close()
    return seen, places


def onlooker(*frames, changed=None, number=0):
    """Of a swarm that the test places; ``changed``: properties of its first airframe."""
    vehicles = []
    for frame in frames:
        airframe = load(frame).changed(**(changed or {})) if frame == frames[0] else load(frame)
        fleet = Copter.fleet(1)
        fleet["physics"]["body"]["q"][:, 0] = 1.0
        vehicles.append(SimpleNamespace(airframe=airframe, fleet=fleet, index=0))
    scenarios = [SimpleNamespace(world=worlds.load("open"))] * len(frames)
    found = Onlooker(SimpleNamespace(vehicles=vehicles, scenarios=scenarios), number)
    return found, [vehicle.fleet[0]["physics"]["body"] for vehicle in vehicles]


def test_cameras_are_at_the_lidar_or_on_top():
    """Forward, left, up [m], level."""
    assert onlooker("erle_copter")[0].camera_mount == (0.15, 0.0, 0.15, 0.0)
    moved = onlooker("erle_copter", changed={"lidar_at": (0.1, 0.02, -0.3)})[0]
    assert moved.camera_mount == (0.1, -0.02, 0.3, 0.0)
    assert onlooker("ardupilot_rover", changed={"lidar_at": (0.1, 0.02, -0.9)})[0].camera_mount == (0.0, 0.0, 0.3, 0.0)


def test_others_are_seen_as_the_discs_of_their_outlines():
    seen, bodies = onlooker("erle_copter", "erle_rover", "erle_copter")
    half = np.sqrt(0.5)
    bodies[1]["pos"], bodies[1]["q"] = (10.0, 20.0, -0.5), (half, 0.0, 0.0, half)  # it looks east
    bodies[2]["pos"] = (1.0, 2.0, -3.0)
    discs = seen.others()[0]
    assert discs[:3] == pytest.approx(
        np.array([(10.0, 20.0 + along, 0.9, -0.5 - 0.85, -0.5) for along in (0.506, 0.111, -0.284)])
    )
    assert discs[3] == pytest.approx((1.0, 2.0, 0.32, -3.17, -3.0)) and len(discs) == 4
    bodies[1]["q"] = (half, 0.0, half, 0.0)  # it looks up
    up = seen.others()[0][:3]
    assert up[:, :2] == pytest.approx(np.array([(10.0, 20.0)] * 3))
    assert up[:, 4] == pytest.approx([-0.5 - along for along in (0.506, 0.111, -0.284)])
    beside_none, _ = onlooker("ardupilot_rover", "erle_copter", changed={"contact_radius": 0.0}, number=1)
    assert beside_none.others().shape == (1, 0, 5), "what touches nothing has no outline"
    nobody, _ = onlooker("erle_copter")
    assert nobody.others().shape == (1, 0, 5)


def test_two_that_face_each_other_see_each_other():
    seen, places = flown(observation=ALL)
    apart = float(np.linalg.norm(places[-1][0] - places[-1][1]))
    for agent, own in seen[-1].items():
        assert own["depth"].min() == pytest.approx(apart - RADIUS, abs=0.25), agent
        red, green, blue = own["camera"].reshape(-1, 3).T.astype(int)
        assert ((red > 1.4 * green) & (green > 2 * blue)).any(), "orange"
    scans = [own["scan"].min() for found in seen for own in found.values()]
    assert min(scans) == pytest.approx(apart - RADIUS, abs=0.5), "lidars are level with the tops: the lower one sees"
    alone = SwarmEnv("formation", 2, observation=ALL, starts=[FACING[0], (0.0, -50.0, 0.0, 0.0)])
    found = alone.reset(seed=1)[0]["copter_0"]
    assert found["scan"].min() == pytest.approx(10.0), "nobody within the lidar's range"
    assert found["depth"].min() > 5.5, "the floor"
    alone.close()


def test_late_pictures_show_where_the_others_were():
    now, _ = flown(10, observation="depth")
    late, _ = flown(10, observation={"depth": Depth(latency=0.4)})
    assert not np.array_equal(now[3]["copter_0"], now[5]["copter_0"])
    for k in range(11):
        assert all(np.array_equal(late[k][agent]["depth"], now[max(k - 2, 0)][agent]) for agent in now[k]), k


def test_pettingzoos_rules_are_kept():
    env = SwarmEnv("crossing", steps=10, observation="state+scan+depth")
    parallel_api_test(env, num_cycles=12)  # PettingZoo's, which asserts
    env.close()


def test_a_vector_gives_what_swarms_give_and_goes_on_from_a_pickle():
    options = {"steps": 6, "observation": {"state": "state", "depth": Depth(16, 12, noise=0.05)}}
    vector = SwarmVectorEnv("crossing", 2, **options)
    swarms = [SwarmEnv("crossing", **options) for _ in range(2)]
    rows = vector.reset(seed=3)[0]
    rng = np.random.default_rng(0)
    seen = [swarm.reset(seed=3 + k)[0] for k, swarm in enumerate(swarms)]
    for step in range(9):
        flat = [found[agent] for found in seen for agent in found]
        assert same(rows, {name: np.stack([row[name] for row in flat]) for name in rows}), step
        actions = rng.uniform(-1, 1, (8, 3)).astype(np.float32)
        if step == 3:
            swarms[0] = pickle.loads(pickle.dumps(swarms[0]))
        rows, _, _, _, infos = vector.step(actions)
        for k, swarm in enumerate(swarms):
            its = dict(zip(swarm.possible_agents, actions[4 * k :]))
            seen[k] = swarm.step(its)[0]
            if not swarm.agents:
                last = [infos["final_obs"][4 * k + j] for j in range(4)]
                assert same(last, list(seen[k].values()))
                seen[k] = swarm.reset()[0]
    vector.close()


@pytest.mark.parametrize(
    ("task", "observation", "says"),
    [
        ("escort", "state+scan", "ardupilot_rover has no lidar"),
        ("formation", "dept", "did you mean 'depth'"),
        ("formation", {}, "no entries"),
        ("formation", {"x": Depth(latency=0.1)}, "is not a whole number of steps"),
    ],
)
def test_what_cannot_be_is_refused(task, observation, says):
    with pytest.raises(EnvOptionError, match=says):
        SwarmEnv(task, observation=observation)
