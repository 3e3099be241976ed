# SPDX-License-Identifier: BSD-3-Clause
"""One function applied to many items by workers of a Ray cluster, which need not share a file system with this machine.

Folders and files that an item names are sent with it, and changes in the folders are sent back while the work runs. So
the local folders always hold what a local run would have left, had it been interrupted at that moment.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Sequence
from contextlib import suppress
from typing import Any

from sitl.core.ray_cluster import cluster

from ..errors import AgentError
from . import transfer
from .local import OnProgress, Work
from .ray_worker import libraries
from .watch import Interrupts

DEATHS = 3
"""Number of workers that may die in a row on one item before it is given up."""
_TICK_S = 0.1
_PATIENCE_S = 15.0
"""Wall time without a free worker after which a message says that we wait [s]."""
_FORWARDED = ("OMP_NUM_THREADS", "NUMBA_DISABLE_JIT")
"""Environment variables that are copied to the workers of a cluster; all others are those of their machine."""


def each(
    work: Work,
    items: Sequence[Any],
    jobs: int = 1,
    on_progress: OnProgress = lambda index, message: None,
    address: str | None = None,
) -> list[Any]:
    """See ``backends.each``. A worker that dies is replaced; its item continues from the files received so far.

    Raises:
        AgentError: workers have other versions of gym-sitl or its libraries than this process.
        RuntimeError: workers died again and again.
    """
    if not items:
        return []
    jobs = min(jobs, len(items))
    with cluster(jobs, address) as ray, Interrupts() as interrupted:
        ours = not (address or os.environ.get("RAY_ADDRESS"))
        pool = _Pool(ray, work, items, on_progress, {} if ours else _forwarded())
        try:
            return pool.run(jobs, interrupted)
        finally:
            pool.dismiss()


class _Slot:
    """A worker and the item it works on."""

    def __init__(self, actor: Any) -> None:
        self.actor = actor
        self.index: int | None = None
        """Index of the item it works on; None: none yet."""
        self.pending: Any = actor.open.remote()
        """The pending answer: first its library versions, then messages."""


class _Pool:
    def __init__(
        self, ray: Any, work: Work, items: Sequence[Any], on_progress: OnProgress, variables: dict[str, str]
    ) -> None:
        self._ray, self._work, self._items, self._on_progress = ray, work, items, on_progress
        self._paths = [transfer.paths_of(item) for item in items]
        self._todo = list(range(len(items)))
        self._deaths = [0] * len(items)
        self._lost = 0
        """Number of workers in a row that died before they had an item."""
        self._results: list[Any] = [None] * len(items)
        self._slots: list[_Slot] = []
        self._versions = libraries()
        options = {"runtime_env": {"env_vars": variables}} if variables else {}
        self._actor = ray.remote(num_cpus=1, **options)(_actor_class())

    def run(self, jobs: int, interrupted: Interrupts) -> list[Any]:
        self._slots = [_Slot(self._actor.remote()) for _ in range(jobs)]
        stopping, since = False, time.monotonic()
        while self._todo or self._busy:
            if interrupted() and not stopping:
                stopping, self._todo = True, []
                for slot in self._busy:
                    slot.actor.stop.remote()
            if since and not self._busy and time.monotonic() - since > _PATIENCE_S:
                print("waiting for a free CPU of the Ray cluster", file=sys.stderr)
                since = 0.0
            waited = {slot.pending: slot for slot in self._slots if slot.pending is not None}
            for ref in self._ray.wait(list(waited), timeout=_TICK_S)[0]:
                self._answer(waited[ref], stopping)
        return self._results

    @property
    def _busy(self) -> list[_Slot]:
        return [slot for slot in self._slots if slot.index is not None]

    def _answer(self, slot: _Slot, stopping: bool) -> None:
        errors = self._ray.exceptions
        try:
            answer = self._ray.get(slot.pending)
        except errors.RayTaskError as error:
            raise error.cause if isinstance(error.cause, Exception) else error from None
        except errors.RayError as error:
            self._died(slot, error, stopping)
            return
        if isinstance(answer, dict):
            self._check(answer)
            self._lost = 0
            self._next(slot)
            return
        for kind, content in answer:
            self._take(slot, kind, content)
        if slot.index is not None:
            slot.pending = slot.actor.messages.remote()

    def _check(self, there: dict[str, str]) -> None:
        """Refuse a worker with other versions: results depend on them."""
        host = there.pop("host", "?")
        if "error" in there:
            raise AgentError(
                f"the Ray worker at {host} cannot load gym-sitl: {there['error']}; install gym-sitl "
                f"{self._versions['gym-sitl']} there"
            )
        shared = ((name, mine, there.get(name, mine)) for name, mine in self._versions.items())
        other = [f"{name} {theirs}, not {mine}" for name, mine, theirs in shared if theirs != mine]
        if other:
            raise AgentError(f"the Ray worker at {host} has {'; '.join(other)}: install the same there as here")

    def _next(self, slot: _Slot) -> None:
        if not self._todo:
            self._end(slot)
            return
        slot.index = self._todo.pop(0)
        contents = [transfer.read(path) for path in self._paths[slot.index]]
        slot.pending = slot.actor.begin.remote(self._work, self._items[slot.index], contents)

    def _take(self, slot: _Slot, kind: str, content: Any) -> None:
        index = slot.index
        assert index is not None
        if kind == "progress":
            self._on_progress(index, content)
        elif kind == "files":
            number, changes = content
            transfer.write(self._paths[index][number], changes)
            self._deaths[index] = 0
        elif kind == "raised":
            raise content
        else:
            self._results[index] = content
            slot.index = None
            self._next(slot)

    def _died(self, slot: _Slot, error: Exception, stopping: bool) -> None:
        index = slot.index
        self._end(slot)
        if index is None:
            self._lost += 1
            count, what = self._lost, "before they had begun"
        else:
            self._deaths[index] += 1
            count, what = self._deaths[index], f"of item {index} ({self._items[index]})"
        if stopping:  # what had come back is kept
            return
        if count >= DEATHS:
            raise RuntimeError(f"{count} Ray workers in a row died {what}; the last: {_first_line(error)}")
        if index is not None:
            self._todo.insert(0, index)
        self._slots.append(_Slot(self._actor.remote()))

    def _end(self, slot: _Slot) -> None:
        self._slots.remove(slot)
        slot.index = None
        slot.pending = None
        with suppress(Exception):
            self._ray.kill(slot.actor)

    def dismiss(self) -> None:
        """End all workers."""
        closing = [slot.actor.close.remote() for slot in self._busy]
        if closing:
            self._ray.wait(closing, num_returns=len(closing), timeout=2.0)
        for slot in list(self._slots):
            self._end(slot)


def _forwarded() -> dict[str, str]:
    """Variables for workers of a cluster; those of an instance that we start inherit all of this process."""
    return {name: os.environ[name] for name in _FORWARDED if name in os.environ}


def _actor_class() -> type:
    """The actor class. It is local so that Ray sends its code: a worker without gym-sitl cannot import it."""

    class RemoteWorker:
        def open(self) -> dict[str, str]:
            import socket

            host = socket.gethostname()
            try:
                from sitl.agents.runs.ray_worker import Worker, libraries
            except Exception as error:
                return {"host": host, "error": str(error)}
            self._worker = Worker()
            return {"host": host, **libraries()}

        def begin(self, *words: Any) -> Any:
            return self._worker.begin(*words)

        def messages(self) -> Any:
            return self._worker.messages()

        def stop(self) -> None:
            self._worker.stop()

        def close(self) -> None:
            self._worker.close()

    return RemoteWorker


def _first_line(error: Exception) -> str:
    return next((line.strip() for line in str(error).splitlines() if line.strip()), type(error).__name__)
