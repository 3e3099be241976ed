# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.baselines [NAME...] [--episodes N] [--seed N]``: the table of the shipped policies.

Each plays the same episodes in its environment on every machine, to the last bit; beside it a policy that draws its
actions plays them. Intervals are of 95 %: of means by the normal distribution, of shares by Wilson's.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence

import numpy as np

from sitl.agents import baselines, learnt, recipes
from sitl.agents.evaluate import Evaluation
from sitl.agents.policies import RANDOM
from sitl.agents.rollout import rollout

Z = 1.96
"""Quantile of the normal distribution for an interval of 95 %."""


def mean(found: Evaluation) -> str:
    """Mean reward and its interval."""
    rewards = np.array([played.reward for played in found.episodes])
    return f"{rewards.mean():.1f} ± {Z * rewards.std(ddof=1) / math.sqrt(len(rewards)):.1f}"


def share(count: int, of: int) -> str:
    """A share and its interval [%]."""
    p, n = count / of, float(of)
    middle, half = p + Z * Z / (2 * n), Z * math.sqrt(p * (1 - p) / n + Z * Z / (4 * n * n))
    low, high = (100 * (middle + sign * half) / (1 + Z * Z / n) for sign in (-1, 1))
    return f"{100 * p:.1f} % ({low:.1f} .. {min(high, 100.0):.1f})"


def row(name: str, episodes: int, seed: int) -> str:
    """A row of the table."""
    path = baselines.find(name)
    config = learnt.load(path).config
    steps = recipes.load(name).steps or 0
    drawn = rollout(RANDOM, config.env, episodes, seed=seed, max_steps=config.max_steps, options=config.env_options)
    played = rollout(path, episodes=episodes, seed=seed)
    solved, crashed = (sum(getattr(one, what) for one in played.episodes) for what in ("reached", "crashed"))
    cells = (f"`{config.env}`", f"`{name}`", f"{steps:,}", mean(played), share(solved, episodes), crashed, mean(drawn))
    return f"| {' | '.join(str(cell) for cell in cells)} |"


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.baselines", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(baselines.names())}; default: all")
    parser.add_argument("--episodes", type=int, default=200, metavar="N", help="default 200")
    parser.add_argument("--seed", type=int, default=1000, metavar="N", help="of the episodes, default 1000")
    options = parser.parse_args(arguments)
    print("| environment | recipe | steps learnt | reward | solved | crashes | reward of drawn actions |")
    print("|---|---|---:|---:|---:|---:|---:|")
    for name in options.names or baselines.names():
        print(row(name, options.episodes, options.seed), flush=True)


if __name__ == "__main__":
    main()
