# SPDX-License-Identifier: BSD-3-Clause
"""The report that holds groups of runs side by side."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from ..errors import AgentError
from ..evaluate import Evaluation
from ..runs.backends import Workers
from ..runs.evaluation_plan import EvaluationPlan
from ..runs.files import make_folder
from .document import Document
from .group import Group
from .sections import (
    aggregates,
    block_of,
    blocks_csv,
    blocks_table,
    curves_text,
    draw_curves,
    greedy_play,
    interval_text,
)  # fmt: skip


def compare(
    groups: Sequence[Group], folder: Path, block: int | None = None, play: int = 0, workers: Workers | None = None
) -> Path:
    """Write report.md, report.html, pictures and CSV files.

    Args:
        groups: groups that are compared, of one environment.
        folder: for the files.
        block: episodes of an average; None: 200, or fewer where runs are short.
        play: greedy episodes of each run; 0: none.
        workers: workers that play them.

    Returns:
        path of the Markdown.

    Raises:
        AgentError: groups of different environments, or a run that is in two groups, or no such folder can be made.
    """
    _each_once(groups)
    environments = {group.config.env for group in groups}
    if len(environments) > 1:
        raise AgentError(
            f"rewards of {' and '.join(sorted(environments))} cannot be compared; give runs of one of them"
        )
    make_folder(folder)
    block = block_of(groups, block)
    document = Document("Comparison of runs")
    document.table(
        ["", "environment", "algorithm", "seeds", "episodes", "settings"], [_about(g, groups) for g in groups]
    )
    document.points(_remarks(groups))
    document.heading(f"Mean reward per {block} episodes")
    document.paragraph(interval_text(groups))
    document.table(*blocks_table(groups, block))
    document.paragraph(curves_text(block))
    document.picture(draw_curves(folder / "curves.png", groups, block, {}), "learning curves")
    common = min(group.rewards.shape[1] for group in groups)
    if any(group.rewards.shape[1] > common for group in groups):
        document.paragraph(f"What follows is of the first {common} episodes, which all have.")
    aggregates(document, folder, [group.first(common) for group in groups], block)
    if play:
        document.heading("Played greedily")
        document.paragraph("What was learnt, without learning and exploring, as `sitl evaluate` plays it.")
        plans = [group.config.evaluation.changed(episodes=play) for group in groups]
        document.points(_unlike(groups, plans))
        found = greedy_play(document, folder, groups, plans, workers)
        every = [evaluation for evaluations in found for evaluation in evaluations]
        same = sum(map(_all_same, every))
        if play > 1 and same:
            document.paragraph(
                f"In {same} of {len(every)} runs all episodes were the same: nothing in them is random. "
                "`sitl evaluate RUN --jitter 0.1` plays from moved starts."
            )
    blocks_csv(folder / "blocks.csv", groups, block)
    return document.write(folder)


def _each_once(groups: Sequence[Group]) -> None:
    of: dict[Path, str] = {}
    for group in groups:
        for run in group.runs:
            path = run.path.resolve()
            if path in of:
                raise AgentError(f"{run.path} is given twice; a run cannot be compared with itself")
            of[path] = group.name


def _remarks(groups: Sequence[Group]) -> list[str]:
    """Remarks on differences between the groups."""
    texts = []
    differing = sorted(set(_task(groups[0])).union(*map(_task, groups)))
    differing = [name for name in differing if name != "observation"]  # rewards do not depend on what is seen
    differing = [name for name in differing if any(_task(g).get(name) != _task(groups[0]).get(name) for g in groups)]
    if differing:
        texts.append(
            f"The groups did not learn the same task: they differ in {', '.join(differing)}. "
            "Their rewards may not mean the same."
        )
    for group in groups:
        if len(set(group.lengths)) > 1:
            texts.append(
                f"Seeds of {group.name} have from {min(group.lengths)} to {max(group.lengths)} episodes; shown are the "
                f"first {min(group.lengths)}, which all have."
            )
    return texts


def _unlike(groups: Sequence[Group], plans: Sequence[EvaluationPlan]) -> list[str]:
    """Remarks on groups that are evaluated differently."""
    how = [{**asdict(plan), "max_steps": plan.max_steps or g.config.max_steps} for g, plan in zip(groups, plans)]
    names = [name for name in how[0] if any(one[name] != how[0][name] for one in how)]
    if not names:
        return []
    texts = [f"{g.name}: {', '.join(f'{name} = {one[name]}' for name in names)}" for g, one in zip(groups, how)]
    return [f"The groups are not evaluated alike, and their rewards may not mean the same. {'; '.join(texts)}."]


def _all_same(evaluation: Evaluation) -> bool:
    return len({(played.reward, played.steps) for played in evaluation.episodes}) == 1


def _task(group: Group) -> dict[str, Any]:
    """Options of the environment and longest episode."""
    return {**group.config.env_options, "max_steps": group.config.max_steps}


def _about(group: Group, groups: Sequence[Group]) -> list[str]:
    config = group.config
    all_settings = [_settings(other) for other in groups]
    settings = _settings(group)
    if len(groups) > 1:
        settings = {n: v for n, v in settings.items() if any(other.get(n) != v for other in all_settings)}
    text = ", ".join(f"{name} = {value}" for name, value in settings.items())
    return [group.name, config.env, config.algorithm, str(len(group.runs)), str(group.rewards.shape[1]), text]


def _settings(group: Group) -> dict[str, Any]:
    """Settings of the algorithm and options of the environment."""
    return {**group.config.settings, **_task(group)}
