# SPDX-License-Identifier: BSD-3-Clause
"""Flies all cases of a suite, several at a time: in processes of this machine, or on a Ray cluster."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path

from sitl.core.compile import Progress
from sitl.core.ray_cluster import cluster
from sitl.physics.engines import NATIVE
from sitl.vehicle.core_entry import load_core
from sitl.vehicle.kinds import KINDS

from .cases import Case
from .fly import fly_case
from .result import FAILED, Result

BACKENDS = ("local", "ray")


def run(
    cases: Sequence[Case],
    *,
    jobs: int | None = None,
    backend: str = "local",
    update: bool = False,
    reports: str | None = None,
    progress: Progress | None = None,
) -> Iterator[Result]:
    """Fly the cases; yields each result as it is ready.

    Args:
        jobs: flights at a time; None: one a core.
        backend: "local", or "ray": on the cluster at ``$RAY_ADDRESS``, else on this machine. Its machines see the
            same folders.
        update, reports: as ``fly_case`` has them.

    Raises:
        MissingExtra: Ray is not installed.
    """
    if backend == "ray":
        yield from _on_ray(cases, jobs, update, reports)
        return
    for kind in sorted({case.kind for case in cases if case.physics == NATIVE}):
        load_core(KINDS[kind], progress)  # compiled here if need be: once, and before anybody waits for it
    jobs = min(jobs or os.cpu_count() or 1, len(cases))
    if jobs == 1:
        for case in cases:
            yield fly_case(case, update, reports)
        return
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
        waiting = {pool.submit(fly_case, case, update, reports): case for case in cases}
        for done in as_completed(waiting):
            try:
                yield done.result()
            except BrokenProcessPool:
                yield Result(waiting[done].name, FAILED, "the process that flew it, or one beside it, died")


def _on_ray(cases: Sequence[Case], jobs: int | None, update: bool, reports: str | None) -> Iterator[Result]:
    reports = str(Path(reports).resolve()) if reports is not None else None
    with cluster(jobs) as ray:
        task = ray.remote(fly_case)
        waiting = [task.remote(_from_anywhere(case), update, reports) for case in cases]
        while waiting:
            done, waiting = ray.wait(waiting)
            yield from ray.get(done)


def _from_anywhere(case: Case) -> Case:
    """The case with absolute paths: Ray's processes may have another working directory."""

    def whole(name: str | None) -> str | None:
        return str(Path(name).resolve()) if name is not None and Path(name).is_file() else name

    tolerance = whole(case.tolerance) if isinstance(case.tolerance, str) else case.tolerance
    return replace(
        case,
        mission=case.mission.resolve(),
        golden=case.golden.resolve(),
        frame=whole(case.frame) or case.frame,
        world=whole(case.world),
        tolerance=tolerance,
    )
