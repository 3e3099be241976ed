# SPDX-License-Identifier: BSD-3-Clause
"""The ways in which a process ends while vehicles are under its command: each goes through the hand-over.

Signals that would end or stop the process raise instead, once: what comes after the first one is noted, so that no
hand-over is broken off. The handlers are there only while a vehicle is under command, and call those that were there
before. SIGKILL and SIGSTOP cannot be caught, nor can a crash of compiled code (SIGSEGV, SIGBUS, SIGILL, SIGFPE).
"""

from __future__ import annotations

import atexit
import contextlib
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from types import FrameType
from typing import Any

_LEFT_ALONE = ("SIGKILL", "SIGSTOP", "SIGSEGV", "SIGBUS", "SIGILL", "SIGFPE", "SIGTRAP", "SIGSYS", "SIGCHLD", "SIGCLD",
               "SIGCONT", "SIGURG", "SIGWINCH", "SIGINFO", "SIGEMT", "SIGXFSZ")  # fmt: skip
"""Signals that cannot be caught, come from a fault, or end nothing."""
_IGNORED = ("SIGPIPE", "SIGTTIN", "SIGTTOU")
"""Signals that would end or stop a process which reads or writes: while these are ignored, that is an OSError."""
_LEAVING_S = 30.0
"""Wall time for which a process that was told to end hears no second signal [s]: longer than a hand-over."""


def _numbers(names: tuple[str, ...]) -> set[int]:
    return {int(getattr(signal, name)) for name in names if hasattr(signal, name)}


class Endings:
    """The end of this process, as long as vehicles are under its command. There is one for all of them."""

    def __init__(self) -> None:
        self._owed: dict[object, Callable[[], object]] = {}
        """Who commands a vehicle, and what hands it over."""
        self._before: dict[int, Any] = {}
        """Handlers that were there before; kept for who puts ours back later."""
        self._installed: set[int] = set()
        self._noted: list[int] = []
        self._quiet = 0
        """Number of hand-overs in progress."""
        self._one_by_one = threading.RLock()
        self._number, self._left = 0, -float("inf")
        """The signal that told the process to end, and when [s]."""

    def owe(self, who: object, settle: Callable[[], object]) -> bool:
        """A vehicle is under command from now on, until ``forget``; ``settle`` hands it over.

        Returns whether signals are caught. Outside of the main thread, which alone may catch them, only the end of the
        interpreter is watched.
        """
        self._owed[who] = settle
        left_alone, ignored = _numbers(_LEFT_ALONE), _numbers(_IGNORED)
        for number in sorted(signal.valid_signals() - left_alone - self._installed):
            before = signal.getsignal(number)
            is_default = before == signal.SIG_DFL
            if not (is_default or (callable(before) and number not in ignored)):
                continue  # ignored already, or not Python's
            if before != self._on_signal:
                self._before[number] = before
            with contextlib.suppress(ValueError, OSError):
                signal.signal(number, signal.SIG_IGN if number in ignored else self._on_signal)
                self._installed.add(number)
        return bool(self._installed)

    def owes(self, who: object) -> bool:
        """Whether a vehicle is under the command of ``who``; never in a copy of the process (``os.fork``)."""
        return who in self._owed

    def forget(self, who: object) -> None:
        """The vehicle is not under command any more. With the last one all handlers are as they were before."""
        self._owed.pop(who, None)
        if not self._owed:
            self._number, self._left = 0, -float("inf")
            self._restore()

    @property
    def signal(self) -> str:
        """Name of the signal that told the process to end; "": none did."""
        with contextlib.suppress(ValueError):
            return signal.Signals(self._number).name if self._number else ""
        return f"signal {self._number}"

    @contextlib.contextmanager
    def undisturbed(self) -> Iterator[None]:
        """For a hand-over: one at a time, and signals are noted meanwhile. The first of them ends the process
        afterwards, unless it is ending already."""
        was_ending = sys.exc_info()[0] is not None or self._number != 0
        self._quiet += 1
        try:
            with self._one_by_one:
                yield
        finally:
            self._quiet -= 1
        if self._noted and not self._quiet:
            noted, self._noted = self._noted[0], []
            if not was_ending:
                before = signal.getsignal(noted)
                self._leave(noted, self._before.get(noted) if before == self._on_signal else before, None)

    def settle_all(self) -> None:
        """The process ends: all vehicles are handed over."""
        for settle in list(self._owed.values()):
            with contextlib.suppress(Exception):
                settle()

    def forked(self) -> None:
        """This is a copy of the process that commands the vehicles: it commands none."""
        self._owed.clear()
        self._quiet, self._number, self._noted, self._one_by_one = 0, 0, [], threading.RLock()
        self._restore()

    def _restore(self) -> None:
        for number in sorted(self._installed):
            with contextlib.suppress(ValueError, OSError):
                if signal.getsignal(number) in (self._on_signal, signal.SIG_IGN):
                    signal.signal(number, self._before[number])
                self._installed.discard(number)

    def _on_signal(self, number: int, frame: FrameType | None) -> None:
        before = self._before.get(number, signal.SIG_DFL)
        if not self._owed:  # somebody has put this handler back
            signal.signal(number, before)
            signal.raise_signal(number)
        elif time.monotonic() - self._left < _LEAVING_S:
            return  # it is ending already
        elif self._quiet:
            self._noted.append(number)
        else:
            try:
                self._leave(number, before, frame)
            except BaseException:
                self._number, self._left = number, time.monotonic()
                raise

    @staticmethod
    def _leave(number: int, before: Any, frame: FrameType | None) -> None:
        if callable(before):
            before(number, frame)
        else:
            raise SystemExit(128 + number)


ENDINGS = Endings()
atexit.register(ENDINGS.settle_all)
# Before the interpreter waits for threads that may never end, where that can be had: ``atexit`` comes after it.
getattr(threading, "_register_atexit", lambda call: None)(ENDINGS.settle_all)
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=ENDINGS.forked)
