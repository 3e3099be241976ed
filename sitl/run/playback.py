# SPDX-License-Identifier: BSD-3-Clause
"""Plays something that has a length, at any speed of the wall clock, in a thread of its own."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

FRAMES_A_SECOND = 30


class Player:
    """Shows one moment after another.

    Args:
        length: end of what is played [s].
        show: shows a moment [s]; called by this thread while it plays, by ``go_to`` otherwise.
        clock: gives the wall time [s].
        begin: of what is played [s].
    """

    def __init__(
        self,
        length: float,
        show: Callable[[float], None],
        clock: Callable[[], float] = time.monotonic,
        begin: float = 0.0,
    ) -> None:
        self.length, self._show, self._clock, self._begin = length, show, clock, begin
        self.time = begin
        """The moment that is shown [s]."""
        self.speed = 1.0
        """Seconds of what is played a second of wall time."""
        self.is_playing = False
        self._changed = threading.Condition()
        self._closed = False
        self._last = clock()
        self._thread = threading.Thread(target=self._run, name="sitl-playback", daemon=True)
        self._thread.start()

    def play(self) -> None:
        """Go on from here; from the beginning when it is at its end."""
        with self._changed:
            if self.time >= self.length:
                self.time = self._begin
            self.is_playing, self._last = True, self._clock()
            self._changed.notify()

    def stop(self) -> None:
        """Stay here."""
        with self._changed:
            self.is_playing = False

    def go_to(self, moment: float) -> None:
        """Show a moment [s] between begin and end, and go on from there if it plays."""
        with self._changed:
            self.time, self._last = min(max(moment, self._begin), self.length), self._clock()
            self._show(self.time)

    def advance(self) -> None:
        """Show what is due by the wall clock; the end stops it."""
        with self._changed:
            now = self._clock()
            if self.is_playing:
                self.time = min(self.time + (now - self._last) * self.speed, self.length)
                self.is_playing = self.time < self.length
                self._show(self.time)
            self._last = now

    def close(self) -> None:
        """End the thread."""
        with self._changed:
            self._closed = True
            self._changed.notify()
        self._thread.join(timeout=5.0)

    def _run(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._closed or self.is_playing)
                if self._closed:
                    return
            self.advance()
            with self._changed:
                self._changed.wait_for(lambda: self._closed, timeout=1.0 / FRAMES_A_SECOND)
