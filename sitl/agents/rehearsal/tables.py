# SPDX-License-Identifier: BSD-3-Clause
"""The figures of a rehearsal as CSV files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ..report.sections import write_csv
from .rehearse import Rehearsed, Tried

CHANGES = (
    "section", "run", "change", "group", "mean_reward", "share", "low", "high", "crash_share", "false_alarm_share",
    "above_first", "above_first_low", "above_first_high", "seen", "refused",
)  # fmt: skip
EPISODES = ("section", "run", "run_seed", "change", "seed", "episode", "reward", "crashed", "false_alarm")


def write_changes(path: Path, sections: Mapping[str, Sequence[Rehearsed]]) -> None:
    """A row for each run and change, and one for each run at home. The first run is not held against itself.

    Raises:
        AgentError: it cannot be written.
    """
    rows: list[Sequence[Any]] = []
    for title, rehearsed in sections.items():
        for one in rehearsed:
            rows.append((title, one.name, "home", "", one.home.mean, 1.0, 1.0, 1.0, *_parts(one.home), *4 * [""], ""))
            advantages = [None] * len(one.changes) if one is rehearsed[0] else one.advantages(rehearsed[0])
            for change, tried, share, above in zip(one.changes, one.tried, one.transfer_ratios(), advantages):
                figures: Sequence[Any] = ("",) * 6 if share is None else (tried.mean, *share, *_parts(tried))
                last = (*(above or ("", "", "")), int(tried.seen), tried.refused)
                rows.append((title, one.name, change.name, change.group, *figures, *last))
    write_csv(path, CHANGES, rows)


def write_episodes(path: Path, sections: Mapping[str, Sequence[Rehearsed]], seed: int) -> None:
    """A row for each episode.

    Args:
        path: path of the file.
        sections: title -> runs.
        seed: seed that the episodes were played with.

    Raises:
        AgentError: it cannot be written.
    """
    rows = (
        (title, one.name, run.config.seed, name, seed, episode, float(reward), int(crash), int(false))
        for title, rehearsed in sections.items()
        for one in rehearsed
        for name, tried in [("home", one.home), *zip([change.name for change in one.changes], one.tried)]
        for run, *figures in zip(one.runs, tried.rewards, tried.crashed, tried.false_alarms)
        for episode, (reward, crash, false) in enumerate(zip(*figures))
    )
    write_csv(path, EPISODES, rows)


def _parts(tried: Tried) -> tuple[float, float]:
    """Fractions of the episodes that ended in a crash, and in a false one."""
    return float(tried.crashed.mean()), float(tried.false_alarms.mean())
