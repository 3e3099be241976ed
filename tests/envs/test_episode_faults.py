# SPDX-License-Identifier: BSD-3-Clause
"""Faults that are drawn for episodes."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np
import pytest

import sitl.envs  # noqa: F401
from sitl.envs import EnvOptionError

ROVER: dict[str, Any] = {"robot": "erle_rover", "world": "maze_erlerover", "step_time": 0.2}


def shares(env: gym.Env[Any, Any]) -> tuple[float, float]:
    """Of steering and motor, that are left."""
    share = env.unwrapped.robot.view(0).physics.wheels.share  # type: ignore[attr-defined]
    return share.x, share.y


def test_one_is_drawn_and_begins_at_its_time() -> None:
    env = gym.make("sitl/Navigate-v1", **ROVER, faults={"servo:1": (0.4, 1.4), "motor:3=0.5": 1.0, "": 0.0})
    found: dict[int, set[int]] = {0: set(), 1: set(), 2: set()}
    for seed in range(12):
        env.reset(seed=seed)
        told = []
        for _ in range(10):
            *_, info = env.step(0)
            told.append(info["fault"])
            wanted = {0: (1.0, 1.0), 1: (0.0, 1.0), 2: (1.0, 0.5)}[info["fault"]]
            if info["fault"]:
                assert shares(env) == wanted
        number = told[-1]
        found[number].add(told.index(number) if number else 0)
        assert told == sorted(told)
    assert found[0] and len(found[1]) > 1 and found[2] in ({4}, {5})
    env.close()


def test_a_vector_environment_and_snapshots_have_the_same() -> None:
    options = {**ROVER, "faults": {"servo:1": (0.2, 1.4), "gps": (0.2, 0.6)}}
    env, many = gym.make("sitl/Navigate-v1", **options), gym.make_vec("sitl/Navigate-v1", num_envs=3, **options)
    many.reset(seed=5)
    rows = [many.step(np.zeros(3, np.int64)) for _ in range(8)]
    for index in range(3):
        env.reset(seed=5 + index)
        kept = env.unwrapped.snapshot()  # type: ignore[attr-defined]
        for again in (False, True):
            if again:
                env.unwrapped.restore(kept)  # type: ignore[attr-defined]
            for observations, *_, infos in rows:
                observation, *_, info = env.step(0)
                assert np.array_equal(observation, observations[index])
                assert info["fault"] == infos["fault"][index]
    assert {row[-1]["fault"][0] for row in rows} >= {0}
    env.close()
    many.close()


def drawn_places(count: int, **options: Any) -> list[list[float]]:
    """Start poses and places of the task of three episodes of each robot, in their order."""
    env = gym.make_vec("sitl/RoverCourse-v0", num_envs=count, start="turned", **options)
    env.reset(seed=7)
    found = []
    for episode in range(3):
        if episode:
            env.reset()
        task: Any = env.unwrapped.task  # type: ignore[attr-defined]
        found.append([*task.positions.ravel(), *env.unwrapped.robot.pose[:, 3]])  # type: ignore[attr-defined]
    env.close()
    return found


@pytest.mark.parametrize(
    "options",
    [
        {"faults": {"gps": (50.0, 60.0), "": 0.0}},
        {"randomise": {"mass": (4.0, 6.0), "latency": (0.0, 0.1)}},
        {"randomise": {"grip": (0.6, 0.8), "draws": 3}, "faults": {"gps": 50.0}},
        {"randomise": {"battery": lambda rng: float(rng.uniform(11.0, 12.0))}},
    ],
)
def test_the_task_is_the_same_with_and_without(options: dict[str, Any]) -> None:
    assert np.allclose(drawn_places(2, **options), drawn_places(2), atol=0.05)
    single = []
    for given in ({}, options):
        env = gym.make("sitl/RoverCourse-v0", **given)
        env.reset(seed=8)
        single.append(env.unwrapped.task.positions.tolist())  # type: ignore[attr-defined]
        env.close()
    assert single[0] == single[1]


def test_amounts_are_drawn_for_each_episode() -> None:
    ranges = {"motor:3": (0.3, 0.9), "battery": lambda rng: float(rng.integers(10, 13)), "SIM_GPS1_NOISE": (1.0, 2.0)}
    options = {**ROVER, "randomise": ranges, "faults": {"gps/garbage": 0.0}}
    env, many = gym.make("sitl/Navigate-v1", **options), gym.make_vec("sitl/Navigate-v1", num_envs=3, **options)

    def seen(robot: Any, index: int = 0) -> tuple[float, ...]:
        v = robot.view(index)
        return (v.physics.wheels.share.y, v.physics.battery.full_voltage, v.physics.sensors.gps[0].fault.noise)

    many.reset(seed=5)
    many.step(np.zeros(3, np.int64))
    drawn = [seen(many.unwrapped.robot, k) for k in range(3)]  # type: ignore[attr-defined]
    for index, wanted in enumerate(drawn):
        env.reset(seed=5 + index)
        kept = env.unwrapped.snapshot()  # type: ignore[attr-defined]
        env.step(0)
        robot = env.unwrapped.robot  # type: ignore[attr-defined]
        assert seen(robot) == wanted
        env.reset()
        env.unwrapped.restore(kept)  # type: ignore[attr-defined]
        env.step(0)
        assert seen(robot) == wanted and wanted[1] in (10, 11, 12) and 1.0 <= wanted[2] <= 2.0
        assert robot.view(0).physics.sensors.gps[0].jammed
    assert len(set(drawn)) == 3 and all(0.3 <= share <= 0.9 for share, *_ in drawn)
    env.close()
    many.close()


@pytest.mark.parametrize(
    ("options", "why"),
    [
        ({"randomise": {"gps": (0, 1)}}, "fault gps/off takes no amount"),
        ({"randomise": {"gps/wrong@3": (0, 1)}}, "neither is said"),
        ({"randomise": {"motor:1": (0.5, 1.5)}}, "SIM_ENGINE_MUL: 1.5 is outside 0 .. 1"),
        ({"randomise": {"motor:2": (0.5, 0.9)}}, "there is no number 2; airframe erle_rover has 1, 3, and 0 for all"),
        ({"randomise": {"SIM_WIND_SPD": (0, 8)}}, "SIM_WIND_SPD does nothing to airframe erle_rover"),
        ({"faults": {"servo:4": 1.0}}, "there is no number 4"),
        ({"randomise": {"motor:2": (0.5, 0.2)}}, r"\(0.5, 0.2\) is not \(low, high\)"),
        ({"randomise": {"motor:2": 3}}, r"it must be \(low, high\) or a function"),
        ({"randomise": {"SIM_GPS1_NUMSATS": (3, 9)}}, "is not a whole number"),
        ({"randomise": {"SIM_GPS1_NUMSAT": (3, 9)}}, "no such parameter has an effect"),
        (
            {"randomise": {"gps/wrong": (3, 9)}, "robot": "turtlebot", "world": "maze"},
            "'turtlebot' has no faults",
        ),
        ({"faults": {"gsp": 1.0}}, "there is no fault 'gsp'; there are gps"),
        ({"faults": {"gps": (3.0, 1.0)}}, r"'gps': \(3.0, 1.0\) is neither a time"),
        ({"faults": {"gps@3": 1.0}}, "its time stands behind it"),
        ({"faults": "gps"}, "it must map faults to their times"),
        ({"faults": {"gps": 1.0}, "robot": "turtlebot", "world": "maze"}, "robot 'turtlebot' has none"),
    ],
)
def test_what_cannot_be_is_said(options: dict[str, Any], why: str) -> None:
    with pytest.raises(EnvOptionError, match=why):
        gym.make("sitl/Navigate-v1", **{**ROVER, **options})


OFFICE = "GazeboOfficeErleCopterLIDAR-v0"
SECOND = {"GPS2_TYPE": 1, "SIM_GPS2_ENABLE": 1}


@pytest.mark.parametrize(
    ("options", "why"),
    [
        ({"faults": {"optical_flow": 0.5}}, "no optical_flow 1: SIM_FLOW_ENABLE is 0, not 1"),
        ({"faults": {"gps:2": 0.5, "": 0.0}}, "no gps 2: GPS2_TYPE is 0, not 1"),
        ({"faults": {"gps:2": 0.5}, "params": {"GPS2_TYPE": 1}}, "no gps 2: SIM_GPS2_ENABLE is 0, not 1"),
        ({"faults": {"baro:2": 0.5}, "params": {"SIM_BARO_COUNT": 1}}, "no baro 2: SIM_BARO_COUNT is 1, not 2"),
        ({"faults": {"SIM_FLOW_RND=1": 0.5}}, "SIM_FLOW_RND: .* no optical_flow 1"),
        ({"randomise": {"gps:2/wrong": (0, 5)}}, "no gps 2"),
    ],
)
def test_sensors_that_are_not_there_are_refused_at_once(options: dict[str, Any], why: str) -> None:
    with pytest.raises(EnvOptionError, match=why):
        gym.make(OFFICE, **options)


def test_sensors_that_parameters_switch_on_are_there() -> None:
    for faults, params in (
        ({"gps:2": 0.5, "avoidance": 0.5}, SECOND),
        ({"optical_flow": 0.5}, {"SIM_FLOW_ENABLE": 1}),
    ):
        env = gym.make(OFFICE, faults=faults, params=params)
        assert env.unwrapped.spec.kwargs["faults"] == faults
        env.close()


def test_a_time_that_no_episode_reaches_is_told() -> None:
    options: dict[str, Any] = {**ROVER, "faults": {"servo:1": (5.0, 8.0), "gps": 0.4, "": 0.0}}
    late = r"faults: servo:1 begins at 5 s, and an episode of 25 steps ends at 5 s"
    with pytest.raises(EnvOptionError, match=late):
        gym.make_vec("sitl/Navigate-v1", num_envs=2, max_episode_steps=25, **options)
    gym.make_vec("sitl/Navigate-v1", num_envs=2, max_episode_steps=26, **options).close()
    env = gym.make("sitl/RoverCourse-v0", faults={"gps": 9000.0})
    with pytest.warns(UserWarning, match=r"gps begins at 9000 s, and an episode of \d+ steps ends at .* unless max_ep"):
        env.reset(seed=1)
    env.close()
