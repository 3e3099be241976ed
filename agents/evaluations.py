# SPDX-License-Identifier: BSD-3-Clause
"""Evaluations of many runs, several at a time. Each is that of ``evaluate_run``, wherever its episodes are played."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from . import algorithms, environments
from .evaluate import Evaluation, Interrupted, evaluate, moved_starts, until_stopped
from .runs.backends import Workers
from .runs.folder import RunFolder
from .runs.local import Stopped, Tell
from .runs.plan import EvaluationPlan


@dataclass(frozen=True)
class Part:
    """Some of the episodes of an evaluation; can be pickled."""

    run: Path
    plan: EvaluationPlan
    seed: int
    first: int
    count: int


def evaluate_runs(
    runs: Sequence[RunFolder], plans: Sequence[EvaluationPlan], seed: int = 0, workers: Workers | None = None
) -> list[Evaluation]:
    """Play what runs have learnt.

    Args:
        runs: that have a model.
        plans: of each, how it is played.
        seed: of the evaluations.
        workers: that play; where there are more of them than runs, the episodes of a run are divided among them.

    Raises:
        AgentError: no model, or not of this environment.
        KeyboardInterrupt: it was interrupted.
    """
    workers = workers or Workers()
    shares = [_shares(plan.episodes, -(-workers.jobs // len(runs))) for plan in plans]
    parts = [
        Part(run.path, plan, seed, first, count)
        for run, plan, some in zip(runs, plans, shares)
        for first, count in some
    ]
    found = iter(workers.each(play_part, parts, workers.jobs))
    out = []
    for some in shares:
        evaluations = [next(found) for _ in some]
        if None in evaluations:
            raise KeyboardInterrupt
        out.append(Evaluation(tuple(played for evaluation in evaluations for played in evaluation.episodes)))
    return out


def play_part(part: Part, tell: Tell, stopped: Stopped) -> Evaluation | None:
    """Play a part; tells 1 after each episode. None when it was stopped."""
    run, plan = RunFolder(part.run), part.plan
    config = run.config.with_(max_steps=plan.max_steps or run.config.max_steps)

    env = environments.make(config, **plan.options)
    try:
        poses = moved_starts(env, plan.episodes, part.seed, plan.jitter) if plan.jitter > 0.0 else None
        policy = algorithms.policy_of(run)
        return evaluate(env, policy, part.count, part.seed, poses, until_stopped(tell, stopped), part.first)
    except Interrupted:
        return None
    finally:
        env.close()


def _shares(episodes: int, count: int) -> list[tuple[int, int]]:
    """(first, how many) of at most so many parts."""
    bounds = [episodes * k // min(count, episodes) for k in range(min(count, episodes) + 1)]
    return [(first, last - first) for first, last in pairwise(bounds)]


def evaluate_groups(
    groups: Sequence[Sequence[RunFolder]], plan: EvaluationPlan, workers: Workers | None = None
) -> list[list[Evaluation]]:
    """The same of groups of runs, all at once and in the same way; returns an evaluation for each run of each."""
    runs = [run for group in groups for run in group]
    found = iter(evaluate_runs(runs, [plan] * len(runs), workers=workers))
    return [[next(found) for _ in group] for group in groups]
