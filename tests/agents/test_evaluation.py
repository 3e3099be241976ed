# SPDX-License-Identifier: BSD-3-Clause
"""Greedy play: crashes, laps, other worlds, moved starts; of several runs at a time, with divided episodes."""

from __future__ import annotations

import math
from itertools import pairwise
from types import SimpleNamespace

import gymnasium as gym
import numpy as np
import pytest
from pytest import approx

from sitl.agents import environments
from sitl.agents.errors import AgentError
from sitl.agents.evaluate import CENTRES, LapCounter, evaluate, evaluate_run, moved_starts
from sitl.agents.evaluations import Part, evaluate_groups, evaluate_runs, play_part
from sitl.agents.runs import local
from sitl.agents.runs.backends import Workers
from sitl.agents.runs.evaluation_plan import EvaluationPlan
from sitl.agents.runs.training import train_one
from sitl.agents.runs.watch import Watch
from sitl.agents.tabular import training
from sitl.agents.tabular.exploration import slot_of
from sitl.agents.tabular.table import Table
from sitl.agents.tabular.training import TablePolicy
from sitl.envs.observations import Digits
from tests.agents.small_runs import make, new

CORNERS = [(0.0, 0.0), (3.9, 0.0), (3.9, -3.8), (0.28, -3.8), (0.28, -7.65), (-3.7, -7.65), (-3.7, 0.0), (0.0, 0.0)]
"""Corners of the middle of its corridors, clockwise [m]."""


def forward_only(env):
    """A table that knows one state after another as "forward"."""
    table = Table.for_spaces(env.observation_space, env.action_space)

    class Forward(TablePolicy):
        def act(self, observation):
            slot = slot_of(self.table.keys, self.table.key(observation))
            self.table.keys[slot], self.table.values[slot] = self.table.key(observation), (1.0, 0.0, 0.0)
            return super().act(observation)

    return Forward(table)


def walk(corners):
    for (x0, y0), (x1, y1) in pairwise(corners):
        for k in range(20):
            yield x0 + (x1 - x0) * k / 20, y0 + (y1 - y0) * k / 20


def test_going_round_is_a_lap_in_either_direction():
    for corners in (CORNERS, CORNERS[::-1]):
        counter = LapCounter(CENTRES["circuit2"])
        for x, y in [*walk(corners), *walk(corners), corners[0]]:
            counter.take(x, y)
        assert counter.laps == approx(2.0)
    counter = LapCounter(CENTRES["circuit2"])
    for x, y in [*walk(CORNERS), *walk(CORNERS[::-1]), CORNERS[0]]:
        counter.take(x, y)
    assert counter.laps == approx(0.0, abs=1e-9)


def test_straight_on_crashes_every_time():
    env = make()
    found = evaluate(env, forward_only(env), 5)
    assert found.crash_rate == 1.0 and found.lap_rate == 0.0 and found.mean_laps == 0.0
    assert {played.reward for played in found.episodes} == {found.mean_reward}
    steps = found.episodes[0].steps
    assert found.mean_reward == 5.0 * (steps - 1) - 200.0 and found.mean_simulated_s == approx(0.6 * steps)
    assert "5 episodes" in found.sentence() and "5 crashes" in found.sentence()


def test_moved_starts_are_near_and_differ():
    env = make()
    poses = np.array(moved_starts(env, 50, 3, 0.1))
    assert np.abs(poses).max() <= 0.1 and len({tuple(p) for p in poses.tolist()}) == 50
    policy = forward_only(env)
    found = evaluate(env, policy, 10, poses=moved_starts(env, 10, 3, 0.4))
    assert len({played.reward for played in found.episodes}) > 1


def test_a_run_plays_where_it_learnt_and_elsewhere(tmp_path):
    run = new(tmp_path / "run", max_steps=100, episodes=60)
    training.train(run, Watch())
    here, there = (
        evaluate_run(run, EvaluationPlan(episodes=2, options=options)) for options in ({}, {"world": "maze"})
    )
    assert len(here.episodes) == 2 and not math.isnan(here.mean_laps)
    assert math.isnan(there.mean_laps) and "laps" not in there.sentence()
    with pytest.raises(AgentError, match="the table is for digits"):
        evaluate_run(run, EvaluationPlan(episodes=1, options={"observation": Digits(parts=4)}))
    with pytest.raises(AgentError, match="nowhere"):
        evaluate_run(run, EvaluationPlan(episodes=1, options={"world": "nowhere"}))


def test_first_state_apart_is_played_as_it_was_learnt():
    table = Table([4], 2)
    for key, values in ((1, (1.0, 0.0)), (1 + table.size, (0.0, 1.0))):
        table.keys[slot_of(table.keys, key)] = key
        table.values[slot_of(table.keys, key)] = values
    policy = TablePolicy(table, first_state_apart=True)
    policy.begin(0)
    assert [policy.act(1), policy.act(1)] == [1, 0]
    policy.begin(1)
    assert policy.act(1) == 1


def test_seeds_of_episodes_do_not_repeat():
    seeds = {environments.seed_of(seed, episode) for seed in range(20) for episode in range(100)}
    assert len(seeds) == 2000


def test_environments_without_poses_have_no_moved_starts():
    with pytest.raises(AgentError, match="cannot be moved"):
        moved_starts(gym.make("CliffWalking-v1"), 1, 0, 0.1)


def test_in_an_environment_of_another_kind_an_end_is_no_crash():
    class Walk:
        def check(self, observations, actions):
            pass

        def begin(self, seed):
            self.steps = iter([0, *[1] * 11, 2])  # up, along the cliff, down to the goal

        def act(self, observation):
            return next(self.steps)

    found = evaluate(gym.make("CliffWalking-v1", max_episode_steps=20), Walk(), 2)
    assert found.crash_rate == 0.0 and "0 crashes, 2 terminated otherwise" in found.sentence()


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
    rows = []
    part = Part(run.path, EvaluationPlan(episodes=5), 0, 0, 5)
    assert play_part(part, rows.append, lambda: len(rows) == 2) is None and rows == [1, 1]
    with pytest.raises(KeyboardInterrupt):
        evaluate_runs([run], [EvaluationPlan()], 0, SimpleNamespace(jobs=1, each=lambda *words: [None]))
