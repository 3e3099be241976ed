# SPDX-License-Identifier: BSD-3-Clause
"""Parts of reports on groups of runs: tables of blocks, curves, aggregate figures, greedy play."""

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
from ..runs.files import write_bytes
from . import plots
from .blocks import BLOCK
from .curves import draw_means, draw_raw
from .document import Document
from .group import Group
from .statistics import bootstrap, improvement_interval, iqm, mean_interval, profile


def write_csv(path: Path, head: Sequence[str], rows: Iterable[Sequence[Any]]) -> None:
    """A table as a file."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows(rows)
    write_bytes(path, text.getvalue().encode())


def with_interval(mean: float, half: float) -> str:
    """A mean and its 95 % interval as text."""
    return f"{mean:.0f}" if math.isnan(half) else f"{mean:.0f} ± {half:.0f}"


def blocks_table(groups: Sequence[Group], block: int) -> tuple[list[str], list[list[str]]]:
    """Head and rows: mean reward of each block of episodes, with its 95 % interval over seeds."""
    columns = [mean_interval(group.blocks(block)) for group in groups]
    longest = max(len(mean) for mean, _ in columns)
    rows = []
    for k in range(longest):
        cells = [with_interval(mean[k], half[k]) if k < len(mean) else "" for mean, half in columns]
        rows.append([f"{k * block} to {(k + 1) * block}", *cells])
    return ["episodes", *(group.name for group in groups)], rows


def blocks_csv(path: Path, groups: Sequence[Group], block: int) -> None:
    """Mean reward of each block, of every seed."""
    rows = (
        (group.name, run.config.seed, k * block, float(value))
        for group in groups
        for run, means in zip(group.runs, group.blocks(block))
        for k, value in enumerate(means)
    )
    write_csv(path, ("group", "seed", "first_episode", "mean_reward"), rows)


def draw_curves(path: Path, groups: Sequence[Group], block: int, paper: Mapping[str, Sequence[float]]) -> Path:
    """Raw curves of the first seeds, and the means of all groups.

    Args:
        path: of the picture.
        groups: whose curves are drawn.
        block: episodes of an average.
        paper: name -> means of its blocks, to be drawn beside ours.
    """
    made, axes = plots.figure(14.0, 4.2 * ((len(groups) + 2) // 2), (len(groups) + 2) // 2, 2)
    flat = list(axes.flat)
    for place, group in zip(flat, groups):
        draw_raw(place, group.rewards[0], f"{group.name}, seed {group.runs[0].config.seed}", block)
    last = flat[len(groups)]
    draw_means(last, {group.name: group.rewards for group in groups}, block)
    for style, (name, means) in zip(("--", ":", "-."), paper.items()):
        last.plot((np.arange(len(means)) + 1) * block, means, style, color="black", label=name)
    last.legend(loc="upper left")
    for unused in flat[len(groups) + 1 :]:
        unused.set_visible(False)
    return plots.save(made, path)


def draw_profile(path: Path, groups: Sequence[Group], block: int) -> Path:
    """Performance profiles: the share of runs whose last block is above each level."""
    scores = [group.last(block) for group in groups]
    levels = np.linspace(min(s.min() for s in scores) - 50.0, max(s.max() for s in scores) + 50.0, 400)
    made, axes = plots.figure(9.0, 4.5)
    for colour, group, score in zip(plots.COLOURS * 9, groups, scores):
        axes[0, 0].step(levels, profile(score, levels), color=colour, label=group.name, where="post")
    axes[0, 0].set(xlabel=f"mean reward of the last {block} episodes", ylabel="share of runs above", ylim=(-0.02, 1.02))
    axes[0, 0].grid(alpha=0.3)
    axes[0, 0].legend()
    return plots.save(made, path)


def aggregates(document: Document, folder: Path, groups: Sequence[Group], block: int) -> None:
    """Interquartile means, probabilities of improvement, performance profiles."""
    rows, table = [], []
    for group in groups:
        figures = {f"last {block} episodes": group.last(block), "all episodes": group.whole()}
        cells = [group.name, str(len(group.runs))]
        for name, scores in figures.items():
            value, low, high = bootstrap(scores[None], iqm)
            rows.append((group.name, "interquartile mean", name, value, low, high))
            cells.append(f"{value:.0f} ({low:.0f} .. {high:.0f})")
        table.append([*cells, f"{group.best:.0f}"])
    document.heading("Over all seeds")
    document.paragraph("Interquartile mean of the mean reward, with a 95 % bootstrap interval over seeds.")
    document.table(["", "seeds", f"last {block} episodes", "all episodes", "best episode"], table)
    if len(groups) > 1:
        pairs = []
        for a, b in combinations(groups, 2):
            value, low, high = improvement_interval(a.last(block), b.last(block))
            rows.append(
                (f"{a.name} > {b.name}", "probability of improvement", f"last {block} episodes", value, low, high)
            )
            pairs.append([f"{a.name} above {b.name}", f"{value:.2f} ({low:.2f} .. {high:.2f})"])
        document.paragraph(
            f"Probability that a seed of the one ends above a seed of the other (last {block} episodes), "
            "with a 95 % bootstrap interval."
        )
        document.table(["", "probability"], pairs)
    write_csv(folder / "aggregates.csv", ("of", "figure", "over", "value", "low", "high"), rows)
    document.picture(draw_profile(folder / "profile.png", groups, block), "performance profiles")


def greedy_play(document: Document, folder: Path, played: Mapping[str, Mapping[str, list[Evaluation]]]) -> None:
    """A table of greedy evaluations.

    Args:
        document: that it goes into.
        folder: for greedy.csv.
        played: group -> where -> an evaluation for each seed.
    """
    table, rows = [], []
    for name, places in played.items():
        for place, evaluations in places.items():
            rewards = [e.mean_reward for e in evaluations]
            crashes = [100.0 * e.crash_rate for e in evaluations]
            laps, rates = [e.mean_laps for e in evaluations], [100.0 * e.lap_rate for e in evaluations]
            count = len(evaluations[0].episodes)
            cells = [f"{np.mean(rewards):.0f}", f"{100 - np.mean(crashes):.0f} %", f"{np.mean(laps):.1f}"]
            cells = [cell.replace("nan", "-") for cell in cells]
            best = int(np.argmax([r - c for r, c in zip(rates, crashes)]))
            table.append([f"{name}, {place}", str(count), *cells, f"{rates[best]:.0f} %"])
            rows += [(name, place, k, *values) for k, values in enumerate(zip(rewards, crashes, laps, rates))]
    head = ("", "episodes a seed", "mean reward", "without a crash", "laps an episode", "laps and no crash, best seed")
    document.table(head, table)
    write_csv(
        folder / "greedy.csv", ("group", "starts", "run", "mean_reward", "crash_percent", "laps", "lap_percent"), rows
    )


def block_of(groups: Sequence[Group], block: int | None) -> int:
    """Episodes of a block: the paper's 200, fewer where runs are short."""
    shortest = min(group.rewards.shape[1] for group in groups)
    return block or min(BLOCK, max(shortest // 5, 1))
