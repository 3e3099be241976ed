# SPDX-License-Identifier: BSD-3-Clause
"""Parts of reports on groups of runs: tables of blocks, curves, aggregate statistics, greedy play."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np

from ..evaluate import Evaluation
from ..evaluations import evaluate_groups
from ..runs.backends import Workers
from ..runs.evaluation_plan import EvaluationPlan
from ..runs.files import write_bytes
from . import curves
from .curves import draw_means, draw_raw
from .document import BLOCK, Document, block_names
from .group import Group
from .statistics import improvement_interval, iqm_interval, mean_interval, profile_interval

_FEW = 5
"""Number of seeds below which bootstrap intervals are too narrow."""


def write_csv(path: Path, head: Sequence[str], rows: Iterable[Sequence[Any]]) -> None:
    """Write a table as CSV."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows(rows)
    write_bytes(path, text.getvalue().encode())


def with_interval(mean: float, half: float) -> str:
    """A mean and its 95 % interval as text."""
    return f"{mean:.0f}" if math.isnan(half) else f"{mean:.0f} ± {half:.0f}"


def with_range(value: float, low: float, high: float, digits: int = 0) -> str:
    """A statistic and its 95 % bootstrap interval as text."""
    text = f"{value:.{digits}f}"
    return text if math.isnan(low) else f"{text} ({low:.{digits}f} .. {high:.{digits}f})"


def interval_text(groups: Sequence[Group]) -> str:
    """Explanation of the tables of blocks."""
    text = "Mean over seeds ± half of its 95 % interval (Student's)"
    return f"{text}; a single seed has no interval." if any(len(g.runs) == 1 for g in groups) else f"{text}."


def blocks_table(groups: Sequence[Group], block: int) -> tuple[list[str], list[list[str]]]:
    """Head and rows: mean reward of each block of episodes, with its 95 % interval over seeds."""
    columns = [mean_interval(group.blocks(block)) for group in groups]
    counts = [group.rewards.shape[1] for group in groups]
    names = block_names(max(counts), block)
    rows = []
    for k, name in enumerate(names):
        cells = []
        for (mean, half), count in zip(columns, counts):
            cell = with_interval(mean[k], half[k]) if k < len(mean) else ""
            own = block_names(count, block)[k] if cell else name
            cells.append(cell if own == name else f"{cell} (to {count})")
        rows.append([name, *cells])
    return ["episodes", *(group.name for group in groups)], rows


def blocks_csv(path: Path, groups: Sequence[Group], block: int) -> None:
    """Write the mean reward of each block and seed as CSV."""
    rows = (
        (group.name, run.config.seed, k * block, float(value))
        for group in groups
        for run, means in zip(group.runs, group.blocks(block))
        for k, value in enumerate(means)
    )
    write_csv(path, ("group", "seed", "first_episode", "mean_reward"), rows)


def draw_curves(path: Path, groups: Sequence[Group], block: int, paper: Mapping[str, Sequence[float]]) -> Path:
    """Raw curves of the first seeds, on one scale, and the means of all groups.

    Args:
        path: path of the picture.
        groups: groups whose curves are drawn.
        block: episodes of an average.
        paper: name -> means of its blocks, to be drawn beside ours.
    """
    made, axes = curves.figure(14.0, 4.2 * ((len(groups) + 2) // 2), (len(groups) + 2) // 2, 2)
    flat = list(axes.flat)
    for ax, group in zip(flat, groups):
        draw_raw(ax, group.rewards[0], f"{group.name}, seed {group.runs[0].config.seed}", block)
    raw = [ax.get_ylim() for ax in flat[: len(groups)]]
    for ax in flat[: len(groups)]:
        ax.set_ylim(min(low for low, _ in raw), max(high for _, high in raw))
    last = flat[len(groups)]
    draw_means(last, {group.name: group.rewards for group in groups}, block)
    for style, (name, means) in zip(("--", ":", "-."), paper.items()):
        last.plot((np.arange(len(means)) + 1) * block, means, style, color="black", label=name)
    curves.fit_to_lines(last)
    last.legend(loc="upper left")
    for unused in flat[len(groups) + 1 :]:
        unused.set_visible(False)
    return curves.save(made, path)


def curves_text(block: int) -> str:
    """Explanation of the picture of ``draw_curves``."""
    return (
        "One picture for each group: the episodes of its first seed (thin), and their means (thick). The last has the "
        f"means over all seeds of the {block} episodes before each, with their 95 % intervals where there are several "
        "seeds."
    )


def draw_profile(path: Path, groups: Sequence[Group], block: int, over: str) -> Path:
    """Draw performance profiles: the fraction of runs whose last block is above each level, with its 95 % interval."""
    scores = [group.last(block) for group in groups]
    lowest, highest = min(s.min() for s in scores), max(s.max() for s in scores)
    around = 0.05 * (highest - lowest) or 0.05 * abs(highest) or 1.0
    levels = np.linspace(lowest - around, highest + around, 400)
    made, axes = curves.figure(9.0, 4.5)
    for (colour, style), group, score in zip(curves.styles(), groups, scores):
        shares, low, high = profile_interval(score, levels)
        axes[0, 0].step(levels, shares, color=colour, linestyle=style, label=group.name, where="post")
        if len(score) > 1:
            axes[0, 0].fill_between(levels, low, high, color=colour, alpha=0.15, linewidth=0, step="post")
    axes[0, 0].set(xlabel=f"mean reward of {over}", ylabel="share of runs above", ylim=(-0.02, 1.02))
    axes[0, 0].grid(alpha=0.3)
    axes[0, 0].legend()
    return curves.save(made, path)


def aggregates(document: Document, folder: Path, groups: Sequence[Group], block: int) -> None:
    """Add interquartile means, probabilities of improvement and performance profiles of groups of the same length."""
    count = groups[0].rewards.shape[1]
    over = f"episodes {max(count - block, 0)} to {count}"
    seeds = [len(group.runs) for group in groups]
    rows, table = [], []
    for group in groups:
        cells = [group.name, str(len(group.runs))]
        for name, scores in {over: group.last(block), "all episodes": group.whole()}.items():
            value, low, high = iqm_interval(scores)
            rows.append((group.name, "interquartile mean", name, value, low, high))
            cells.append(with_range(value, low, high))
        table.append([*cells, f"{group.best:.0f}"])
    document.heading("Over all seeds")
    document.paragraph(
        "A seed's score is its mean reward over the episodes named; rewards are of one environment and not normalised. "
        "Interquartile mean: the mean of the scores without the least and the greatest quarter of them. In brackets a "
        "95 % bootstrap interval over seeds."
    )
    if min(seeds) < _FEW:
        document.paragraph(
            f"Some groups have fewer than {_FEW} seeds: their bootstrap intervals are narrower than the truth."
            if max(seeds) > 1
            else "Each group is a single seed: nothing here says how much another seed would differ."
        )
    document.table(["", "seeds", over, "all episodes", "best episode"], table)
    pairs = []
    for a, b in combinations(groups, 2):
        value, low, high = improvement_interval(a.last(block), b.last(block))
        rows.append((f"{a.name} > {b.name}", "probability of improvement", over, value, low, high))
        pairs.append([f"{a.name} above {b.name}", with_range(value, low, high, 2)])
    if pairs and max(seeds) > 1:
        document.paragraph(
            f"Probability of improvement: that a seed of the one has a higher score in {over} than a seed of the "
            "other, equal scores counting half."
        )
        document.table(["", "probability"], pairs)
    write_csv(folder / "aggregates.csv", ("of", "statistic", "over", "value", "low", "high"), rows)
    document.paragraph(f"Performance profiles: the share of seeds whose score in {over} is above each level.")
    document.picture(draw_profile(folder / "profile.png", groups, block, over), "performance profiles")


def greedy_play(
    document: Document, folder: Path, groups: Sequence[Group], plans: Sequence[EvaluationPlan], workers: Workers | None
) -> list[list[Evaluation]]:
    """Greedy evaluations and their table.

    Args:
        document: document that the table is added to.
        folder: for greedy.csv.
        groups: groups whose runs play.
        plans: plans of each group.
        workers: workers that play.

    Returns:
        an evaluation for each run of each group.
    """
    found = evaluate_groups([group.runs for group in groups], plans, workers)
    table, rows = [], []
    for group, plan, evaluations in zip(groups, plans, found):
        rewards = [e.mean_reward for e in evaluations]
        crashes = [100.0 * e.crash_rate for e in evaluations]
        laps = [e.mean_laps for e in evaluations]
        rates = [math.nan if math.isnan(e.mean_laps) else 100.0 * e.lap_rate for e in evaluations]
        cells = [f"{np.mean(rewards):.0f}", f"{100 - np.mean(crashes):.0f} %", f"{np.mean(laps):.1f}"]
        best = max(zip(rates, crashes), key=lambda shares: shares[0] - shares[1])[0]
        cells += [f"{np.mean(rates):.0f} %", f"{best:.0f} %"]
        table.append([group.name, str(plan.episodes), *("-" if "nan" in cell else cell for cell in cells)])
        seeds = [run.config.seed for run in group.runs]
        rows += [(group.name, *values) for values in zip(seeds, rewards, crashes, laps, rates)]
    head = ("", "episodes a seed", "mean reward", "without a crash", "laps an episode", "lap and no crash", "best seed")
    document.table(head, table)
    document.paragraph(
        "Means over seeds. Lap and no crash: the share of episodes with a whole lap or more and no crash; the last "
        "column has that of the best seed."
    )
    write_csv(folder / "greedy.csv", ("group", "seed", "mean_reward", "crash_percent", "laps", "lap_percent"), rows)
    return found


def block_of(groups: Sequence[Group], block: int | None) -> int:
    """Episodes of a block: the paper's 200, fewer where runs are short."""
    shortest = min(group.rewards.shape[1] for group in groups)
    return block or min(BLOCK, max(shortest // 5, 1))
