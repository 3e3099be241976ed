# SPDX-License-Identifier: BSD-3-Clause
"""The backends that run work, by name. All give the same results."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from ..errors import AgentError
from . import local
from .local import OnProgress, Work

BACKENDS = ("local", "ray")


def each(
    work: Work,
    items: Sequence[Any],
    jobs: int = 1,
    on_progress: OnProgress = lambda index, message: None,
    backend: str = "local",
    address: str | None = None,
) -> list[Any]:
    """Call ``work`` for each item; returns the results in order, None for items not started before an interrupt.

    Args:
        work: a module-level function, so that other processes can import it. It may read and write only in the
            folders that its item names: see ``transfer.paths_of``.
        items: picklable arguments of ``work``.
        jobs: number of items at a time.
        on_progress: see ``local.OnProgress``.
        backend: "local": processes of this machine; "ray": workers of a Ray cluster.
        address: address of the cluster; None: ``$RAY_ADDRESS``, else an instance on this machine.

    Raises:
        AgentError: no such backend, or an address for one that has none.
        MissingExtra: Ray is not installed.
        Exception: what ``work`` raised for an item; the other items are stopped.
    """
    check(backend, address)
    if backend == "ray":
        from . import on_ray

        return on_ray.each(work, items, jobs, on_progress, address)
    return local.each(work, items, jobs, on_progress)


def check(backend: str, address: str | None = None) -> None:
    """Check that a backend exists and can be used; raises as ``each`` does."""
    if backend not in BACKENDS:
        raise AgentError(f"backend {backend!r} is not known; it is one of {', '.join(BACKENDS)}")
    if address is not None and backend != "ray":
        raise AgentError(f"address {address!r}: only the backend ray has one")
    if backend == "ray":
        from sitl.core import ray_cluster

        ray_cluster.require()


@dataclass(frozen=True)
class Workers:
    """Number of workers, and where they run.

    Raises:
        AgentError, MissingExtra: see ``each``.
    """

    jobs: int = 1
    backend: str = "local"
    address: str | None = None

    def __post_init__(self) -> None:
        check(self.backend, self.address)

    @property
    def each(self) -> Callable[..., list[Any]]:
        """``each(work, items, jobs, on_progress)`` there."""
        return partial(each, backend=self.backend, address=self.address)
