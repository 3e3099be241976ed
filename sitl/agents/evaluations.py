# SPDX-License-Identifier: BSD-3-Clause
"""Evaluations of many runs, several at a time. Each is that of ``evaluate_run``, wherever its episodes are played."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from .evaluate import Evaluation, Interrupted, evaluate, stage, until_stopped
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
    with stage(RunFolder(part.run), part.plan, part.seed) as (env, policy, poses):
        try:
            return evaluate(env, policy, part.count, part.seed, poses, until_stopped(tell, stopped), part.first)
        except Interrupted:
            return None


def _shares(episodes: int, count: int) -> list[tuple[int, int]]:
    """(first, how many) of at most so many parts."""
    bounds = [episodes * k // min(count, episodes) for k in range(min(count, episodes) + 1)]
    return [(first, last - first) for first, last in pairwise(bounds)]


def evaluate_groups(
    groups: Sequence[Sequence[RunFolder]], plans: Sequence[EvaluationPlan], workers: Workers | None = None
) -> list[list[Evaluation]]:
    """The same of groups of runs, all at once, with a plan for each group; an evaluation for each run of each."""
    runs = [run for group in groups for run in group]
    each = [plan for group, plan in zip(groups, plans) for _ in group]
    found = iter(evaluate_runs(runs, each, workers=workers))
    return [[next(found) for _ in group] for group in groups]
