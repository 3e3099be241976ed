# SPDX-License-Identifier: BSD-3-Clause
"""Writes a run's episode log and its checkpoints together, every few seconds and at the end."""

from __future__ import annotations

import time
from collections.abc import Callable

from .episodes import Episode
from .folder import RunFolder
from .watch import Watch

PERIOD_S = 5.0
"""Wall time between checkpoints [s]."""
_FIRST_S = 0.5
"""Wall time until the first checkpoint [s]."""
_REPORT_S = 0.1
"""Wall time between reports to ``watch`` [s]."""


class Keeper:
    """Collects episodes as they are done.

    Args:
        folder: folder of the run.
        watch: receives them.
        checkpoint: saves the model; called when it has learnt from all episodes collected so far.
    """

    def __init__(self, folder: RunFolder, watch: Watch, checkpoint: Callable[[], None]) -> None:
        self._folder, self._watch, self._checkpoint = folder, watch, checkpoint
        self._unwritten: list[Episode] = []
        self._unreported: list[Episode] = []
        self._reported_at = time.monotonic()
        self._saved = self._reported_at - PERIOD_S + _FIRST_S

    def take(self, row: Episode) -> None:
        """An episode is done."""
        self._unwritten.append(row)
        self._unreported.append(row)
        now = time.monotonic()
        if now - self._reported_at > _REPORT_S:
            self._report()
        if now - self._saved > PERIOD_S:
            self.save()

    def save(self) -> None:
        """Write new episodes to the log, then the checkpoint: a log may be ahead of its model, never behind."""
        if self._unreported:
            self._report()
        self._folder.episodes.append(self._unwritten)
        self._unwritten = []
        self._checkpoint()
        self._saved = time.monotonic()

    def _report(self) -> None:
        self._watch.on_progress(self._unreported)
        self._unreported = []
        self._reported_at = time.monotonic()
