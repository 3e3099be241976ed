# SPDX-License-Identifier: BSD-3-Clause
"""Runs that nobody trained: their rewards are given."""

from __future__ import annotations

from sitl.agents.report.group import Group
from sitl.agents.runs.episodes import Episode
from sitl.agents.runs.folder import RunFolder
from tests.agents.small_runs import config


def write(path, rewards, seed=0, **fields):
    """A run whose episodes had these rewards."""
    run = RunFolder.create(path, config(seed=seed, episodes=max(len(rewards), 1), **fields))
    run.episodes.append(Episode(k, 10, float(reward), 0.1, 1, 6.0, 0.01) for k, reward in enumerate(rewards))
    return run


def group(path, name, rows, **fields):
    """A group of such runs, a row of rewards each."""
    return Group(name, [write(path / name / str(seed), row, seed, **fields) for seed, row in enumerate(rows)])
