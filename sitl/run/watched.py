# SPDX-License-Identifier: BSD-3-Clause
"""A run that somebody watches: what is shown and asked for is looked at between two advances, never waited for."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Protocol

FRAMES_A_SECOND = 30
"""Of wall time: more are not offered."""
_UNSEEN_S = 0.5
"""Wall time between two frames while nobody looks [s]."""
_MEASURED_S = 0.5
"""Wall time over which the speed of time is measured [s]."""


class Viewer(Protocol):
    """What shows a vehicle, and takes orders from who looks."""

    @property
    def is_seen(self) -> bool:
        """Somebody looks."""
        ...

    @property
    def is_free(self) -> bool:
        """It has drawn what it was given, and can take another frame."""
        ...

    def attend(self) -> None:
        """Do what users have asked for since the last call."""
        ...

    def capture(self, factor: float) -> None:
        """Take a frame; ``factor``: simulated time by wall time."""
        ...


class Watched:
    """Called after each slice of a run: gives a viewer frames when it is free, at most 30 a second.

    Args:
        viewer: what shows them.
        time_us: gives the simulated time [us].
        then: called besides.
        clock: gives the wall time [s].
    """

    def __init__(
        self,
        viewer: Viewer,
        time_us: Callable[[], int],
        then: Callable[[], None] = lambda: None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._viewer, self._time_us, self._then, self._clock = viewer, time_us, then, clock
        self._due = self._since = clock()
        self._since_us = time_us()
        self._factor = 0.0

    def __call__(self) -> None:
        """Serve the viewer."""
        self._then()
        self._viewer.attend()
        now = self._clock()
        if now >= self._due and self._viewer.is_free:
            self._due = now + (1.0 / FRAMES_A_SECOND if self._viewer.is_seen else _UNSEEN_S)
            self._viewer.capture(self._measure(now))

    def _measure(self, now: float) -> float:
        """Simulated time by wall time of late."""
        if now - self._since >= _MEASURED_S:
            time_us = self._time_us()
            self._factor = (time_us - self._since_us) * 1e-6 / (now - self._since)
            self._since, self._since_us = now, time_us
        return self._factor
