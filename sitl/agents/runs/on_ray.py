# SPDX-License-Identifier: BSD-3-Clause
"""The same work for many items, by workers of a Ray cluster, which need not share a folder with this machine.

Folders and files that an item names are sent with it, and what changes in the folders comes back while the work goes
on: what is here is always what a run on this machine would have left, had it been interrupted.
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
from . import parcels
from .local import Told, Work
from .ray_worker import libraries
from .watch import Interrupts

DEATHS = 3
"""So many workers may die of an item that does not get on; then it is given up."""
_TICK_S = 0.1
_PATIENCE_S = 15.0
"""After so long without a worker it is said that we wait for one."""
_FORWARDED = ("OMP_NUM_THREADS", "NUMBA_DISABLE_JIT")
"""Variables of this process that the workers of a cluster get; all else, as SITL_CACHE_DIR, is their machine's."""


def each(
    work: Work,
    items: Sequence[Any],
    jobs: int = 1,
    told: Told = lambda index, message: None,
    address: str | None = None,
) -> list[Any]:
    """See ``backends.each``. A worker that dies is replaced: its item goes on from what had come back.

    Raises:
        AgentError: workers have not the same versions as this process.
        RuntimeError: workers died again and again.
    """
    if not items:
        return []
    jobs = min(jobs, len(items))
    with cluster(jobs, address) as ray, Interrupts() as asked:
        ours = not (address or os.environ.get("RAY_ADDRESS"))
        crew = _Crew(ray, work, items, told, {} if ours else _forwarded())
        try:
            return crew.run(jobs, asked)
        finally:
            crew.dismiss()


class _Seat:
    """A worker, seen from here."""

    def __init__(self, actor: Any) -> None:
        self.actor = actor
        self.index: int | None = None
        """Of the item it works for."""
        self.pending: Any = actor.open.remote()
        """What we wait for: the versions it has, then messages, again and again."""


class _Crew:
    def __init__(self, ray: Any, work: Work, items: Sequence[Any], told: Told, variables: dict[str, str]) -> None:
        self._ray, self._work, self._items, self._told = ray, work, items, told
        self._paths = [parcels.paths_of(item) for item in items]
        self._todo = list(range(len(items)))
        self._deaths = [0] * len(items)
        self._lost = 0
        """Workers that died before they had an item, in a row."""
        self._results: list[Any] = [None] * len(items)
        self._seats: list[_Seat] = []
        self._versions = libraries()
        options = {"runtime_env": {"env_vars": variables}} if variables else {}
        self._actor = ray.remote(num_cpus=1, **options)(_actor_class())

    def run(self, jobs: int, asked: Interrupts) -> list[Any]:
        self._seats = [_Seat(self._actor.remote()) for _ in range(jobs)]
        stopping, since = False, time.monotonic()
        while self._todo or self._busy:
            if asked() and not stopping:
                stopping, self._todo = True, []
                for seat in self._busy:
                    seat.actor.stop.remote()
            if since and not self._busy and time.monotonic() - since > _PATIENCE_S:
                print("waiting for a free CPU of the Ray cluster", file=sys.stderr)
                since = 0.0
            waited = {seat.pending: seat for seat in self._seats if seat.pending is not None}
            for ref in self._ray.wait(list(waited), timeout=_TICK_S)[0]:
                self._answer(waited[ref], stopping)
        return self._results

    @property
    def _busy(self) -> list[_Seat]:
        return [seat for seat in self._seats if seat.index is not None]

    def _answer(self, seat: _Seat, stopping: bool) -> None:
        errors = self._ray.exceptions
        try:
            answer = self._ray.get(seat.pending)
        except errors.RayTaskError as error:
            raise error.cause if isinstance(error.cause, Exception) else error from None
        except errors.RayError as error:
            self._died(seat, error, stopping)
            return
        if isinstance(answer, dict):
            self._check(answer)
            self._lost = 0
            self._next(seat)
            return
        for kind, content in answer:
            self._take(seat, kind, content)
        if seat.index is not None:
            seat.pending = seat.actor.messages.remote()

    def _check(self, there: dict[str, str]) -> None:
        """Results depend on these versions."""
        place = there.pop("place", "?")
        if "error" in there:
            raise AgentError(
                f"the Ray worker at {place} cannot load gym-sitl: {there['error']}; install gym-sitl "
                f"{self._versions['gym-sitl']} there"
            )
        shared = ((name, mine, there.get(name, mine)) for name, mine in self._versions.items())
        other = [f"{name} {theirs}, not {mine}" for name, mine, theirs in shared if theirs != mine]
        if other:
            raise AgentError(f"the Ray worker at {place} has {'; '.join(other)}: install the same there as here")

    def _next(self, seat: _Seat) -> None:
        if not self._todo:
            self._end(seat)
            return
        seat.index = self._todo.pop(0)
        contents = [parcels.read(path) for path in self._paths[seat.index]]
        seat.pending = seat.actor.begin.remote(self._work, self._items[seat.index], contents)

    def _take(self, seat: _Seat, kind: str, content: Any) -> None:
        index = seat.index
        assert index is not None
        if kind == "told":
            self._told(index, content)
        elif kind == "files":
            number, changes = content
            parcels.write(self._paths[index][number], changes)
            self._deaths[index] = 0
        elif kind == "raised":
            raise content
        else:
            self._results[index] = content
            seat.index = None
            self._next(seat)

    def _died(self, seat: _Seat, error: Exception, stopping: bool) -> None:
        index = seat.index
        self._end(seat)
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
        self._seats.append(_Seat(self._actor.remote()))

    def _end(self, seat: _Seat) -> None:
        self._seats.remove(seat)
        seat.index = None
        seat.pending = None
        with suppress(Exception):
            self._ray.kill(seat.actor)

    def dismiss(self) -> None:
        """Let all end, however this ends."""
        closing = [seat.actor.close.remote() for seat in self._busy]
        if closing:
            self._ray.wait(closing, num_returns=len(closing), timeout=2.0)
        for seat in list(self._seats):
            self._end(seat)


def _forwarded() -> dict[str, str]:
    """For workers of a cluster; those of an instance that we begin have all variables of this process."""
    return {name: os.environ[name] for name in _FORWARDED if name in os.environ}


def _actor_class() -> type:
    """Made here, so that it is sent as it is, not as a name that a worker without gym-sitl could not look up."""

    class Seat:
        def open(self) -> dict[str, str]:
            import socket

            place = socket.gethostname()
            try:
                from sitl.agents.runs.ray_worker import Worker, libraries
            except Exception as error:
                return {"place": place, "error": str(error)}
            self._worker = Worker()
            return {"place": place, **libraries()}

        def begin(self, *words: Any) -> Any:
            return self._worker.begin(*words)

        def messages(self) -> Any:
            return self._worker.messages()

        def stop(self) -> None:
            self._worker.stop()

        def close(self) -> None:
            self._worker.close()

    return Seat


def _first_line(error: Exception) -> str:
    return next((line.strip() for line in str(error).splitlines() if line.strip()), type(error).__name__)
