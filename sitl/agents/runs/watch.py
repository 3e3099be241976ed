# SPDX-License-Identifier: BSD-3-Clause
"""What a trainer tells of its progress, and how it is asked to stop."""

from __future__ import annotations

import signal
from collections.abc import Callable
from types import FrameType, TracebackType
from typing import Any

from .episodes import Episode

Told = Callable[[list[Episode]], None]


class Watch:
    """Told of episodes as they are done; knows whether to stop.

    Args:
        told: called with new episodes.
        stopped: whether the run shall end here, to go on another time.
    """

    def __init__(self, told: Told = lambda rows: None, stopped: Callable[[], bool] = lambda: False) -> None:
        self.told, self._stopped = told, stopped

    @property
    def stop(self) -> bool:
        """Asked between episodes: finish what must be finished, save, return."""
        return self._stopped()


class Interrupts:
    """While it lasts, a first SIGINT or SIGTERM sets ``asked``; a second SIGINT interrupts at once.

    Call it to learn whether to stop. Outside of the main thread, where signals cannot be caught, it is never set.
    """

    def __init__(self) -> None:
        self.asked = False
        self._before: dict[int, Any] = {}

    def __call__(self) -> bool:
        return self.asked

    def _ask(self, number: int, frame: FrameType | None) -> None:
        if self.asked and number == signal.SIGINT:
            raise KeyboardInterrupt
        self.asked = True

    def __enter__(self) -> Interrupts:
        try:
            for number in (signal.SIGINT, signal.SIGTERM):
                self._before[number] = signal.signal(number, self._ask)
        except ValueError:  # another thread's business
            pass
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None):
        for number, before in self._before.items():
            signal.signal(number, before)
