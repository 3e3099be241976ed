# SPDX-License-Identifier: BSD-3-Clause
"""The same work for many items, in this process or in several of this machine."""

from __future__ import annotations

import multiprocessing
import pickle
import signal
import traceback
from collections.abc import Callable, Sequence
from functools import partial
from multiprocessing.connection import wait
from typing import Any

from .watch import Interrupts

Tell = Callable[[Any], None]
Stopped = Callable[[], bool]
Work = Callable[[Any, Tell, Stopped], Any]
"""``work(item, tell, stopped)``: tells of its progress, ends early when ``stopped()``, returns a result."""
Told = Callable[[int, Any], None]
"""Called with the number of an item and what its work told."""


def each(work: Work, items: Sequence[Any], jobs: int = 1, told: Told = lambda index, message: None) -> list[Any]:
    """Do the work for all items; returns the results in their order, None for those not begun before an interrupt.

    Args:
        work: a function of a module, so that other processes find it.
        items: can be pickled.
        jobs: how many processes; 1: this one.
        told: see ``Told``.

    Raises:
        Exception: what the work raised for an item; the others are stopped.
    """
    with Interrupts() as asked:
        if min(jobs, len(items)) <= 1:
            results: list[Any] = [None] * len(items)
            for index, item in enumerate(items):
                if not asked():
                    results[index] = work(item, partial(told, index), asked)
            return results
        return _in_processes(work, items, min(jobs, len(items)), told, asked)


def _in_processes(work: Work, items: Sequence[Any], jobs: int, told: Told, asked: Interrupts) -> list[Any]:
    context = multiprocessing.get_context("spawn")
    results: list[Any] = [None] * len(items)
    todo = list(range(len(items)))
    workers: dict[Any, Any] = {}
    """Our end of the pipe -> the process."""
    try:
        for _ in range(jobs):
            ours, theirs = context.Pipe()
            process = context.Process(target=_serve, args=(theirs, work), daemon=True)
            process.start()
            theirs.close()
            workers[ours] = process
        busy = {connection: todo.pop(0) for connection in workers}
        for connection, index in busy.items():
            connection.send(items[index])
        stopping = False
        while busy:
            if asked() and not stopping:
                stopping, todo = True, []
                for connection in busy:
                    connection.send(None)
            ready: list[Any] = list(wait(list(busy), 0.1))
            for connection in ready:
                index = busy[connection]
                try:
                    kind, content = connection.recv()
                except (EOFError, OSError):
                    workers[connection].join()
                    if asked():  # by a Ctrl-C that met it before it could shut its ears
                        del busy[connection]
                        continue
                    raise RuntimeError(f"the process of item {index} died ({workers[connection].exitcode})") from None
                if kind == "told":
                    told(index, content)
                    continue
                if kind == "raised":
                    raise content
                results[index] = content
                del busy[connection]
                if todo:
                    busy[connection] = todo.pop(0)
                    connection.send(items[busy[connection]])
        return results
    finally:
        for connection, process in workers.items():
            connection.close()  # it ends by this
            process.join(2.0)
            if process.is_alive():
                process.terminate()
                process.join()


def _serve(connection: Any, work: Work) -> None:
    """A process: works for the items that come, until the other end closes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # a terminal's Ctrl-C reaches all; the first process says what then
    try:
        while True:
            item = connection.recv()
            if item is None:  # asked to stop just when it was done
                continue
            try:
                content = ("done", work(item, partial(_tell, connection), connection.poll))
            except Exception as error:
                content = ("raised", sendable(error))
            connection.send(content)
    except (EOFError, OSError):
        return


def _tell(connection: Any, message: Any) -> None:
    connection.send(("told", message))


def sendable(error: Exception) -> Exception:
    """The error, or its text where it cannot be pickled."""
    try:
        pickle.loads(pickle.dumps(error))
        return error
    except Exception:
        return RuntimeError("".join(traceback.format_exception(error)))
