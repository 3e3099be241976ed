# SPDX-License-Identifier: BSD-3-Clause
"""The log of a run's episodes: a CSV file that grows as the run goes on."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..errors import AgentError
from .files import write_bytes


class Episode(NamedTuple):
    """A row of the log. All columns but the last repeat exactly when the run is repeated."""

    episode: int
    """Number of the episode, from 0."""
    steps: int
    reward: float
    """Sum of the rewards."""
    epsilon: float
    """Probability of exploring; nan for algorithms that have none."""
    terminated: int
    """1: the episode ended by itself (a crash, in the paper's environments); 0: at the limit of steps."""
    simulated_s: float
    """Simulated time that it took [s]."""
    wall_s: float
    """Wall time that it took, with the check of the table after it [s]."""


_KINDS = (int, int, float, float, int, float, float)


class EpisodeLog:
    """A CSV file with a row an episode."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def append(self, rows: Iterable[Episode]) -> None:
        """Add rows at the end.

        Raises:
            AgentError: the file cannot be written.
        """
        text = "".join(_line(row) for row in rows)
        try:
            with open(self.path, "a", encoding="utf-8") as file:
                if file.tell() == 0:
                    file.write(",".join(Episode._fields) + "\n")
                file.write(text)
        except OSError as error:
            raise AgentError(f"{self.path} cannot be written: {error.strerror}") from None

    def keep(self, count: int) -> None:
        """Keep only the first ``count`` rows, those of the last checkpoint.

        Raises:
            AgentError: there are fewer.
        """
        rows = self.rows()
        if len(rows) < count:
            raise AgentError(f"{self.path} has {len(rows)} episodes; the model beside it has learnt from {count}")
        text = ",".join(Episode._fields) + "\n" + "".join(_line(row) for row in rows[:count])
        write_bytes(self.path, text.encode())

    def rows(self) -> list[Episode]:
        """All complete rows.

        Raises:
            AgentError: it is no such file.
        """
        try:
            text = self.path.read_text(encoding="utf-8")
        except FileNotFoundError:
            return []
        except (OSError, ValueError) as error:
            raise AgentError(f"{self.path} cannot be read: {error}") from None
        whole, _, _ = text.rpartition("\n")  # a row may be half written
        lines = list(csv.reader(whole.splitlines()))
        if lines and tuple(lines[0]) != Episode._fields:
            raise AgentError(f"{self.path} is no log of episodes: its columns are {', '.join(lines[0])}")
        try:
            return [Episode(*(kind(word) for kind, word in zip(_KINDS, line, strict=True))) for line in lines[1:]]
        except ValueError as error:
            raise AgentError(f"{self.path} is damaged: {error}") from None

    def column(self, name: str) -> npt.NDArray[np.float64]:
        """One column over all episodes, shape (episodes,)."""
        return np.array([getattr(row, name) for row in self.rows()], np.float64)


def _line(row: Episode) -> str:
    return ",".join([*(repr(value) for value in row[:-1]), f"{row.wall_s:.6f}"]) + "\n"
