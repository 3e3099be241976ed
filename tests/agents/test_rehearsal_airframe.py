# SPDX-License-Identifier: BSD-3-Clause
"""Rehearsal on an airframe whose properties were measured: the changes that its file makes."""

from __future__ import annotations

import dataclasses

import gymnasium as gym
import pytest

import sitl.envs
from sitl import vehicles
from sitl.agents.errors import AgentError
from sitl.agents.rehearsal.airframe_plan import airframe_plan

INERTIA = ((0.02, 0.02, 0.04), (0.025, 0.025, 0.05))


@pytest.fixture(scope="module")
def mine(tmp_path_factory):
    """File of a copter with a known mass, give or take."""
    known = vehicles.load("ardupilot_quad").changed(mass=3.0, inertia=(0.022, 0.022, 0.045))
    path = tmp_path_factory.mktemp("frames") / "mine.toml"
    path.write_text(vehicles.to_toml(dataclasses.replace(known, intervals={"mass": (2.9, 3.1), "inertia": INERTIA})))
    return str(path)


def test_its_changes_are_the_vehicle_and_the_ends_of_its_intervals(mine) -> None:
    plan = airframe_plan(mine)
    assert [one.name for one in plan.changes] == [
        "airframe ardupilot_quad", "least mass", "greatest mass", "least inertia", "greatest inertia",
        "drawn within the intervals",
    ]  # fmt: skip
    assert all(one.options == {"frame": mine} for one in plan.changes)
    assert [dict(one.set) for one in plan.changes[1:4]] == [{"mass": 2.9}, {"mass": 3.1}, {"inertia": INERTIA[0]}]
    assert plan.changes[-1].identified


def test_they_are_flown(mine) -> None:
    with gym.make("sitl/CopterHover-v1") as home:
        drawn = home.unwrapped.session.randomisation.ranges
        robot = home.unwrapped.robot
    for change, low, high in zip(airframe_plan(mine).changes, (3.0, 2.9, 3.1, 3.0), (3.0, 2.9, 3.1, 3.0)):
        with gym.make("sitl/CopterHover-v1", **change.env_options(robot, {}, drawn)) as env:
            env.reset(seed=1)
            airframe = env.unwrapped.robot.view(0).physics.airframe
            assert low <= airframe.mass <= high, change.name
            assert airframe.inertia.z == {"least inertia": 0.04}.get(change.name, 0.045)
            assert env.unwrapped.robot.view(0).physics.wind.speed > 0.0, "as at home"


def test_each_episode_draws_within_the_intervals(mine) -> None:
    with gym.make("sitl/CopterHover-v1", frame=mine, randomise={"identified": True, "mass": (2.0, 2.5)}) as env:
        found = []
        for seed in range(6):
            env.reset(seed=seed)
            airframe = env.unwrapped.robot.view(0).physics.airframe
            found.append((airframe.mass, *airframe.inertia))
        env.reset(seed=0)
        assert (env.unwrapped.robot.view(0).physics.airframe.mass) == found[0][0], "the seed draws them"
    for values, low, high in zip(zip(*found), (2.0, *INERTIA[0]), (2.5, *INERTIA[1])):
        assert low <= min(values) < max(values) <= high


def test_a_file_without_intervals_is_refused(tmp_path) -> None:
    path = tmp_path / "plain.toml"
    path.write_text(vehicles.to_toml(vehicles.load("erle_copter")))
    with pytest.raises(AgentError, match=r"airframe file '.*plain.toml' has no intervals.*sitl identify"):
        airframe_plan(path)
    with pytest.raises(AgentError, match="'erle_copte' is not known"):
        airframe_plan("erle_copte")


@pytest.mark.parametrize(
    ("randomise", "says"),
    [
        ("identified", "identified: airframe erle_copter has no intervals: give the frame of a file"),
        ("idenified", "randomise = 'idenified'; it must map properties .* or be 'identified'"),
        ({"identified": 3}, "identified = 3; it must be True or False"),
        ({"inertia": (1.0, 2.0)}, r"inertia = \(1.0, 2.0\); it must be \(low, high\), of 3 numbers each,"),
        ({"inertia": ((0.1, 0.2, 0.3), (0.2, 0.1, 0.3))}, r"inertia = .* low <= high within 1e-09 .. 1e\+06 kg m\^2"),
        ({"mass": ((1.0, 1.0), (2.0, 2.0))}, r"mass = .* it must be \(low, high\) or a function"),
    ],
)
def test_what_cannot_be_drawn_is_named(randomise, says) -> None:
    with pytest.raises(sitl.envs.EnvOptionError, match=says):
        gym.make("sitl/CopterHover-v1", randomise=randomise)
