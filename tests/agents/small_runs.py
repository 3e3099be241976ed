# SPDX-License-Identifier: BSD-3-Clause
"""Short runs of tabular learners, how they are compared, and runs that nobody trained, whose rewards are given."""

from __future__ import annotations

import gymnasium as gym

import sitl.envs  # noqa: F401 (registers the environments)
from sitl.agents.report.group import Group
from sitl.agents.runs.config import RunConfig
from sitl.agents.runs.episodes import Episode
from sitl.agents.runs.files import read_arrays
from sitl.agents.runs.folder import RunFolder
from sitl.agents.tabular import training
from sitl.agents.tabular.learner import Learner
from sitl.agents.tabular.settings import Settings
from sitl.agents.tabular.table import Table

CIRCUIT2 = "GazeboCircuit2TurtlebotLIDAR-v0"
CHECKS = {"check_every": 8, "check_episodes": 3}


def config(algorithm="qlearn", env=CIRCUIT2, **fields):
    """A run of 30 episodes of at most 60 steps, unless told otherwise."""
    chosen = training.settings(algorithm, {**CHECKS, **fields.pop("settings", {})})
    return RunConfig(env, algorithm, settings=chosen, **{"episodes": 30, "max_steps": 60, **fields})


def new(path, algorithm="qlearn", **fields):
    """The folder of such a run."""
    return RunFolder.create(path, config(algorithm, **fields))


def learner_for(env, algorithm="qlearn", settings=None, seed=1):
    """A learner with an empty table."""
    table = Table.for_spaces(env.observation_space, env.action_space)
    return Learner(algorithm, settings or Settings(), table, seed)


def make(name=CIRCUIT2, steps=60, **options):
    """An environment with short episodes."""
    return gym.make(name, max_episode_steps=steps, **options)


def result(run):
    """All of a run that must repeat: rows without wall time, and the arrays of its models as bytes."""
    rows = [row[:-1] for row in run.episodes.rows()]
    found = (run.path / name for name in (training.MODEL, training.BEST))
    models = [read_arrays(path) for path in found if path.exists()]
    return rows, [{name: value.tobytes() for name, value in model.items()} for model in models]


def write(path, rewards, seed=0, **fields):
    """A run whose episodes had these rewards."""
    run = RunFolder.create(path, config(seed=seed, episodes=max(len(rewards), 1), **fields))
    run.episodes.append(Episode(k, 10, float(reward), 0.1, 1, 6.0, 0.01) for k, reward in enumerate(rewards))
    return run


def group(path, name, rows, **fields):
    """A group of such runs, a row of rewards each."""
    return Group(name, [write(path / name / str(seed), row, seed, **fields) for seed, row in enumerate(rows)])
