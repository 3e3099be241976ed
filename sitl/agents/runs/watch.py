# SPDX-License-Identifier: BSD-3-Clause
"""How a trainer reports its progress, and how it is asked to stop."""

from __future__ import annotations

import signal
from collections.abc import Callable
from types import FrameType, TracebackType
from typing import Any

from .episodes import Episode

OnProgress = Callable[[list[Episode]], None]
Shows = Callable[[Any], Callable[[], bool]]


def _never() -> bool:
    return False


class Watch:
    """Receives episodes as they are done; says whether to stop.

    Args:
        on_progress: called with new episodes.
        stopped: whether the run shall pause here, to be resumed later.
        shows: is given the environment that is learnt in, to show it; gives what says whether the next episode should
            be made step by step for that.
    """

    def __init__(
        self,
        on_progress: OnProgress = lambda rows: None,
        stopped: Callable[[], bool] = lambda: False,
        shows: Shows = lambda env: _never,
    ) -> None:
        self.on_progress, self._stopped, self.shows = on_progress, stopped, shows

    @property
    def stop(self) -> bool:
        """Whether to save and return; trainers check it between episodes."""
        return self._stopped()


class Interrupts:
    """A context in which the first SIGINT or SIGTERM only requests a stop; a second SIGINT raises KeyboardInterrupt.

    Calling it returns whether a stop was requested. Outside of the main thread, which cannot catch signals, it never
    is.
    """

    def __init__(self) -> None:
        self.requested = False
        self._before: dict[int, Any] = {}

    def __call__(self) -> bool:
        return self.requested

    def _ask(self, number: int, frame: FrameType | None) -> None:
        if self.requested and number == signal.SIGINT:
            raise KeyboardInterrupt
        self.requested = True

    def __enter__(self) -> Interrupts:
        try:
            for number in (signal.SIGINT, signal.SIGTERM):
                self._before[number] = signal.signal(number, self._ask)
        except ValueError:  # not the main thread
            pass
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None):
        for number, before in self._before.items():
            signal.signal(number, before)
