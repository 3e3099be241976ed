# SPDX-License-Identifier: BSD-3-Clause
"""``sitl evaluate``: what a run has learnt plays episodes, without learning and exploring."""

from __future__ import annotations

import argparse
from pathlib import Path

from ..evaluate import EPISODES, evaluate_run
from ..runs import folder as folders
from .options import assignment, assignments, positive


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser("evaluate", help="let what a run has learnt play, and count crashes and laps")
    parser.add_argument("run", type=Path, metavar="RUN", help="folder of a run, or of several")
    parser.add_argument("--episodes", type=positive, default=EPISODES, metavar="N", help=f"default {EPISODES}")
    parser.add_argument("--max-steps", type=positive, metavar="N", help="of an episode (default: of the run)")
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="of the episodes")
    parser.add_argument(
        "--jitter", type=float, default=0.0, metavar="X", help="starts are moved by up to X metres and X rad"
    )
    parser.add_argument(
        "--option", type=assignment, action="append", metavar="NAME=VALUE", help="of the environment, as world=circuit"
    )
    parser.set_defaults(function=evaluate)


def evaluate(options: argparse.Namespace) -> int:
    """Run the command."""
    changes = assignments(options.option)
    for run in folders.find(options.run):
        if options.max_steps is not None:
            run.config = run.config.with_(max_steps=options.max_steps)
        found = evaluate_run(run, options.episodes, options.seed, options.jitter, **changes)
        print(f"{run.path}: {found.sentence()}")
    return 0
