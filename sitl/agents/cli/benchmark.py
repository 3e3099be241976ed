# SPDX-License-Identifier: BSD-3-Clause
"""``sitl benchmark``: published results, made again."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from .. import recipes
from ..recipes.recipe import check_all, runs_of
from ..rehearsal import plan as plans
from ..rehearsal.rehearse import PLAIN, recipes_of
from ..rehearsal.report import write_report
from ..report import environments, paper
from ..report.driven import Driven
from ..report.environments import Dish
from ..report.group import Group
from ..report.paper_tables import TITLES
from ..runs.backends import Workers
from ..runs.bar import Bar
from ..runs.config import EPISODES
from ..runs.folder import RunFolder
from ..runs.training import is_done, train_all
from .agent_options import add_jobs, check_report_libraries, positive, workers
from .rehearse import with_bar

_SEEDS = 10
_REHEARSAL_EPISODES = 30
_REHEARSAL_OUT, _ENVIRONMENTS_OUT = Path("reports/rehearsal-benchmark"), Path("reports/environments")


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser("benchmark")
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    one = actions.add_parser(
        "paper",
        help="Q-learning and Sarsa on circuit2, compared with the paper's table",
        description="Trains what is missing in --out, then writes report.md, report.html, figures and CSV files.",
    )
    one.add_argument("--seeds", type=positive, default=_SEEDS, metavar="N", help=f"runs of each (default {_SEEDS})")
    one.add_argument(
        "--episodes", type=positive, default=EPISODES, metavar="N", help=f"episodes of a run (default {EPISODES})"
    )
    add_jobs(one)
    one.add_argument(
        "--play", type=positive, default=100, metavar="N", help="greedy episodes of each run (default 100)"
    )
    one.add_argument(
        "--changes",
        action="store_true",
        help="ablation, too: runs with one change each (exploration, first visit, step time, ...)",
    )
    one.add_argument("--out", type=Path, default=Path("reports/paper"), metavar="DIR", help="default: reports/paper")
    one.set_defaults(function=run_paper)
    _declare_environments(actions)
    _declare_rehearsal(actions)


def run_paper(options: argparse.Namespace) -> int:
    """Run ``sitl benchmark paper``."""
    check_report_libraries()
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


def _declare_environments(actions: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = actions.add_parser(
        "environments",
        help="train and evaluate all recipes",
        description="Trains what is missing in --out, evaluates it greedily, then writes report.md, report.html, "
        "figures and a CSV file. The same command continues after an interrupt.",
    )
    shipped = ", ".join(recipes.names())
    parser.add_argument(
        "--only", nargs="+", metavar="NAME", help=f"recipes, or .toml files (default: all of {shipped})"
    )
    parser.add_argument("--seeds", type=positive, default=1, metavar="N", help="runs of each recipe (default 1)")
    add_jobs(parser)
    parser.add_argument(
        "--out", type=Path, default=_ENVIRONMENTS_OUT, metavar="DIR", help=f"default: {_ENVIRONMENTS_OUT}"
    )
    parser.set_defaults(function=run_environments)


def run_environments(options: argparse.Namespace) -> int:
    """Run ``sitl benchmark environments``."""
    pool = workers(options)
    chosen = [recipes.load(name) for name in options.only or recipes.names()]
    check_all(chosen, options.seeds)
    check_report_libraries()
    runs = [runs_of(options.out, recipe, options.seeds) for recipe in chosen]
    todo = [one for group in runs for one in group if not is_done(one)]
    items = [(one.path, recipe) for recipe, group in zip(chosen, runs) for one in group]
    driven: list[Driven | None] = [None]
    if not todo or _train(todo, pool):
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


def _declare_rehearsal(actions: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    shipped = ", ".join(plans.names())
    parser = actions.add_parser(
        "rehearsal",
        help="robustness to other simulations, with and without domain randomisation",
        description="Trains two policies for each robot, with and without domain randomisation, if they are missing in "
        "--out. Tests both under the changes of the robot's plan, then writes report.md, report.html, figures and CSV "
        "files. The same command continues after an interrupt.",
    )
    parser.add_argument("--only", nargs="+", metavar="PLAN", help=f"{shipped}, or .toml files (default: all shipped)")
    parser.add_argument("--seeds", type=positive, default=1, metavar="N", help="runs of each (default 1)")
    parser.add_argument("--steps", type=positive, metavar="N", help="training steps, instead of the recipe's")
    parser.add_argument(
        "--episodes",
        type=positive,
        default=_REHEARSAL_EPISODES,
        metavar="N",
        help=f"episodes of each change and run (default {_REHEARSAL_EPISODES})",
    )
    add_jobs(parser)
    parser.add_argument("--out", type=Path, default=_REHEARSAL_OUT, metavar="DIR", help=f"default: {_REHEARSAL_OUT}")
    parser.set_defaults(function=run_rehearsal)


def run_rehearsal(options: argparse.Namespace) -> int:
    """Run ``sitl benchmark rehearsal``."""
    pool = workers(options)
    chosen = [plans.load(name) for name in options.only or plans.names()]
    plans.check_names(chosen)
    trained = {plan.name: recipes_of(plan, options.steps) for plan in chosen}
    check_all([recipe for pair in trained.values() for recipe in pair.values()], options.seeds)
    check_report_libraries()
    runs = {
        plan: {title: runs_of(options.out, recipe, options.seeds) for title, recipe in pair.items()}
        for plan, pair in trained.items()
    }
    todo = [one for pair in runs.values() for group in pair.values() for one in group if not is_done(one)]
    sections = {}
    if not todo or _train(todo, pool):
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


def _train(runs: list[RunFolder], pool: Workers) -> bool:
    # a progress bar counts episodes or steps, not both
    batches = [[run for run in runs if (run.config.episodes is None) is by_steps] for by_steps in (False, True)]
    for batch in batches:
        if batch:
            with Bar(batch) as bar:
                if not train_all([run.path for run in batch], pool.jobs, bar, pool.each):
                    return False
    return True
