# SPDX-License-Identifier: BSD-3-Clause
"""Evaluations of several runs at a time: those of one after the other, also when their episodes are divided."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from sitl.agents.evaluate import evaluate_run
from sitl.agents.evaluations import Part, evaluate_groups, evaluate_runs, play_part
from sitl.agents.runs import local
from sitl.agents.runs.backends import Workers
from sitl.agents.runs.plan import EvaluationPlan
from sitl.agents.runs.training import train_one
from tests.agents.small_runs import new

ROVER = {"observation": "digits", "action": "discrete", "start": "random"}


def trained(path, **fields):
    run = new(path, **fields)
    train_one(run.path, lambda rows: None, lambda: False)
    return run


def test_divided_episodes_are_those_of_one_evaluation(tmp_path):
    runs = [trained(tmp_path / str(seed), seed=seed) for seed in range(2)]
    plan = EvaluationPlan(episodes=7, jitter=0.2, max_steps=50, options={"start": "random"})
    asked = []

    def each(work, items, jobs):
        asked.append([(item.first, item.count) for item in items])
        return [local.each(work, [item])[0] for item in reversed(items)][::-1]

    found = evaluate_runs(runs, [plan, EvaluationPlan(episodes=1)], 3, SimpleNamespace(jobs=5, each=each))
    assert asked == [[(0, 2), (2, 2), (4, 3), (0, 1)]]
    assert found[0] == evaluate_run(runs[0], plan, 3) and len(found[1].episodes) == 1


@pytest.mark.slow
def test_so_are_those_of_other_processes_and_of_a_robot_with_an_autopilot(tmp_path):
    run = trained(tmp_path / "rover", env="GazeboMazeErleRoverLIDAR-v0", episodes=1, env_options=ROVER)
    plan = EvaluationPlan(episodes=4)
    whole, parts = (evaluate_groups([[run]], [plan], Workers(jobs)) for jobs in (1, 2))
    assert repr(whole) == repr(parts) and len({played.reward for played in whole[0][0].episodes}) > 1


def test_an_interrupt_ends_it_after_an_episode(tmp_path):
    run = trained(tmp_path / "run")
    told = []
    part = Part(run.path, EvaluationPlan(episodes=5), 0, 0, 5)
    assert play_part(part, told.append, lambda: len(told) == 2) is None and told == [1, 1]
    with pytest.raises(KeyboardInterrupt):
        evaluate_runs([run], [EvaluationPlan()], 0, SimpleNamespace(jobs=1, each=lambda *words: [None]))
