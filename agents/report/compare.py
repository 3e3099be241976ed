# SPDX-License-Identifier: BSD-3-Clause
"""The report that holds groups of runs side by side."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..errors import AgentError
from ..evaluate import evaluate_run
from .document import Document
from .group import Group
from .sections import aggregates, block_of, blocks_csv, blocks_table, draw_curves, greedy_play


def compare(groups: Sequence[Group], folder: Path, block: int | None = None, play: int = 0) -> Path:
    """Write report.md, report.html, pictures and CSV files.

    Args:
        groups: that are compared, of one environment.
        folder: for the files.
        block: episodes of an average; None: 200, or fewer where runs are short.
        play: greedy episodes of each run; 0: none.

    Returns:
        path of the Markdown.
    """
    environments = {group.config.env for group in groups}
    if len(environments) > 1:
        raise AgentError(
            f"rewards of {' and '.join(sorted(environments))} cannot be compared; give runs of one of them"
        )
    folder.mkdir(parents=True, exist_ok=True)
    block = block_of(groups, block)
    document = Document("Comparison of runs")
    document.table(
        ["", "environment", "algorithm", "seeds", "episodes", "settings"], [_about(g, groups) for g in groups]
    )
    document.heading(f"Mean reward per {block} episodes")
    document.paragraph("Mean over seeds with its 95 % interval (Student's).")
    document.table(*blocks_table(groups, block))
    document.picture(draw_curves(folder / "curves.png", groups, block, {}), "learning curves")
    common = min(group.rewards.shape[1] for group in groups)
    if any(group.rewards.shape[1] > common for group in groups):
        document.paragraph(f"What follows is of the first {common} episodes, which all have.")
    aggregates(document, folder, [group.first(common) for group in groups], block)
    if play:
        document.heading("Played greedily")
        document.paragraph("What was learnt, without learning and exploring.")
        played = {g.name: {"as trained": [evaluate_run(run, play) for run in g.runs]} for g in groups}
        greedy_play(document, folder, played)
    blocks_csv(folder / "blocks.csv", groups, block)
    return document.write(folder)


def _about(group: Group, groups: Sequence[Group]) -> list[str]:
    config = group.config
    settings = {**config.settings, **config.env_options}
    others = [{**other.config.settings, **other.config.env_options} for other in groups]
    differing = (
        {n: v for n, v in settings.items() if any(o.get(n) != v for o in others)} if len(groups) > 1 else settings
    )
    text = ", ".join(f"{name} = {value}" for name, value in differing.items())
    return [group.name, config.env, config.algorithm, str(len(group.runs)), str(group.rewards.shape[1]), text]
