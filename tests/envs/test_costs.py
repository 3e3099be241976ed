# SPDX-License-Identifier: BSD-3-Clause
"""Costs beside the reward: each counts what it says, by the truth, and nothing changes where nobody asks for them."""

from __future__ import annotations

import math
import pickle

import gymnasium as gym
import numpy as np
import pytest

import sitl.envs  # noqa: F401
from sitl.envs import EnvOptionError
from sitl.envs.arena import Arena
from sitl.envs.costs import COSTS, Costs, Energy, Fence, Proximity, Tilt
from sitl.envs.rewards import Step
from sitl.envs.robots import kind
from sitl.envs.safety import SafetyEnv
from sitl.envs.safety_vector import SafetyVectorEnv
from sitl.vehicles import load
from sitl.worlds import World
from sitl.worlds.shapes import Box, Start
from tests.envs.vector_equality import same

ALL = tuple(COSTS)
AHEAD = np.array([1.0, 0.0, 0.0, 0.0], np.float32)


class Told:
    """Robots that are where the test says, and who believe something else."""

    name, count, knows_truth = "told", 3, True
    collided = np.zeros(3, np.int64)

    def __init__(self, solids=()):
        self.truth, self.state = np.zeros((3, 12)), np.full((3, 12), 1e3)
        self.world = World("test", tuple(solids), (Start("origin", (0.0, 0.0, 0.0), 0.0),))
        self.volume = type("Volume", (), {"radius": 0.5, "bottom": -0.1, "top": 0.3})

    @property
    def pose(self):
        return self.state[:, :4]

    @property
    def velocity(self):
        return self.state[:, 4:8]

    def true_state(self):
        return self.truth.copy()

    judged_state = true_state


def costs_of(robot, *given, task=None):
    costs = Costs(given)
    costs.prepare(robot, task)
    step = Step(robot, 0.1)
    return costs.of(step)


def test_a_fence_is_a_box_and_what_does_not_fly_is_judged_in_x_and_y():
    robot = Told()
    robot.truth[:, :3] = (4.9, 0.0, 99.0), (5.1, 0.0, 1.0), (0.0, -5.1, 1.0)
    box = Arena((-5.0, -5.0, 0.0), (5.0, 5.0, 2.0))
    assert costs_of(robot, Fence(box))["cost_fence"].tolist() == [0.0, 1.0, 1.0]
    robot.kind = type("Kind", (), {"takes_off": True})
    assert costs_of(robot, Fence(box))["cost_fence"].tolist() == [1.0, 1.0, 1.0]
    task = type("Task", (), {"arena_at": lambda self, index: box})()
    robot.truth[:, 2] = 1.0, 1.0, -3.0
    assert costs_of(robot, "fence", task=task)["cost_fence"].tolist() == [0.0, 1.0, 1.0]


@pytest.mark.parametrize("flies", [True, False])
def test_below_the_arena_of_a_task_nobody_is_outside_but_below_a_box_that_was_given(flies):
    """An arena begins where positions are drawn; a robot that lands is below. What does not fly has no heights."""
    robot, box = Told(), Arena((-5.0, -5.0, 1.0), (5.0, 5.0, 2.0))
    robot.kind = type("Kind", (), {"takes_off": flies})
    robot.truth[:, :3] = (0.0, 0.0, -3.0), (0.0, 0.0, 1.5), (0.0, 0.0, 2.5)
    task = type("Task", (), {"arena_at": lambda self, index: box})()
    assert costs_of(robot, "fence", task=task)["cost_fence"].tolist() == [0.0, 0.0, float(flies)]
    assert costs_of(robot, Fence(box))["cost_fence"].tolist() == [float(flies), 0.0, float(flies)]


@pytest.mark.parametrize(
    ("frame", "climbs", "outline"),
    [
        ("erle_copter", 3.0, (0.32, 0.0, 3.17)),  # one disc
        ("erle_rover", 0.0, (0.506 + 0.9, 0.0, 0.85)),  # three discs, of which that at its front reaches farthest
        ("ardupilot_rover", 0.5, (0.25, 0.0, 0.8)),
    ],
)
def test_a_volume_has_all_discs_of_an_outline_and_what_it_climbs(frame, climbs, outline):
    volume = kind.volume(load(frame), climbs)
    assert (volume.radius, volume.bottom, volume.top) == pytest.approx(outline)
    low = load(frame).changed(contact_bottom=0.2)
    assert kind.volume(low, climbs).bottom == -0.2


def test_proximity_is_the_distance_of_the_volume_to_the_nearest_solid():
    robot = Told([Box((10.0, 0.0, 1.0), (2.0, 20.0, 2.0), 0.0), Box((0.0, 8.0, 1.0), (2.0, 2.0, 2.0), 0.0)])
    robot.truth[:, :3] = (8.0, 0.0, 0.5), (0.0, 6.0, 0.5), (8.9, 0.0, 5.0)
    proximity = Proximity(0.51)
    proximity.prepare(robot, None)
    step = Step(robot, 0.1)
    step.judge.knows_truth = True
    assert proximity.distances(step) == pytest.approx([0.5, 0.5, 2.9])
    assert proximity(step).tolist() == [1.0, 1.0, 0.0]
    assert costs_of(Told(), "proximity")["cost_proximity"].tolist() == [0.0, 0.0, 0.0], "a world without solids"


def test_tilt_and_speed_are_limits_in_all_directions():
    robot = Told()
    robot.truth[:, 8:10] = (0.25, 0.25), (-0.25, 0.3), (0.0, 0.36)  # 0.352, 0.389, 0.36 from upright
    assert costs_of(robot, Tilt(0.355))["cost_tilt"].tolist() == [0.0, 1.0, 1.0]
    robot.truth[:, 4:7] = (3.0, 0.1, 0.0), (-2.0, 2.0, 0.0), (0.0, 0.0, -3.5)
    assert costs_of(robot, {"cost": "speed", "speed": 3.01})["cost_speed"].tolist() == [0.0, 0.0, 1.0]


def test_a_function_is_a_cost_and_the_sum_has_all():
    robot = Told()
    robot.truth[:, 8] = 0.0, 1.0, 0.0
    found = costs_of(robot, "tilt", lambda step: 2.0 * np.arange(3), lambda step: 0.5)
    assert list(found) == ["cost", "cost_tilt", "cost_term_1", "cost_term_2"]
    assert found["cost"].tolist() == [0.5, 3.5, 4.5]


def test_energy_is_what_leaves_the_battery():
    env = gym.make("sitl/CopterHover-v1", costs=[Energy(1000.0)], observation=["true_battery"], randomise=None)
    before = env.reset(seed=1)[0]
    total = 0.0
    for _ in range(50):
        after, *_, info = env.step(0.0 * AHEAD)
        assert info["cost_energy"] == pytest.approx(0.1 * after[0] * after[1], rel=1e-5)
        total += info["cost"]
    assert total == pytest.approx(5.0 * after[0] * after[1], rel=0.1)
    assert before[2] > after[2]
    env.close()


def test_costs_change_nothing_else():
    plain, costly = gym.make("sitl/CopterRooms-v1"), gym.make("sitl/CopterRooms-v1", costs=ALL)
    assert same(plain.reset(seed=2)[0], costly.reset(seed=2)[0])
    ended = False
    while not ended:
        observation, reward, ended, _, info = plain.step(AHEAD)
        others = costly.step(AHEAD)
        assert same(observation, others[0]) and others[1:3] == (reward, ended)
        assert not any(name.startswith("cost") for name in info)
        told = {name: value for name, value in others[4].items() if name.startswith("cost")}
        assert {name: value for name, value in others[4].items() if name not in told}.keys() == info.keys()
        assert list(told) == ["cost", *(f"cost_{name}" for name in ALL)]
        assert told["cost"] == pytest.approx(sum(told[f"cost_{name}"] for name in ALL))
    assert told["cost_crash"] == told["cost_proximity"] == 1.0, "it flew into a wall"
    plain.close()
    costly.close()


def test_costs_are_told_where_the_task_tells_nothing_but_crashes():
    env = gym.make("sitl/Navigate-v1", costs="proximity+crash", world="maze")
    env.reset(seed=1)
    info = env.step(0)[4]
    assert list(info) == ["crashed", "cost", "cost_proximity", "cost_crash"]
    env.close()


def test_names_can_be_one_text():
    assert list(costs_of(Told(), "tilt")) == ["cost", "cost_tilt"]
    costs = Costs("tilt+speed")
    costs.prepare(Told(), None)
    assert list(costs.of(Step(Told(), 0.1))) == ["cost", "cost_tilt", "cost_speed"]


def test_costs_go_by_the_truth_where_it_is_known():
    robot = Told()
    robot.truth[0, 8] = 1.0
    assert costs_of(robot, "tilt")["cost_tilt"].tolist() == [1.0, 0.0, 0.0]
    robot.knows_truth = False
    assert costs_of(robot, "tilt")["cost_tilt"].tolist() == [float(math.cos(1e3) ** 2 < math.cos(0.35))] * 3


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
def test_vectors_give_the_costs_of_singles(mode):
    options = {"costs": ALL, "world": "rooms:seed=1"}
    vector = SafetyVectorEnv(gym.make_vec("sitl/CopterRooms-v1", num_envs=2, autoreset_mode=mode, **options))
    singles = [SafetyEnv(gym.make("sitl/CopterRooms-v1", **options)) for _ in range(2)]
    vector.reset(seed=5)
    for k, env in enumerate(singles):
        env.reset(seed=5 + k)
    running = np.ones(2, np.bool_)
    sums = []
    while running.any():
        _, _, costs, terminated, _, infos = vector.step(np.stack([AHEAD, AHEAD]))
        for k, env in enumerate(singles):
            if running[k]:
                _, _, cost, ended, _, info = env.step(AHEAD)
                told = infos["final_info"] if mode == "SameStep" and ended else infos
                assert costs[k] == cost == info["cost_sum"] == told["cost_sum"][k] and ended == terminated[k]
                assert "cost" not in info and "cost" not in told
                sums.append(cost)
                running[k] = not ended
    assert sum(sums) > 2.0
    vector.close()


def test_each_robot_has_the_solids_and_the_fence_of_its_own_world():
    names = ["rooms:seed=1", "forest:seed=3"]
    options = {"costs": [Proximity(0.8), "fence"]}
    vector = gym.make_vec("sitl/CopterRooms-v1", num_envs=4, world=names, **options)
    vector.reset(seed=3)
    told = [vector.step(np.tile(AHEAD, (4, 1)))[4] for _ in range(25)]
    drawn = list(vector.unwrapped.session.world_names)
    assert {name.partition(":")[0] for name in drawn} == {"rooms", "forest"}
    vector.close()
    for k, name in enumerate(drawn):
        env = gym.make("sitl/CopterRooms-v1", world=name, **options)
        env.reset(seed=3 + k)
        for step in told:
            info = env.step(AHEAD)[4]
            assert step["cost"][k] == info["cost"]
        env.close()
    assert len({bytes(np.array([step["cost"][k] for step in told])) for k in range(4)}) > 1


def test_a_step_that_only_resets_costs_nothing():
    vector = SafetyVectorEnv(gym.make_vec("sitl/CopterHover-v1", num_envs=2, max_episode_steps=2, costs=["energy"]))
    vector.reset(seed=1)
    actions = np.zeros((2, 4), np.float32)
    assert [bool(vector.step(actions)[2].all()) for _ in range(4)] == [True, True, False, True]
    vector.close()


def test_costs_go_on_after_a_pickle_and_a_snapshot():
    env = gym.make("sitl/RoverLabyrinth-v1", costs=ALL)
    env.reset(seed=1)
    env.step(np.ones(2, np.float32))
    kept, copy = env.unwrapped.snapshot(), pickle.loads(pickle.dumps(env))
    expected = env.step(np.ones(2, np.float32))[4]
    assert copy.step(np.ones(2, np.float32))[4]["cost"] == expected["cost"] > 0.0
    env.unwrapped.restore(kept)
    assert env.step(np.ones(2, np.float32))[4]["cost"] == expected["cost"]
    env.close()


@pytest.mark.parametrize(
    ("costs", "needed"),
    [
        (["proximit"], "cost 'proximit' is not known; .*did you mean 'proximity'"),
        (3, "costs = 3; it must be names of fence"),
        ([{"cost": "tilt", "angl": 3}], "unexpected keyword argument 'angl'"),
        ([{"angle": 3}], "cost None is not known"),
        (["tilt", Tilt(0.1)], "'tilt' is given more than once"),
        ([{"cost": "tilt", "angle": -1}], r"cost Tilt\(angle=-1\); it must be above 0 rad"),
        ([Tilt], "is neither a name"),
        (["energy"], "robot 'turtlebot' has no battery"),
        ([{"cost": "fence", "box": [[0, 0, 0], [1, 1, -1]]}], r"Fence\(box=.*low < high"),
    ],
)
def test_costs_that_cannot_be_are_refused(costs, needed):
    with pytest.raises(EnvOptionError, match=needed):
        gym.make("sitl/Navigate-v1", costs=costs)


def test_without_costs_the_wrappers_say_what_is_missing():
    env = SafetyEnv(gym.make("sitl/Navigate-v1"))
    env.reset(seed=1)
    with pytest.raises(EnvOptionError, match="make it with the option costs"):
        env.step(0)
    vector = SafetyVectorEnv(gym.make_vec("sitl/Navigate-v1", num_envs=2))
    vector.reset(seed=1)
    with pytest.raises(EnvOptionError, match="make it with the option costs"):
        vector.step(np.zeros(2, np.int64))
