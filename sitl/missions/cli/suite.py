# SPDX-License-Identifier: BSD-3-Clause
"""``sitl mission suite``: fly all missions of a folder against their goldens."""

from __future__ import annotations

import argparse
import os
import time
from fnmatch import fnmatch
from pathlib import Path

from sitl.cli.options import open_folder
from sitl.cli.progress import CompileProgress
from sitl.errors import OptionError


def add_parser(actions: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = actions.add_parser("suite", help="fly all missions of a folder and compare them with their golden flights")
    parser.add_argument("folder", type=Path, metavar="DIR", help="mission files, suite.toml, golden/NAME.rec")
    parser.add_argument("--jobs", type=_jobs, metavar="N", help=f"flights at the same time (default {os.cpu_count()})")
    parser.add_argument("--backend", choices=("local", "ray"), default="local", help="where they fly (default local)")
    parser.add_argument(
        "--only", action="append", metavar="PATTERN", help="only flights whose names match (repeatable)"
    )
    parser.add_argument(
        "--report",
        type=Path,
        metavar="DIR",
        help="write index.html, junit.xml and the flights that differ to this folder",
    )
    parser.add_argument("--list", action="store_true", help="list the flights without flying them")
    parser.add_argument(
        "--update-golden", action="store_true", help="write the golden flights that are missing or differ"
    )
    parser.set_defaults(function=run)


def _jobs(text: str) -> int:
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number from 1 on")
    return int(text)


def run(options: argparse.Namespace) -> int:
    """Fly them; 0 when all are like golden."""
    from ..suite import cases as suite_cases
    from ..suite import run as table
    from ..suite.fly_case import Result
    from ..suite.run import run as fly_all

    cases = suite_cases.find(options.folder)
    if options.only:
        cases = [case for case in cases if any(fnmatch(case.name, pattern) for pattern in options.only)]
        if not cases:
            raise OptionError(f"--only {' '.join(options.only)}: no flight of {options.folder} has such a name")
    width = max(len(case.name) for case in cases)
    if options.list:
        for case in cases:
            wind = " ".join(f"{name}={value:g}" for name, value in case.params.items())
            print(f"{case.name:{width}}  {case.frame}  {case.world or '-'}  seed {case.seed}  {wind}".rstrip())
        return 0
    reports = str(open_folder(options.report, "--report")) if options.report is not None else None
    began = time.monotonic()
    results: list[Result] = []
    print(table.head(width))
    with CompileProgress() as progress:
        for result in fly_all(
            cases,
            jobs=options.jobs,
            backend=options.backend,
            update=options.update_golden,
            reports=reports,
            progress=progress,
        ):
            results.append(result)
            print(table.line(result, width), flush=True)
    print(table.summary(results, time.monotonic() - began))
    if options.report is not None:
        print(f"report: {table.write(options.report, str(options.folder), results)}")
    return 0 if all(result.ok for result in results) else 1
