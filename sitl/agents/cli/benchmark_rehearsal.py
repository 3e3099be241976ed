# SPDX-License-Identifier: BSD-3-Clause
"""``sitl benchmark rehearsal``: policies trained plain and with domain randomisation, both tried in simulations that
they have not seen."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path

from ..recipes.recipe import check_all, runs_of
from ..rehearsal import plan as plans
from ..rehearsal.rehearse import PLAIN, recipes_of
from ..rehearsal.report import write_report
from ..report import curves
from ..report.group import Group
from ..runs.backends import Workers
from ..runs.folder import RunFolder
from ..runs.training import is_done
from .options import add_jobs, positive, workers
from .rehearse import with_bar

OUT = Path("reports/rehearsal-benchmark")
EPISODES = 30
Train = Callable[[list[RunFolder], Workers], bool]
"""Trains runs there; returns whether all are done."""


def declare(actions: argparse._SubParsersAction[argparse.ArgumentParser], train: Train) -> None:
    """Declare the command."""
    shipped = ", ".join(plans.names())
    parser = actions.add_parser(
        "rehearsal",
        help="how much of a reward transfers to other simulations, with and without domain randomisation",
        description="Trains for each robot what is missing in --out: a policy in one simulation and one in many. Tries "
        "both under the changes of the robot's plan, then writes report.md, report.html, pictures and CSV files. The "
        "same command goes on after an interrupt.",
    )
    parser.add_argument("--only", nargs="+", metavar="PLAN", help=f"{shipped}, or .toml files (default: all shipped)")
    parser.add_argument("--seeds", type=positive, default=1, metavar="N", help="runs of each (default 1)")
    parser.add_argument("--steps", type=positive, metavar="N", help="of a training, instead of the recipe's length")
    parser.add_argument(
        "--episodes", type=positive, default=EPISODES, metavar="N", help=f"of each change and run (default {EPISODES})"
    )
    add_jobs(parser)
    parser.add_argument("--out", type=Path, default=OUT, metavar="DIR", help=f"default: {OUT}")
    parser.set_defaults(function=lambda options: run(options, train))


def run(options: argparse.Namespace, train: Train) -> int:
    """Run the command."""
    pool = workers(options)
    chosen = [plans.load(name) for name in options.only or plans.names()]
    plans.check_names(chosen)
    recipes = {plan.name: recipes_of(plan, options.steps) for plan in chosen}
    check_all([recipe for pair in recipes.values() for recipe in pair.values()], options.seeds)
    curves.figure()  # before much is trained, see that pictures can be drawn
    runs = {
        plan: {title: runs_of(options.out, recipe, options.seeds) for title, recipe in pair.items()}
        for plan, pair in recipes.items()
    }
    todo = [one for pair in runs.values() for group in pair.values() for one in group if not is_done(one)]
    sections = {}
    if not todo or train(todo, pool):
        for plan in chosen:
            groups = [Group(title, group) for title, group in runs[plan.name].items()]
            print(f"rehearsing {plan.name}: {PLAIN} and randomised", file=sys.stderr)
            found = with_bar(groups, plan.chosen(), options.episodes, 0, None, pool)
            if found is None:
                break
            sections[plan.name] = found
    if len(sections) < len(chosen):
        print("interrupted; the same command goes on", file=sys.stderr)
        return 130
    print(write_report(sections, options.out))
    return 0
