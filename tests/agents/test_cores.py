# SPDX-License-Identifier: BSD-3-Clause
"""Runs share the cores of the machine, and their robots are advanced on those of their run."""

from __future__ import annotations

import pytest

from sitl.agents import environments
from sitl.agents.runs import cores, local
from sitl.agents.runs.config import RunConfig

ROVER = "GazeboMazeErleRoverLIDAR-v0"


@pytest.fixture
def four_cores(monkeypatch):
    monkeypatch.setattr(cores, "count", lambda: 4)
    monkeypatch.setattr(cores, "_sharing", 1)


def shared(item, send_progress, stopped):
    return cores._sharing


@pytest.mark.parametrize(("runs", "mine"), [(1, 4), (2, 2), (3, 1), (9, 1)])
def test_runs_side_by_side_share_the_cores(four_cores, runs, mine):
    cores.share_among(runs)
    assert cores.mine() == mine


def test_processes_know_how_many_they_are(four_cores):
    assert local.each(shared, ["a", "b", "c"], jobs=2) == [2, 2, 2]
    assert local.each(shared, ["a", "b"], jobs=1) == [1, 1]


def test_a_worker_of_ray_has_one_core(four_cores):
    from sitl.agents.runs.ray_worker import Worker

    Worker()
    assert cores.mine() == 1


@pytest.mark.parametrize(
    ("options", "count", "threads"), [({}, 16, 4), ({}, 3, 3), ({"threads": 1}, 16, 1), ({"threads": 3}, 16, 3)]
)
def test_vehicles_are_advanced_on_all_cores_of_the_run(four_cores, options, count, threads):
    env = environments.make_many(RunConfig(ROVER, "ppo", env_options=options, episodes=1), count)
    env.reset(seed=1)
    assert env.unwrapped.robot._vehicles.fleet.threads == threads
    env.close()


def test_robots_without_threads_are_made_as_before(four_cores):
    env = environments.make_many(RunConfig("GazeboCircuit2TurtlebotLIDAR-v0", "ppo", episodes=1), 4)
    assert env.reset(seed=1)[0].shape == (4, 5)
