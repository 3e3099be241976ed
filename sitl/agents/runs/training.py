# SPDX-License-Identifier: BSD-3-Clause
"""Trains one or many run folders, with any algorithm."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from .. import algorithms
from .episodes import Episode
from .folder import ENOUGH, RunFolder
from .local import OnProgress, SendProgress, Stopped, each
from .watch import Shows, Watch


def train_one(path: Path, send_progress: SendProgress, stopped: Stopped, shows: Shows | None = None) -> bool:
    """Train the run in a folder; returns True when it is complete, False when it was interrupted.

    Args:
        path: the folder.
        send_progress, stopped, shows: see ``Watch``.
    """
    folder = RunFolder(path)
    watch = Watch(send_progress, stopped) if shows is None else Watch(send_progress, stopped, shows)
    algorithms.load(folder.config.algorithm).train(folder, watch)
    return is_done(folder)


def train_all(
    paths: Sequence[Path],
    jobs: int = 1,
    on_progress: OnProgress = lambda index, rows: None,
    do: Callable[..., list[Any]] = each,
    shows: Shows | None = None,
) -> bool:
    """Train several runs, ``jobs`` at a time in processes of their own; returns whether all are complete.

    Args:
        paths: run folders.
        jobs: number of runs at a time.
        on_progress: called with the index of a run and its new episodes.
        do: runs the work, as ``local.each`` does.
        shows: see ``Watch``; of one run at a time, in this process.
    """
    work = train_one if shows is None else partial(train_one, shows=shows)
    return all(do(work, list(paths), jobs, _without_repeats(on_progress)))


def _without_repeats(on_progress: OnProgress) -> OnProgress:
    """Report each episode once, although a run that lost its worker repeats its last ones."""
    newest: dict[int, int] = {}

    def report(index: int, rows: Sequence[Episode]) -> None:
        new = [row for row in rows if row.episode > newest.get(index, -1)]
        if new:
            newest[index] = new[-1].episode
            on_progress(index, new)

    return report


def is_done(folder: RunFolder) -> bool:
    """Whether a run has reached its length, or has ended before, because it had learnt enough."""
    if (folder.path / ENOUGH).exists():
        return True
    config, rows = folder.config, folder.episodes.rows()
    if config.episodes is not None and len(rows) >= config.episodes:
        return True
    return config.steps is not None and sum(row.steps for row in rows) >= config.steps
