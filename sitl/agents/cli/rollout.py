# SPDX-License-Identifier: BSD-3-Clause
"""``sitl rollout``: a policy plays many episodes, by fleets of robots, on all cores or a Ray cluster."""

from __future__ import annotations

import argparse
import csv
import sys
import time
from collections.abc import Sequence
from dataclasses import astuple, fields
from pathlib import Path

from tqdm import tqdm

from ...core.whole_file import whole_file
from .. import baselines, environments
from ..errors import AgentError
from ..evaluate import Played
from ..named_policies import RANDOM, Named
from ..rollout import ROBOTS, rollout
from ..runs.files import make_folder
from .agent_options import add_jobs, add_option, assignments, positive, whole, workers

RESULTS = "episodes.csv"


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser(
        "rollout",
        description="Plays episodes with a policy and prints mean reward, crashes and successes. Results depend on the "
        "seed, not on the number of workers.",
    )
    parser.add_argument(
        "policy",
        metavar="POLICY",
        help=f"run folder, policy file (.npz), name of a baseline (sitl help baselines), MODULE:FUNCTION from "
        f"observations to actions, or {RANDOM}",
    )
    parser.add_argument("env", nargs="?", metavar="ENV", help="id of the environment (default: that of the run)")
    parser.add_argument("--episodes", type=positive, default=100, metavar="N", help="number of episodes (default 100)")
    parser.add_argument(
        "--max-steps",
        type=positive,
        metavar="N",
        help="time limit of an episode in steps (default: of the run, or 1500)",
    )
    parser.add_argument("--seed", type=whole, default=0, metavar="N", help="seed of the episodes (default 0)")
    parser.add_argument(
        "--robots",
        type=positive,
        default=ROBOTS,
        metavar="N",
        help=f"parallel environments of a worker (default {ROBOTS})",
    )
    add_option(parser)
    parser.add_argument("--out", type=Path, metavar="FOLDER", help=f"write {RESULTS} there, a row for each episode")
    parser.add_argument(
        "--trajectories", action="store_true", help="with --out: write observations, actions and rewards, too"
    )
    add_jobs(parser)
    parser.set_defaults(function=run)


def run(options: argparse.Namespace) -> int:
    """Run the command."""
    if options.trajectories and options.out is None:
        raise AgentError("--trajectories needs --out FOLDER")
    if options.out is not None:
        make_folder(options.out)
        if any(options.out.iterdir()):
            raise AgentError(f"{options.out} is not empty; choose another --out")
    pool, begun = workers(options), time.perf_counter()
    with tqdm(total=options.episodes, unit="episode", file=sys.stderr, disable=None) as bar:
        found = rollout(
            _policy(options.policy),
            options.env,
            options.episodes,
            seed=options.seed,
            max_steps=options.max_steps,
            options=assignments(options.option),
            robots=options.robots,
            workers=pool,
            trajectories=options.out if options.trajectories else None,
            on_progress=lambda part, ended: bar.update(ended),
        )
    wall = time.perf_counter() - begun
    if options.out is not None:
        _write(options.out / RESULTS, found.episodes, options.seed)
    steps = sum(played.steps for played in found.episodes)
    print(found.sentence())
    print(f"{steps:,} steps in {wall:.1f} s: {steps / wall:,.0f} steps/s")
    return 0


def _policy(text: str) -> Named:
    """A folder, a file, a policy that is shipped; else what ``rollout`` understands."""
    return baselines.find(text) if text != RANDOM and (":" not in text or Path(text).is_dir()) else text


def _write(path: Path, episodes: Sequence[Played], seed: int) -> None:
    """Results as CSV; truth values as 0 and 1."""
    names = [field.name for field in fields(Played)]
    with whole_file(path, AgentError) as beside, open(beside, "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["episode", "seed", *names])
        for k, played in enumerate(episodes):
            values = [int(value) if isinstance(value, bool) else value for value in astuple(played)]
            table.writerow([k, environments.seed_of(seed, k), *values])
