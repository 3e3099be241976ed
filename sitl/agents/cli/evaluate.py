# SPDX-License-Identifier: BSD-3-Clause
"""``sitl evaluate``: what a run has learnt plays episodes, without learning and exploring."""

from __future__ import annotations

import argparse
from dataclasses import asdict
from pathlib import Path

from sitl.cli.output import add_json_option, print_json

from ..evaluations import evaluate_runs
from ..runs import folder as folders
from .agent_options import add_jobs, add_option, assignments, positive, whole, workers


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser(
        "evaluate",
        description="Evaluates the best agent of a run in greedy episodes. Defaults are the evaluation settings of the "
        "run's recipe.",
    )
    parser.add_argument("run", type=Path, metavar="RUN", help="run folder, or folder of several runs")
    parser.add_argument("--episodes", type=positive, metavar="N", help="number of episodes (default: of the run, 100)")
    parser.add_argument(
        "--max-steps", type=positive, metavar="N", help="time limit of an episode in steps (default: of the run)"
    )
    parser.add_argument("--seed", type=whole, default=0, metavar="N", help="seed of the episodes (default 0)")
    parser.add_argument(
        "--jitter", type=float, metavar="X", help="move start poses by up to X m and X rad (default: of the run, 0)"
    )
    add_option(parser)
    add_jobs(parser)
    add_json_option(parser, "a list of runs, with each episode")
    parser.set_defaults(function=evaluate)


def evaluate(options: argparse.Namespace) -> int:
    """Run the command."""
    changes = assignments(options.option)
    pool, runs = workers(options), folders.find(options.run)
    plans = [
        run.config.evaluation.changed(options.episodes, options.jitter, options.max_steps, changes) for run in runs
    ]
    evaluations = evaluate_runs(runs, plans, options.seed, pool)
    if options.json:
        print_json(
            [
                {"run": str(run.path), "episodes": [asdict(played) for played in found.episodes]}
                for run, found in zip(runs, evaluations)
            ]
        )
        return 0
    for run, found in zip(runs, evaluations):
        print(f"{run.path}: {found.sentence()}")
    return 0
