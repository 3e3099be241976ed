# SPDX-License-Identifier: BSD-3-Clause
"""Where work is done, by name. All give the same results."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from ..errors import AgentError
from . import local
from .local import Told, Work

BACKENDS = ("local", "ray")


def each(
    work: Work,
    items: Sequence[Any],
    jobs: int = 1,
    told: Told = lambda index, message: None,
    backend: str = "local",
    address: str | None = None,
) -> list[Any]:
    """Do the work for all items; returns the results in their order, None for those not begun before an interrupt.

    Args:
        work: a function of a module, so that other processes find it. It may read and write in the folders that its
            item names, nowhere else: see ``parcels.paths_of``.
        items: can be pickled.
        jobs: how many at a time.
        told: see ``local.Told``.
        backend: "local": processes of this machine; "ray": workers of a Ray cluster.
        address: of the cluster; None: ``$RAY_ADDRESS``, else an instance on this machine.

    Raises:
        AgentError: no such backend, or an address for one that has none.
        MissingExtra: Ray is not installed.
        Exception: what the work raised for an item; the others are stopped.
    """
    check(backend, address)
    if backend == "ray":
        from . import on_ray

        return on_ray.each(work, items, jobs, told, address)
    return local.each(work, items, jobs, told)


def check(backend: str, address: str | None = None) -> None:
    """See that there is such a backend, and that it can be used; raises as ``each`` does."""
    if backend not in BACKENDS:
        raise AgentError(f"backend {backend!r} is not known; it is one of {', '.join(BACKENDS)}")
    if address is not None and backend != "ray":
        raise AgentError(f"address {address!r}: only the backend ray has one")
    if backend == "ray":
        from sitl.core import ray_cluster

        ray_cluster.require()


@dataclass(frozen=True)
class Workers:
    """How many, and where.

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
        """``each(work, items, jobs, told)`` there."""
        return partial(each, backend=self.backend, address=self.address)
