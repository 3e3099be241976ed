# SPDX-License-Identifier: BSD-3-Clause
"""Writes a run's log and its checkpoints together, every few seconds and at the end."""

from __future__ import annotations

import time
from collections.abc import Callable

from .episodes import Episode
from .folder import RunFolder
from .watch import Watch

PERIOD_S = 5.0
"""Wall time between checkpoints."""
_FIRST_S = 0.5
"""Wall time until the first."""
_TOLD_S = 0.1


class Keeper:
    """Takes episodes as they are done.

    Args:
        folder: of the run.
        watch: told of them.
        checkpoint: saves the model, which then has learnt from all episodes taken so far.
    """

    def __init__(self, folder: RunFolder, watch: Watch, checkpoint: Callable[[], None]) -> None:
        self._folder, self._watch, self._checkpoint = folder, watch, checkpoint
        self._unwritten: list[Episode] = []
        self._untold: list[Episode] = []
        self._told = time.monotonic()
        self._saved = self._told - PERIOD_S + _FIRST_S

    def take(self, row: Episode) -> None:
        """An episode is done."""
        self._unwritten.append(row)
        self._untold.append(row)
        now = time.monotonic()
        if now - self._told > _TOLD_S:
            self._tell()
        if now - self._saved > PERIOD_S:
            self.save()

    def save(self) -> None:
        """Write what is not yet written. The log comes first: it may know more than the model, not less."""
        if self._untold:
            self._tell()
        self._folder.episodes.append(self._unwritten)
        self._unwritten = []
        self._checkpoint()
        self._saved = time.monotonic()

    def _tell(self) -> None:
        self._watch.told(self._untold)
        self._untold = []
        self._told = time.monotonic()
