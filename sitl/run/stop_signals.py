# SPDX-License-Identifier: BSD-3-Clause
"""SIGINT and SIGTERM as a wish to end, which a serving loop looks at: logs are closed, nothing is cut off."""

from __future__ import annotations

import signal
from collections.abc import Callable
from types import FrameType, TracebackType
from typing import Any


class StopSignals:
    """A context in which signals, once they are caught, only ask for an end.

    Until ``catch`` they end the process as ever: nothing was begun that must be ended, and compiling may be broken
    off at once. A command catches them before it opens or says anything that another program may wait for: whoever
    reads that line may send the signal at once.

    Args:
        names: of the signals; those that this system does not have are left out.
        then: called at each signal, after it was written down.
    """

    def __init__(self, *names: str, then: Callable[[], None] = lambda: None) -> None:
        self.received: list[str] = []
        """Names of the signals that came, in order."""
        self._names, self._then = names or ("SIGINT", "SIGTERM"), then
        self._before: dict[int, Any] = {}

    def catch(self) -> None:
        """From now on signals are written down; the same again changes nothing."""
        for name in self._names:
            number = getattr(signal, name, None)
            if number is not None and number not in self._before:
                self._before[number] = signal.signal(number, self._write_down)

    def go_on(self) -> bool:
        """Whether no signal came yet."""
        return not self.received

    def _write_down(self, number: int, _: FrameType | None) -> None:
        self.received.append(signal.Signals(number).name)
        self._then()

    def __enter__(self) -> StopSignals:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None):
        for number, before in self._before.items():
            signal.signal(number, before)
        self._before.clear()
