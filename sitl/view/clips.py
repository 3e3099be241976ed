# SPDX-License-Identifier: BSD-3-Clause
"""Clips of something that goes on far faster than anybody can watch: now and then some consecutive moments are taken,
and played on a page at a speed that can be followed, while it goes on and nothing more is taken."""

from __future__ import annotations

import threading
import time
from collections.abc import Sequence
from typing import Any

from ..run.watched import FRAMES_A_SECOND
from .page import SHARE, Page

SPEEDS = ("1", "2", "5", "10", "50")
_UNSEEN_S = 0.2
"""Wall time between two looks whether somebody looks [s]."""


class Clips:
    """Plays clips on a page, in a thread of its own.

    Args:
        page: a widget for the speed is added to it.
        seconds: simulated time between two moments of a clip [s].
    """

    def __init__(self, page: Page, seconds: float) -> None:
        self._page, self._seconds = page, seconds
        self.is_wanted = False
        """Somebody looks, and the clip before is over: another one may be given."""
        self.played = 0
        """Clips, so far."""
        self._clip: Sequence[Any] = ()
        self._changed = threading.Condition()
        self._closed = False
        with page.tabs.add_tab("Clips"):
            self.speed = page.server.gui.add_dropdown("Speed", SPEEDS, initial_value="5", hint="times real time")
        self._thread = threading.Thread(target=self._run, name="sitl-view-clips", daemon=True)
        self._thread.start()

    def give(self, moments: Sequence[Any]) -> None:
        """Play what the page's source captured; called where it was."""
        with self._changed:
            self._clip, self.is_wanted = moments, False
            self._changed.notify_all()

    def close(self) -> None:
        """End the thread; the page stays."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()
        self._thread.join(timeout=5.0)

    def _pause(self, seconds: float) -> None:
        with self._changed:
            self._changed.wait_for(lambda: self._closed, timeout=seconds)

    def _run(self) -> None:
        while not self._closed:
            if not self._page.is_seen:
                self.is_wanted = False
                self._pause(_UNSEEN_S)
                continue
            with self._changed:
                if not self._clip:
                    self.is_wanted = True
                    self._changed.wait_for(lambda: self._closed or len(self._clip) > 0, timeout=_UNSEEN_S)
                clip, self._clip = self._clip, ()
            if clip:
                self._play(clip)
                self.played += 1

    def _play(self, clip: Sequence[Any]) -> None:
        at, last = 0.0, time.monotonic()
        shown = -1
        while not self._closed and self._page.is_seen:
            number = min(int(at), len(clip) - 1)
            spent = 0.0
            if number != shown:
                shown, spent = number, self._page.show_safely(clip[number], float(self.speed.value))
            if number == len(clip) - 1:
                return
            self._pause(max(1.0 / FRAMES_A_SECOND, spent / SHARE))
            now = time.monotonic()
            at, last = at + (now - last) * float(self.speed.value) / self._seconds, now
