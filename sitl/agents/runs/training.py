# SPDX-License-Identifier: BSD-3-Clause
"""Trains run folders, one or many, whatever their algorithm."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from .. import algorithms
from .episodes import Episode
from .folder import RunFolder
from .local import Stopped, Tell, Told, each
from .watch import Watch


def train_one(path: Path, tell: Tell, stopped: Stopped) -> bool:
    """Train the run in a folder; returns whether it is done, not interrupted."""
    folder = RunFolder(path)
    watch = Watch(tell, stopped)
    algorithms.load(folder.config.algorithm).train(folder, watch)
    return is_done(folder)


def train_all(
    paths: Sequence[Path],
    jobs: int = 1,
    told: Told = lambda index, rows: None,
    do: Callable[..., list[Any]] = each,
) -> bool:
    """Train several, each as a process of its own where ``jobs`` allows; returns whether all are done.

    Args:
        paths: of the run folders.
        jobs: how many at a time.
        told: number of a run, and its new episodes.
        do: does the work for all, as ``local.each``.
    """
    return all(do(train_one, list(paths), jobs, _once(told)))


def _once(told: Told) -> Told:
    """Told of each episode once, though a run that lost its worker goes through its last ones again."""
    newest: dict[int, int] = {}

    def tell(index: int, rows: Sequence[Episode]) -> None:
        new = [row for row in rows if row.episode > newest.get(index, -1)]
        if new:
            newest[index] = new[-1].episode
            told(index, new)

    return tell


def is_done(folder: RunFolder) -> bool:
    """Whether a run has reached its length."""
    config, rows = folder.config, folder.episodes.rows()
    if config.episodes is not None and len(rows) >= config.episodes:
        return True
    return config.steps is not None and sum(row.steps for row in rows) >= config.steps
