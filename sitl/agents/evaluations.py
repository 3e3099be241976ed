# SPDX-License-Identifier: BSD-3-Clause
"""Evaluations of many runs, several at a time. Each is that of ``evaluate_run``, wherever its episodes are played."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from .evaluate import Evaluation, Interrupted, evaluate, stage, until_stopped
from .runs.backends import Workers
from .runs.evaluation_plan import EvaluationPlan
from .runs.folder import RunFolder
from .runs.local import SendProgress, Stopped


@dataclass(frozen=True)
class Part:
    """A range of the episodes of an evaluation; picklable."""

    run: Path
    plan: EvaluationPlan
    seed: int
    first: int
    count: int


def evaluate_runs(
    runs: Sequence[RunFolder], plans: Sequence[EvaluationPlan], seed: int = 0, workers: Workers | None = None
) -> list[Evaluation]:
    """Play the learnt policies of runs.

    Args:
        runs: runs that have a model.
        plans: a plan for each run.
        seed: seed of the evaluations.
        workers: workers that play; where there are more of them than runs, the episodes of a run are divided among
            them.

    Raises:
        AgentError: no model, or not of this environment.
        KeyboardInterrupt: it was interrupted.
    """
    workers = workers or Workers()
    ranges = [_ranges(plan.episodes, -(-workers.jobs // len(runs))) for plan in plans]
    parts = [
        Part(run.path, plan, seed, first, count)
        for run, plan, some in zip(runs, plans, ranges)
        for first, count in some
    ]
    found = iter(workers.each(play_part, parts, workers.jobs))
    out = []
    for some in ranges:
        evaluations = [next(found) for _ in some]
        if None in evaluations:
            raise KeyboardInterrupt
        out.append(Evaluation(tuple(played for evaluation in evaluations for played in evaluation.episodes)))
    return out


def play_part(part: Part, send_progress: SendProgress, stopped: Stopped) -> Evaluation | None:
    """Play a part; sends 1 after each episode. None when it was stopped."""
    with stage(RunFolder(part.run), part.plan, part.seed) as (env, policy, poses):
        try:
            return evaluate(
                env, policy, part.count, part.seed, poses, until_stopped(send_progress, stopped), part.first
            )
        except Interrupted:
            return None


def _ranges(episodes: int, count: int) -> list[tuple[int, int]]:
    """Split episodes into at most ``count`` parts: (first episode, number of episodes)."""
    bounds = [episodes * k // min(count, episodes) for k in range(min(count, episodes) + 1)]
    return [(first, last - first) for first, last in pairwise(bounds)]


def evaluate_groups(
    groups: Sequence[Sequence[RunFolder]], plans: Sequence[EvaluationPlan], workers: Workers | None = None
) -> list[list[Evaluation]]:
    """As ``evaluate_runs``, for groups of runs with a plan for each group; returns an evaluation for each run of each
    group."""
    runs = [run for group in groups for run in group]
    each = [plan for group, plan in zip(groups, plans) for _ in group]
    found = iter(evaluate_runs(runs, each, workers=workers))
    return [[next(found) for _ in group] for group in groups]
