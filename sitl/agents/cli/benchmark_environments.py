# SPDX-License-Identifier: BSD-3-Clause
"""``sitl benchmark environments``: every recipe trained and played, as one report."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path

from .. import recipes
from ..recipes.recipe import check_all, runs_of
from ..report import curves, environments
from ..report.driven import Driven
from ..report.environments import Dish
from ..report.group import Group
from ..runs.backends import Workers
from ..runs.folder import RunFolder
from ..runs.training import is_done
from .options import add_jobs, positive, workers

OUT = Path("reports/environments")
Train = Callable[[list[RunFolder], Workers], bool]
"""Trains runs there; returns whether all are done."""


def declare(actions: argparse._SubParsersAction[argparse.ArgumentParser], train: Train) -> None:
    """Declare the command."""
    parser = actions.add_parser(
        "environments",
        help="an agent for each environment, by the shipped recipes",
        description="Trains what is missing in --out, plays it greedily, then writes report.md, report.html, pictures "
        "and a CSV file. The same command goes on after an interrupt.",
    )
    shipped = ", ".join(recipes.names())
    parser.add_argument(
        "--only", nargs="+", metavar="NAME", help=f"recipes, or .toml files (default: all of {shipped})"
    )
    parser.add_argument("--seeds", type=positive, default=1, metavar="N", help="runs of each recipe (default 1)")
    add_jobs(parser)
    parser.add_argument("--out", type=Path, default=OUT, metavar="DIR", help=f"default: {OUT}")
    parser.set_defaults(function=lambda options: run(options, train))


def run(options: argparse.Namespace, train: Train) -> int:
    """Run the command."""
    pool = workers(options)
    chosen = [recipes.load(name) for name in options.only or recipes.names()]
    check_all(chosen, options.seeds)
    curves.figure()  # before hours are spent, see that pictures can be drawn
    runs = [runs_of(options.out, recipe, options.seeds) for recipe in chosen]
    todo = [one for group in runs for one in group if not is_done(one)]
    items = [(one.path, recipe) for recipe, group in zip(chosen, runs) for one in group]
    driven: list[Driven | None] = [None]
    if not todo or train(todo, pool):
        print(f"playing {len(items)} runs", file=sys.stderr)
        driven = pool.each(environments.drive_one, items, pool.jobs)
    played = [one for one in driven if one is not None]
    if len(played) < len(items):
        print("interrupted; the same command goes on", file=sys.stderr)
        return 130
    dishes = []
    for k, (recipe, group) in enumerate(zip(chosen, runs)):
        own = played[k * options.seeds : (k + 1) * options.seeds]
        dishes.append(Dish(recipe, Group(recipe.name, group), own))
    print(environments.write_report(dishes, options.out))
    return 0
