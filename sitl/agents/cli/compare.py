# SPDX-License-Identifier: BSD-3-Clause
"""``sitl compare``: a report that holds runs side by side."""

from __future__ import annotations

import argparse
from pathlib import Path

from ..report.comparison import compare
from ..report.group import Group, unique_names
from .agent_options import add_jobs, add_said_again, positive, workers


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser("compare", description="Writes a report that compares runs.")
    parser.add_argument("runs", nargs="+", type=Path, metavar="RUN", help="run folders, or folders of several seeds")
    parser.add_argument(
        "--out", type=Path, default=Path("reports/compare"), metavar="DIR", help="default: reports/compare"
    )
    parser.add_argument(
        "--block", type=positive, metavar="N", help="episodes of a block in tables and curves (default 200)"
    )
    parser.add_argument(
        "--play",
        type=positive,
        default=0,
        metavar="N",
        help="also evaluate each run in N greedy episodes",
    )
    add_said_again(parser)
    add_jobs(parser)
    parser.set_defaults(function=run)


def run(options: argparse.Namespace) -> int:
    """Run the command."""
    pool = workers(options)
    groups = [Group.load(path, name) for path, name in zip(options.runs, unique_names(options.runs))]
    path = compare(groups, options.out, options.block, options.play, pool)
    print(path)
    return 0
