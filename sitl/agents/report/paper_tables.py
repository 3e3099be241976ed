# SPDX-License-Identifier: BSD-3-Clause
"""Tables of the published results, and titles of its figures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .document import BLOCK, Document, block_names
from .group import Group
from .sections import with_interval, write_csv
from .statistics import mean_interval

ENVIRONMENT = "GazeboCircuit2TurtlebotLIDAR-v0"
TITLES = {"qlearn": "Q-learning", "sarsa": "Sarsa"}
MEAN_REWARDS = {
    "qlearn": (-114, -79, 72, 212, 239, 282, 243, 439, 676, 503, 510, 345, 776, 805, 685),
    "sarsa": (-124, -98, -75, -43, -43, -6, 55, 65, 104, 127, 361, 164, 698, 550, 240),
}
"""Mean reward of each block of 200 episodes."""
BEST_EPISODE = {"qlearn": 2500, "sarsa": 3500}
"""Best episode, read off the paper's curves (approximate)."""
REAL_TIME_FACTOR = 60
"""Real-time factor without a window on an i7-6700 (approximate)."""


Groups = Mapping[tuple[str, str], Group]
"""(algorithm, variant) -> runs, all of the same length."""


def beside_paper(document: Document, groups: Groups, folder: Path) -> None:
    """The paper's table, with ours beside it; paper.csv has the same in numbers."""
    count = max(group.rewards.shape[1] for group in groups.values())
    names = block_names(count)
    head, shown = ["episodes"], [[name] for name in [*names, "best episode"]]
    csv_head, numbers = ["episodes"], [[name] for name in [*names, "best episode"]]

    def add(title: str, texts: Sequence[str], values: Sequence[Any]) -> None:
        head.append(title)
        for row, text in zip(shown, texts):
            row.append(text)
        csv_head.append(title)
        for row, value in zip(numbers, values):
            row.append(value)

    for algorithm, title in TITLES.items():
        means, best = list(MEAN_REWARDS[algorithm]), BEST_EPISODE[algorithm]
        theirs = [means[k] if k < len(means) else "" for k in range(len(names))]
        texts = ["" if mean == "" else f"{mean}{_ends(k, count)}" for k, mean in enumerate(theirs)]
        whole = ["" if _ends(k, count) else mean for k, mean in enumerate(theirs)]
        add(f"{title}, paper", [*texts, f"about {best}"], [*whole, best])
        for variant in [v for a, v in groups if a == algorithm]:
            group = groups[algorithm, variant]
            ours, halves = mean_interval(group.blocks())
            texts = [with_interval(mean, half) for mean, half in zip(ours, halves)]
            add(f"{title}, {variant}", [*texts, f"{group.best:.0f}"], [*ours.tolist(), group.best])
            csv_head.append(f"{title}, {variant}, half of the interval")
            for row, value in zip(numbers, [*halves.tolist(), ""]):
                row.append(value)
    document.table(head, shown)
    write_csv(folder / "paper.csv", csv_head, numbers)


def _ends(k: int, episodes: int) -> str:
    """End of the paper's block when ours is shorter."""
    end = (k + 1) * BLOCK
    return "" if end <= episodes else f" (to {end})"


def shortfalls(groups: Groups) -> list[str]:
    """Blocks in which our mean is below the paper's, and whether by more than the seeds' spread; whole blocks only."""
    points = []
    for (algorithm, variant), group in groups.items():
        count = min(group.rewards.shape[1] // BLOCK, len(MEAN_REWARDS[algorithm]))
        if count == 0:
            continue
        blocks, theirs = group.blocks()[:, :count], np.array(MEAN_REWARDS[algorithm][:count])
        ours = blocks.mean(axis=0)
        below = [k for k in range(count) if ours[k] < theirs[k]]
        text = (
            f"{TITLES[algorithm]}, {variant}: at or above the paper's mean in {count - len(below)} of {count} intervals"
        )
        far = below
        if len(blocks) > 1:
            spread = blocks.std(axis=0, ddof=1)
            far = [k for k in below if ours[k] + spread[k] < theirs[k]]
            if below:
                text += f", below it but within a standard deviation of the seeds in {len(below) - len(far)}"
                text += f", further below in {len(far)}"
        elif below:
            text += f", below it in {len(below)}"
        if far:
            text += " (" + ", ".join(f"{k * BLOCK} to {(k + 1) * BLOCK}" for k in far) + ")"
        points.append(text + ".")
    return points


def changes(document: Document, groups: Sequence[Group], extra: Sequence[Group]) -> None:
    """Add a table of the block means of all groups, a row each."""
    columns = [(group.name, group.blocks().mean(axis=0)) for group in [*groups, *extra]]
    count = max(len(means) for _, means in columns)
    head = ["from episode", *(f"{k * BLOCK}" for k in range(count))]
    document.table(head, [[name, *(f"{mean:.0f}" for mean in means)] for name, means in columns])


def times(document: Document, groups: Sequence[Group]) -> None:
    """Add a table of the simulated and wall time of a run."""
    document.heading("Time")
    rows = []
    for group in groups:
        simulated, wall = group.simulated_s.mean(), group.wall_s.mean()
        there = simulated / REAL_TIME_FACTOR / 3600.0
        rows.append(
            [group.name, f"{simulated / 3600.0:.1f} h", f"{wall:.1f} s", f"{simulated / wall:,.0f}", f"{there:.1f} h"]
        )
    document.paragraph(
        "Of a run, mean over seeds. Wall time has the greedy checks in it, simulated time has only the episodes that "
        f"were learnt from. The paper's simulation ran at about {REAL_TIME_FACTOR} times real time."
    )
    document.table(["", "simulated", "wall time", "times real time", f"at {REAL_TIME_FACTOR} times"], rows)
