# SPDX-License-Identifier: BSD-3-Clause
"""``sitl dataset``: flights of experts as datasets in Minari's form."""

from __future__ import annotations

import argparse
import sys

from tqdm import tqdm

from .. import datasets
from ..experts import AUTOPILOTS
from ..named_policies import RANDOM
from .agent_options import add_option, assignments, positive, whole


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser("dataset", description="Datasets of flights, for imitation and offline learning.")
    record = parser.add_subparsers(metavar="COMMAND", required=True).add_parser(
        "record",
        help="record episodes of an expert",
        description="The dataset is stored in Minari's folder ($MINARI_DATASETS_PATH), and minari.load_dataset "
        "opens it. The same command gives the same dataset.",
    )
    record.add_argument("env", metavar="ENV", help="id of the environment, such as sitl/CopterWaypoint-v1")
    experts = ", ".join((*AUTOPILOTS, datasets.BASELINE, RANDOM))
    record.add_argument(
        "--expert",
        default="guided",
        metavar="EXPERT",
        help=f"{experts}, name of a baseline, run folder or policy file (default guided)",
    )
    record.add_argument("--episodes", type=positive, default=100, metavar="N", help="number of episodes (default 100)")
    record.add_argument("--seed", type=whole, default=0, metavar="N", help="seed of the episodes (default 0)")
    record.add_argument(
        "--max-steps", type=positive, metavar="N", help="time limit of an episode in steps (default: that of the id)"
    )
    record.add_argument("--name", metavar="DATASET", help="id of the dataset (default: sitl/ENV/EXPERT-vN of ENV-vN)")
    add_option(record)
    record.set_defaults(function=run)


def run(options: argparse.Namespace) -> int:
    """Run the command."""
    with tqdm(total=options.episodes, unit="episode", file=sys.stderr, disable=None) as bar:
        found = datasets.record(
            options.env,
            options.name,
            expert=options.expert,
            episodes=options.episodes,
            seed=options.seed,
            options=assignments(options.option),
            max_steps=options.max_steps,
            on_progress=lambda steps: bar.update(),
        )
    mean = sum(found.rewards) / len(found.rewards)
    print(f"{found.dataset.id}: {len(found.rewards)} episodes, {found.steps:,} steps, mean reward {mean:.2f}, "
          f"{found.successes} successes; in {datasets.where()}")  # fmt: skip
    return 0
