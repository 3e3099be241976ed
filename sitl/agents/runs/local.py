# SPDX-License-Identifier: BSD-3-Clause
"""One function applied to many items, in this process or in several processes of this machine."""

from __future__ import annotations

import multiprocessing
import pickle
import signal
import time
import traceback
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from functools import partial
from typing import Any

from . import cores
from .watch import Interrupts

SendProgress = Callable[[Any], None]
Stopped = Callable[[], bool]
Work = Callable[[Any, SendProgress, Stopped], Any]
"""``work(item, send_progress, stopped)`` reports its progress, returns early when ``stopped()``, returns a result."""
OnProgress = Callable[[int, Any], None]
"""Called with the index of an item and a message that its work sent."""
_POLL_S, _GRACE_S = 0.1, 2.0
"""Wall time between two checks for messages and interrupts; time that processes have to end by themselves [s]."""
_messages: Any
_stop: Any
"""Set in each process of the pool: the queue of (index of an item, message), and the event that requests a stop."""


def each(
    work: Work, items: Sequence[Any], jobs: int = 1, on_progress: OnProgress = lambda index, message: None
) -> list[Any]:
    """Call ``work`` for each item; returns the results in order, None for items not started before an interrupt.

    Args:
        work: a module-level function, so that other processes can import it.
        items: picklable arguments of ``work``.
        jobs: number of processes; 1: this process.
        on_progress: see ``OnProgress``.

    Raises:
        Exception: what ``work`` raised for an item; the other items are stopped.
        RuntimeError: a process died.
    """
    with Interrupts() as interrupted:
        if min(jobs, len(items)) <= 1:
            results: list[Any] = [None] * len(items)
            for index, item in enumerate(items):
                if not interrupted():
                    results[index] = work(item, partial(on_progress, index), interrupted)
            return results
        return _in_processes(work, items, min(jobs, len(items)), on_progress, interrupted)


def _in_processes(
    work: Work, items: Sequence[Any], jobs: int, on_progress: OnProgress, interrupted: Interrupts
) -> list[Any]:
    context = multiprocessing.get_context("spawn")
    messages, stop = context.SimpleQueue(), context.Event()
    others = set(multiprocessing.active_children())
    pool = ProcessPoolExecutor(jobs, context, _initialise, (messages, stop, jobs))
    futures: list[Future[Any]] = []
    try:
        futures += [pool.submit(_run, work, index, item) for index, item in enumerate(items)]
        running = set(futures)
        while running:
            finished, running = wait(running, _POLL_S, FIRST_COMPLETED)
            while not messages.empty():
                on_progress(*messages.get())
            for future in finished:
                future.result()
            if interrupted():
                stop.set()
        return [future.result() for future in futures]
    except BrokenProcessPool:
        if interrupted():  # a terminal's Ctrl-C met a process before that ignored it
            return [future.result() if not future.exception() else None for future in futures]
        raise RuntimeError("a process that worked for an item, or one beside it, died") from None
    finally:
        stop.set()
        pool.shutdown(wait=False, cancel_futures=True)
        deadline = time.monotonic() + _GRACE_S
        for process in set(multiprocessing.active_children()) - others:
            process.join(max(deadline - time.monotonic(), 0.0))
            process.terminate()
            process.join()


def _initialise(messages: Any, stop: Any, jobs: int) -> None:
    """Initialise a process: it ignores a terminal's Ctrl-C, which the main process handles for all."""
    global _messages, _stop
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _messages, _stop = messages, stop
    cores.share_among(jobs)


def _run(work: Work, index: int, item: Any) -> Any:
    """Result for an item, in a process of the pool; None when a stop was requested before."""
    if _stop.is_set():
        return None
    try:
        return work(item, lambda message: _messages.put((index, message)), _stop.is_set)
    except Exception as error:
        raise sendable(error) from None


def sendable(error: Exception) -> Exception:
    """The error; a RuntimeError with its traceback as text where it cannot be pickled."""
    try:
        pickle.loads(pickle.dumps(error))
        return error
    except Exception:
        return RuntimeError("".join(traceback.format_exception(error)))
