# SPDX-License-Identifier: BSD-3-Clause
"""Commands that arrive late: when exactly, drawn for each episode, through vectors, snapshots and pickles."""

from __future__ import annotations

import pickle

import gymnasium as gym
import numpy as np
import pytest

import sitl.envs  # noqa: F401 (registers the environments)
from sitl.agents.tabular.compiled_loop import CompiledLoop
from sitl.envs import EnvOptionError
from sitl.envs.latency import Latency
from sitl.envs.robots import in_process
from sitl.envs.robots.starts import Starts
from sitl.envs.robots.turtlebot import Turtlebot
from tests.envs.lockstep_vehicle import vehicle

CIRCUIT2 = "GazeboCircuit2TurtlebotLIDAR-v0"
ROVER = "GazeboMazeErleRoverLIDAR-v0"
COPTER = "GazeboOfficeErleCopterLIDAR-v0"
REST = (0.0, 0.0)
DRIVES = [(0.3, 0.0), (0.1, 0.3), (0.2, -0.2), (0.3, 0.1)]
PULSES = {
    "rest": (1500, 0, 1500, 0, 0, 0, 0, 0), "forward": (1500, 0, 1900, 0, 0, 0, 0, 0),
    "left": (1100, 0, 1900, 0, 0, 0, 0, 0), "right": (1900, 0, 1800, 0, 0, 0, 0, 0),
}  # fmt: skip


def turtlebot(**options):
    return gym.make("sitl/Navigate-v1", action="continuous", observation="scan", **options).unwrapped


def poses(env, actions):
    """After each step."""
    env.reset(seed=1)
    out = []
    for action in actions:
        env.step(action)
        out.append(env.robot.pose[0].tolist())
    return out


def rover(**options):
    return gym.make(ROVER, action=PULSES, task="wander", **options).unwrapped


def places(env, actions):
    """True ones of a vehicle in process, after each step."""
    env.reset(seed=1)
    out = []
    for action in actions:
        env.step(action)
        out.append(tuple(env.robot.view(0).physics.body.pos))
    return out


def test_a_latency_of_whole_steps_is_a_queue():
    late = poses(turtlebot(latency=1.2), [*DRIVES, REST, REST])
    assert late == poses(turtlebot(), [REST, REST, *DRIVES])


def test_within_a_step_the_command_before_goes_on():
    late = poses(turtlebot(latency=0.2), DRIVES)
    fine = poses(turtlebot(step_time=0.2), [REST, *(d for drive in DRIVES for d in 3 * [drive])])
    assert late == fine[2::3][: len(DRIVES)]
    later = poses(turtlebot(latency=0.8), DRIVES)
    assert later == poses(turtlebot(latency=0.2), [REST, *DRIVES])[: len(DRIVES)]


def test_latency_0_is_none():
    env = turtlebot(latency=0)
    assert env.session.latency is None and poses(env, DRIVES) == poses(turtlebot(), DRIVES)


def test_a_touch_before_the_command_arrives_counts():
    robot = Turtlebot()
    robot.apply(robot.setpoints[0], np.array([[0.3, 0.0]]))
    for _ in range(1000):
        robot.advance(0.3)
        if robot.collided[0]:
            break
    robot.apply(robot.setpoints[0], np.array([[-0.3, 0.0]]))
    robot.advance_late(0.6, np.array([20]))
    assert robot.collided[0] == 1 and robot.velocity[0, 0] < 0.0
    robot.advance_late(0.6, np.array([20]))
    assert robot.collided[0] == 0


@pytest.mark.parametrize("latency, quiet", [(0.1, 5), (0.24, 12)])
def test_a_rovers_message_is_what_is_late(latency, quiet):
    actions = [1, 2, 1, 3, 1, 1]
    late = places(rover(latency=latency), actions)
    ticks = [0] * quiet + [a for action in actions for a in 5 * [action]]
    assert late == places(rover(step_time=0.02), ticks)[4::5][: len(actions)]
    assert late[-1] != places(rover(), actions)[-1]


@pytest.mark.parametrize("name, steps", [(CIRCUIT2, 60), (ROVER, 12)])
def test_vector_equals_singles_each_with_its_own(name, steps):
    options = {"randomise": {"latency": (0.0, 1.0)}, "max_episode_steps": 9}
    vector = gym.make_vec(name, num_envs=3, **options)
    singles = gym.make_vec(name, num_envs=3, vectorization_mode="sync", **options)
    assert np.array_equal(vector.reset(seed=8)[0], singles.reset(seed=8)[0])
    assert len(set(vector.unwrapped._session.latency.ticks.tolist())) > 1
    vector.action_space.seed(2)
    for _ in range(steps):
        actions = vector.action_space.sample()
        got, expected = vector.step(actions), singles.step(actions)
        for a, b in zip(got[:4], expected[:4]):
            assert np.array_equal(a, b)


@pytest.mark.parametrize("name", [CIRCUIT2, ROVER])
def test_snapshots_and_pickles_keep_what_is_under_way(name):
    env = gym.make(name, observation="scan", randomise={"latency": (1.5, 2.0)}, disable_env_checker=True).unwrapped
    env.reset(seed=3)
    for action in (0, 1, 2, 0, 1):
        env.step(action)
    kept, copy = env.snapshot(), pickle.loads(pickle.dumps(env))

    def go_on(one):
        return [one.step(action)[0] for action in (2, 2, 0, 0, 0)]

    first = go_on(env)
    assert np.array_equal(go_on(copy), first)
    env.restore(pickle.loads(pickle.dumps(kept)))
    assert np.array_equal(go_on(env), first)
    fresh = gym.make(name, observation="scan", randomise={"latency": (0.0, 0.0)}, disable_env_checker=True).unwrapped
    fresh.reset(seed=9)
    fresh.restore(kept)
    assert np.array_equal(go_on(fresh), first)
    with pytest.raises(EnvOptionError, match="one has a latency"):
        gym.make(name, observation="scan").unwrapped.restore(kept)


def test_a_longer_latency_makes_room_and_keeps_what_others_have_under_way():
    late = Latency(Turtlebot(count=2), 0.6, 0.6, 1)
    rows = None
    for k in range(3):
        late.post(np.full((2, 1), float(k)), rows)
    late.begin(1)
    late.set(1, 2.4)
    due = []
    for k in range(3, 9):
        late.post(np.full((2, 1), float(k)), rows)
        due.append((*late.due[:, 0].tolist(), int(late.waits[1])))
    assert [d[0] for d in due] == [2.0, 3.0, 4.0, 5.0, 6.0, 7.0]
    assert [d[2] for d in due] == [60, 60, 60, 60, 0, 0] and [d[1] for d in due[4:]] == [3.0, 4.0]


def test_the_compiled_loop_stays_away():
    assert not CompiledLoop.suits(gym.make(CIRCUIT2, latency=0.1))
    assert not CompiledLoop.suits(gym.make(CIRCUIT2, randomise={"latency": (0.0, 0.1)}))
    assert CompiledLoop.suits(gym.make(CIRCUIT2))


class Prompt:
    """A robot that knows of no latency."""

    def __init__(self, world, count):
        self._robot = Turtlebot(world, count)

    def __getattr__(self, name):
        if name in ("advance_late", "_robot"):
            raise AttributeError(name)
        return getattr(self._robot, name)


@pytest.mark.parametrize(
    "options, text",
    [
        ({"latency": -0.1}, r"latency = -0.1; it must be 0 .. 60 s"),
        ({"latency": 61.0}, r"latency = 61.0; it must be 0 .. 60 s"),
        ({"latency": float("nan")}, r"latency = nan"),
        ({"latency": "0.1"}, r"latency = '0.1'"),
        ({"latency": True}, r"latency = True"),
        ({"latency": 0.105}, r"latency = 0.105; it must be a whole number of 0.01 s"),
        ({"latency": 0.1, "randomise": {"latency": (0, 1)}}, "give one of them"),
        ({"latency": 0.1, "robot": Prompt}, "has no advance_late"),
        ({"randomise": {"latency": (0, 100)}}, r"within 0 .. 60 s"),
        ({"randomise": {"latencie": (0, 1)}}, r"did you mean 'latency'"),
        ({"randomise": {"draws": 4.5}}, r"draws = 4.5; it must be a whole number"),
    ],
)
def test_wrong_options_are_refused(options, text):
    with pytest.raises(EnvOptionError, match=text):
        gym.make("sitl/Navigate-v1", **options)


def test_a_drawn_latency_that_cannot_be_is_refused():
    env = turtlebot(randomise={"latency": lambda rng: -1.0})
    with pytest.raises(EnvOptionError, match=r"latency = -1.0"):
        env.reset(seed=1)


def test_draws_come_from_a_few_sets_whose_vehicles_stay_prepared(monkeypatch):
    monkeypatch.setattr(in_process, "STARTS", Starts())
    env = gym.make(COPTER, randomise={"mass": (1.1, 1.3), "wind_speed": (0.0, 2.0), "draws": 2}, begin="boot").unwrapped
    found = set()
    for seed in range(6):
        env.reset(seed=seed)
        v = env.robot.view(0)
        found.add((float(v.physics.airframe.mass), float(v.physics.wind.speed)))
    assert len(found) == len(in_process.STARTS) == 2
    other = gym.make(
        COPTER, randomise={"mass": (1.1, 1.3), "wind_speed": (0.0, 2.0), "draws": 2}, begin="boot"
    ).unwrapped
    other.reset(seed=11)
    assert float(other.robot.view(0).physics.airframe.mass) in {mass for mass, _ in found}


def test_the_noise_of_a_vehicles_lidar_is_a_property_too():
    scans = {}
    for noise in (0.0, 0.3):
        env = gym.make(ROVER, observation="scan", randomise={"lidar_noise": (noise, noise)}).unwrapped
        env.reset(seed=1)
        scans[noise] = env.step(0)[0]
    near = scans[0.0] < 15.0
    assert 0.2 < np.std((scans[0.3] - scans[0.0])[near]) < 0.4


@pytest.mark.slow
def test_a_vehicle_behind_a_socket_is_as_late(tmp_path):
    options = {"latency": 0.14, "observation": "scan"}
    inside = gym.make(ROVER, **options)
    with vehicle(tmp_path, "rover", "maze_erlerover", "--lockstep") as (port, _):
        outside = gym.make(ROVER, connection=f"tcp:127.0.0.1:{port}", **options)
        assert np.array_equal(inside.reset(seed=1)[0], outside.reset(seed=1)[0])
        for action in (0, 1, 1, 2, 0):
            assert np.array_equal(inside.step(action)[0], outside.step(action)[0])
        outside.close()


def test_a_copter_takes_off_though_its_home_is_not_its_origin():
    env = gym.make(COPTER, randomise={"lidar_noise": (0.2, 0.2)}).unwrapped  # with this noise they are 0.2 m apart
    env.reset(seed=1)
    assert env.robot.view(0).physics.body.pos[2] == pytest.approx(-1.0, abs=0.4)
