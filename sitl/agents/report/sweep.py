# SPDX-License-Identifier: BSD-3-Clause
"""The table of a sweep: how well each combination had learnt by its end."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ..runs.sweep import Sweep
from .group import Group
from .sections import block_of, with_interval, write_csv
from .statistics import mean_interval

CSV = "sweep.csv"


def write_table(sweep: Sweep) -> tuple[Path, str]:
    """Write sweep.csv: a row a combination, best first.

    The mean reward of its last block of episodes, over seeds, with the half-width of its 95 % interval (Student's).

    Returns:
        path of the file, and the same table for people.
    """
    groups = [Group(name, runs) for name, runs in sweep.groups().items() if all(run.episodes.rows() for run in runs)]
    if not groups:
        return sweep.path / CSV, "no combination has episodes yet"
    block = block_of(groups, None)
    rows = []
    for group in groups:
        mean, half = (float(one) for one in mean_interval(group.last(block)))
        rows.append((group, mean, half))
    rows.sort(key=lambda row: -row[1])
    values = [[_text(sweep.combinations[group.name][name]) for name in sweep.names] for group, _, _ in rows]
    head = [*sweep.names, "seeds", "episodes", "block", "mean_reward", "half_interval", "best_episode", "folder"]
    table = [
        [*words, len(group.runs), group.rewards.shape[1], block, mean, half, group.best, group.name]
        for words, (group, mean, half) in zip(values, rows)
    ]
    write_csv(sweep.path / CSV, head, table)
    shown = [
        [*words, str(len(group.runs)), with_interval(mean, half), f"{group.best:.0f}"]
        for words, (group, mean, half) in zip(values, rows)
    ]
    return sweep.path / CSV, _aligned([*sweep.names, "seeds", f"last {block} episodes", "best episode"], shown)


def _aligned(head: list[str], rows: list[list[str]]) -> str:
    widths = [max(map(len, column)) for column in zip(head, *rows)]
    lines = ("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in [head, *rows])
    return "\n".join(lines)


def _text(value: Any) -> str:
    return value if isinstance(value, str) else json.dumps(value)
