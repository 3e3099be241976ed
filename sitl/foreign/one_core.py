# SPDX-License-Identifier: BSD-3-Clause
"""One processor core for two processes that take turns, such as our physics and the autopilot that waits for it.

In lockstep only one of them has anything to do at a time. Where they are on two cores, each hand-over wakes a core that
sleeps, which takes longer than the work; on one core the kernel just goes on with the other process.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import sys
from collections.abc import Callable, Iterable
from types import TracebackType

_Set = Callable[[int, Iterable[int]], None]
_Get = Callable[[int], set[int]]


def _current_core() -> Callable[[], int] | None:
    """What tells the core that the calling thread is on; None where the platform does not say."""
    if not sys.platform.startswith("linux"):
        return None
    return getattr(ctypes.CDLL(None), "sched_getcpu", None)


_current = _current_core()
_set: _Set | None = getattr(os, "sched_setaffinity", None)
_get: _Get | None = getattr(os, "sched_getaffinity", None)
IS_OFFERED = not (_current is None or _set is None or _get is None)
"""Whether this platform lets a process choose its cores."""


class OneCore:
    """A context in which the calling thread and another process share the core that the thread is on.

    The thread has the cores that it had before as soon as the context ends, so that threads and processes that are
    started outside of it get them, too, and the kernel may move it between two contexts. The other process stays where
    it is until the next one. Where the platform does not offer this, or the other process has ended, nothing happens.

    Args:
        pid: of the other process; None: there is none, and nothing happens.
    """

    def __init__(self, pid: int | None) -> None:
        self._pid = pid if IS_OFFERED else None
        self._before: set[int] = set()
        self._core = -1

    def __enter__(self) -> OneCore:
        if self._pid is None or _set is None or _get is None or _current is None:
            return self
        core = _current()
        with contextlib.suppress(OSError):
            if core != self._core:
                _set(self._pid, (core,))
                self._core = core
            before = _get(0)
            _set(0, (core,))
            self._before = before
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        before, self._before = self._before, set()
        if before and _set is not None:
            with contextlib.suppress(OSError):  # cores may have been taken from the machine meanwhile
                _set(0, before)
