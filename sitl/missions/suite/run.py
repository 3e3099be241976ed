# SPDX-License-Identifier: BSD-3-Clause
"""Runs a suite, and makes the table of what came of it."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from dataclasses import replace
from html import escape
from multiprocessing import get_context
from pathlib import Path

from sitl.core.compile import Progress
from sitl.core.ray_cluster import cluster
from sitl.core.whole_file import write_whole
from sitl.physics.engines import NATIVE
from sitl.vehicle.core_entry import load_core
from sitl.vehicle.kinds import KINDS

from ..comparison.report import Case as JunitCase
from ..comparison.report import junit_write as write_junit
from .cases import Case, SuiteError
from .fly_case import FAILED, Result, fly_case

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


_HEADS = ("position [m]", "cross-track [m]", "altitude [m]", "delay [s]", "energy [%]")


def head(width: int) -> str:
    """First line of the table; ``width``: length of the longest name."""
    return f"{'mission':{width}}  {'':9}  " + "  ".join(_HEADS) + "   time [s]  wall [s]"


def line(result: Result, width: int) -> str:
    """Line of a result, with the differences below it."""
    values = [f"{value:{len(name)}.2f}" for value, name in zip(result.metrics.values(), _HEADS, strict=False)]
    values += [" " * len(name) for name in _HEADS[len(values) :]]
    found = f"{result.name:{width}}  {result.status:9}  " + "  ".join(values)
    found += f"  {result.simulated:9.1f}  {result.wall:8.2f}"
    for text in (result.words, result.note, f"report: {result.report}" if result.report else ""):
        found += f"\n    {text}" if text else ""
    return found


def summary(results: Sequence[Result], wall: float) -> str:
    """Last line of the table; ``wall``: wall time [s]."""
    bad = sum(not result.ok for result in results)
    simulated = sum(result.simulated for result in results)
    good = f"{len(results) - bad} of {len(results)} passed"
    return f"{good}: {simulated / 60.0:.0f} simulated minutes in {wall:.1f} s"


def write(folder: Path, suite: str, results: Sequence[Result]) -> Path:
    """Write junit.xml and index.html; gives the path of the page."""
    folder.mkdir(parents=True, exist_ok=True)
    cases = [
        JunitCase(
            suite,
            result.name,
            result.wall,
            failure=result.words if not result.ok and result.status != FAILED else "",
            error=result.words if result.status == FAILED else "",
            output=result.note,
        )
        for result in results
    ]
    write_junit(folder / "junit.xml", cases)
    path = folder / "index.html"
    write_whole(path, _page(folder, suite, results), SuiteError, f"report {path}")
    return path


def _page(folder: Path, suite: str, results: Sequence[Result]) -> str:
    from ..comparison.report import STYLE

    bad = sum(not result.ok for result in results)
    title = f"{len(results) - bad} of {len(results)} missions fly like their golden flights"
    heads = "".join(f"<th class=n>{name}</th>" for name in _HEADS)
    rows = []
    for result in sorted(results, key=lambda result: (result.ok, result.name)):
        name = escape(result.name)
        if result.report:
            name = (
                f'<a href="{escape(Path(result.report).resolve().relative_to(folder.resolve()).as_posix())}">{name}</a>'
            )
        values = [f'<td class="n">{value:.2f}</td>' for value in result.metrics.values()]
        values += ["<td></td>"] * (len(_HEADS) - len(values))
        rows.append(
            f'<tr class="{"" if result.ok else "bad"}"><td class="mark">{"&#10003;" if result.ok else "&#10007;"}</td>'
            f"<td>{name}</td>{''.join(values)}<td class=where>{escape(result.words or result.note)}</td></tr>"
        )
    return (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{escape(suite)}: {title}</title>'
        f'<meta name="viewport" content="width=device-width"><style>{STYLE}</style></head><body><main>'
        f'<header class="{"bad" if bad else ""}"><h1>{title}</h1>'
        f'<p class="soft"><code>{escape(suite)}</code></p></header>'
        f"<h2>Missions</h2><section><table><tr><th></th><th>mission</th>{heads}<th>what differs</th></tr>"
        + "\n".join(rows)
        + "</table></section></main></body></html>\n"
    )
