# SPDX-License-Identifier: BSD-3-Clause
"""``sitl benchmark``: published results, made again."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from ..report import paper
from ..report.group import Group
from ..report.paper_tables import TITLES
from ..runs.backends import Workers
from ..runs.bar import Bar
from ..runs.config import EPISODES
from ..runs.folder import RunFolder
from ..runs.training import is_done, train_all
from . import benchmark_environments, benchmark_rehearsal
from .options import add_jobs, positive, workers

SEEDS = 10


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser("benchmark", help="published results, made again")
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    one = actions.add_parser(
        "paper",
        help="Q-learning and Sarsa on circuit2, beside the paper's table",
        description="Trains what is missing in --out, then writes report.md, report.html, pictures and CSV files.",
    )
    one.add_argument("--seeds", type=positive, default=SEEDS, metavar="N", help=f"runs of each (default {SEEDS})")
    one.add_argument("--episodes", type=positive, default=EPISODES, metavar="N", help=f"of a run (default {EPISODES})")
    add_jobs(one)
    one.add_argument(
        "--play", type=positive, default=100, metavar="N", help="greedy episodes of each run (default 100)"
    )
    one.add_argument(
        "--changes",
        action="store_true",
        help="also runs with one thing changed: exploration, first visit, step time ...",
    )
    one.add_argument("--out", type=Path, default=Path("reports/paper"), metavar="DIR", help="default: reports/paper")
    one.set_defaults(function=run_paper)
    benchmark_environments.declare(actions, _train)
    benchmark_rehearsal.declare(actions, _train)


def run_paper(options: argparse.Namespace) -> int:
    """Run ``sitl benchmark paper``."""
    out, seeds, pool = options.out, range(options.seeds), workers(options)
    wanted: list[tuple[str, list[RunFolder]]] = []
    main: dict[tuple[str, str], int] = {}
    for algorithm, title in TITLES.items():
        for variant in paper.VARIANTS:
            main[algorithm, variant.name] = len(wanted)
            runs = paper.runs_of(out, algorithm, variant, seeds, options.episodes)
            wanted.append((f"{title}, {variant.name}", runs))
    if options.changes:
        for algorithm, title in TITLES.items():
            for variant in paper.SINGLE_CHANGES:
                if algorithm == "sarsa" or variant.name != "redraw":
                    runs = paper.runs_of(out, algorithm, variant, seeds, options.episodes)
                    wanted.append((f"{title}, {variant.name}", runs))
            for seconds in paper.STEP_TIMES:
                step = {"step_time": seconds}
                runs = paper.runs_of(out, algorithm, paper.TEXTBOOK, seeds, options.episodes, step)
                wanted.append((f"{title}, steps of {seconds:g} s", runs))
    todo = [run for _, runs in wanted for run in runs if not is_done(run)]
    if todo and not _train(todo, pool):
        print("interrupted; the same command goes on", file=sys.stderr)
        return 130
    groups = [Group(name, runs) for name, runs in wanted]
    found = {key: groups[index] for key, index in main.items()}
    print(paper.write_report(found, groups[len(main) :], out, options.play, pool))
    return 0


def _train(runs: list[RunFolder], pool: Workers) -> bool:
    # a progress bar counts episodes or steps, not both
    batches = [[run for run in runs if (run.config.episodes is None) is by_steps] for by_steps in (False, True)]
    for batch in batches:
        if batch:
            with Bar(batch) as bar:
                if not train_all([run.path for run in batch], pool.jobs, bar, pool.each):
                    return False
    return True
