# SPDX-License-Identifier: BSD-3-Clause
"""Trains run folders, one or many, whatever their algorithm."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from .. import algorithms
from .folder import RunFolder
from .local import Stopped, Tell, Told, each
from .watch import Watch


def train_one(path: Path, tell: Tell, stopped: Stopped) -> bool:
    """Train the run in a folder; returns whether it is done, not interrupted."""
    folder = RunFolder(path)
    watch = Watch(tell, stopped)
    algorithms.load(folder.config.algorithm).train(folder, watch)
    return is_done(folder)


def train_all(paths: Sequence[Path], jobs: int = 1, told: Told = lambda index, rows: None) -> bool:
    """Train several, each as a process of its own where ``jobs`` allows; returns whether all are done.

    Args:
        paths: of the run folders.
        jobs: how many processes.
        told: number of a run, and its new episodes.
    """
    return all(each(train_one, list(paths), jobs, told))


def is_done(folder: RunFolder) -> bool:
    """Whether a run has reached its length."""
    config, rows = folder.config, folder.episodes.rows()
    if config.episodes is not None and len(rows) >= config.episodes:
        return True
    return config.steps is not None and sum(row.steps for row in rows) >= config.steps
