# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.baselines [NAME...] [--learn] [--faults]``: the figures of the shipped policies.

All policies play episodes of the same seeds; a random policy plays them, too. They repeat to the last bit, on every
machine. ``--faults`` adds episodes with faults, for copters. ``--learn`` trains the policies anew first, by their
recipes. The figures go to docs/envs/baselines.json, which docs/baselines.md and the pages of environments show.
Confidence intervals are of 95 %: of means by the normal distribution, of success rates by Wilson's formula.
"""

from __future__ import annotations

import argparse
import json
import math
import re
import resource
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from sitl.agents import baselines, learnt
from sitl.agents.evaluate import Evaluation
from sitl.agents.policies import RANDOM
from sitl.agents.rollout import rollout

DOCS = Path(__file__).parents[1] / "docs"
RESULTS = DOCS / "envs" / "baselines.json"
PAGE = DOCS / "baselines.md"
Z = 1.96
"""Quantile of the normal distribution for an interval of 95 %."""
FAULTS: dict[str, dict[str, Any]] = {
    "none": {},
    "a motor at 80 %": {"motor:2=0.8": (1, 5)},
    "GPS lost": {"gps": (1, 5)},
    "a shove of 5 m/s²": {"shove": (1, 5)},
    "wind of 8 m/s": {"wind=8": (1, 5)},
}
"""What fails in an episode, and between which times [s], by what the table calls it."""
FAULT_EPISODES = 50
Row = dict[str, Any]


def mean(found: Evaluation) -> tuple[float, float]:
    """Mean reward, and half of its interval."""
    rewards = np.array([played.reward for played in found.episodes])
    return round(float(rewards.mean()), 1), round(Z * float(rewards.std(ddof=1)) / math.sqrt(len(rewards)), 1)


def share(count: int, of: int) -> str:
    """A share and its interval [%]."""
    p, n = count / of, float(of)
    middle, half = p + Z * Z / (2 * n), Z * math.sqrt(p * (1 - p) / n + Z * Z / (4 * n * n))
    low, high = (100 * (middle + sign * half) / (1 + Z * Z / n) for sign in (-1, 1))
    return f"{100 * p:.1f} % ({low:.1f} .. {min(high, 100.0):.1f})"


def learn(name: str) -> float:
    """Learn a policy by its recipe, and put it in its place; returns the processor time that it took [s]."""
    recipe, env = baselines.recipe_of(name)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with tempfile.TemporaryDirectory() as folder:
        run = str(Path(folder) / name)
        command = [sys.executable, "-m", "sitl"]
        subprocess.run([*command, "train", env, "--recipe", recipe.name, "--out", run], check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([*command, "export", run, str(baselines.file(name))], check=True)
    return round(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)


def played(name: str, episodes: int, seed: int) -> Row:
    """Figures of a policy, and of a random policy in the same episodes."""
    path = baselines.file(name)
    config, (recipe, _) = learnt.load(path).config, baselines.recipe_of(name)
    drawn = rollout(RANDOM, config.env, episodes, seed=seed, max_steps=config.max_steps, options=config.env_options)
    found = rollout(path, episodes=episodes, seed=seed)
    solved, crashed = (sum(getattr(one, what) for one in found.episodes) for what in ("reached", "crashed"))
    return {
        "env": config.env, "recipe": recipe.name, "algorithm": config.algorithm, "steps": recipe.steps or 0,
        "episodes": episodes, "seed": seed, "reward": mean(found), "solved": solved, "crashed": crashed,
        "drawn": mean(drawn),
    }  # fmt: skip


def failing(name: str, seed: int) -> dict[str, int]:
    """Episodes solved of ``FAULT_EPISODES`` with each of ``FAULTS``."""
    path, out = baselines.file(name), {}
    for fault, option in FAULTS.items():
        options = {"faults": option} if option else {}
        found = rollout(path, episodes=FAULT_EPISODES, seed=seed, options=options)
        out[fault] = sum(one.reached for one in found.episodes)
    return out


def table(results: Mapping[str, Row]) -> str:
    """All policies."""
    heads = ("policy", "algorithm", "training steps", "training time", "mean return", "success")
    lines = [f"| {' | '.join((*heads, 'crashes', 'random policy'))} |", "|---|---|---:|---:|---:|---:|---:|---:|"]
    for name, row in results.items():
        took = f"{row['learnt_s']:.0f} s" if row.get("learnt_s") else ""
        reward, drawn = ("{} ± {}".format(*row[what]) for what in ("reward", "drawn"))
        solved = share(row["solved"], row["episodes"])
        task = row["env"].removeprefix("sitl/").removesuffix("-v0").removesuffix("Discrete")
        cells = (
            f"[{name}](envs/{task}.md)", row["algorithm"].upper(), f"{row['steps']:,}", took, reward, solved,
            row["crashed"], drawn,
        )  # fmt: skip
        lines.append(f"| {' | '.join(str(cell) for cell in cells)} |")
    return "\n".join(lines)


def faults_table(results: Mapping[str, Row]) -> str:
    """Those that have flown with faults."""
    lines = [f"| policy | {' | '.join(FAULTS)} |", "|---|" + "---:|" * len(FAULTS)]
    for name, row in results.items():
        if "faults" in row:
            lines.append(f"| `{name}` | {' | '.join(str(row['faults'].get(fault, '')) for fault in FAULTS)} |")
    return "\n".join(lines)


def kept() -> dict[str, Row]:
    """The figures as they are written."""
    found: dict[str, Row] = json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.exists() else {}
    return found


def write(results: Mapping[str, Row]) -> None:
    """Keep the figures of policies that there are, and put the tables of them on the page."""
    there = {name: results[name] for name in baselines.names() if name in results}
    rows = ",\n".join(f"{json.dumps(name)}: {json.dumps(row)}" for name, row in there.items())
    RESULTS.write_text("{\n" + rows + "\n}\n", encoding="utf-8")
    text = PAGE.read_text(encoding="utf-8")
    for what, made in (("results", table(there)), ("faults", faults_table(there))):
        between = re.compile(rf"(<!-- {what} -->\n).*?(<!-- /{what} -->)", re.DOTALL)
        text = between.sub(lambda found, made=made: f"{found[1]}\n{made}\n\n{found[2]}", text)  # type: ignore[misc]
    PAGE.write_text(text, encoding="utf-8")


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.baselines", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="a policy (docs/baselines.md); default: all")
    parser.add_argument("--episodes", type=int, default=200, metavar="N", help="default 200")
    parser.add_argument("--seed", type=int, default=1000, metavar="N", help="of the episodes, default 1000")
    parser.add_argument("--learn", action="store_true", help="train them anew first (extra rl)")
    parser.add_argument("--faults", action="store_true", help="copters: play episodes with faults, too")
    options = parser.parse_args(arguments)
    for name in options.names or baselines.names():
        row = kept().get(name, {})
        if options.learn:
            row["learnt_s"] = learn(name)
        row |= played(name, options.episodes, options.seed)
        if options.faults and name.startswith("copter"):
            row["faults"] = failing(name, options.seed)
        print(name, json.dumps(row), flush=True)
        write({**kept(), name: row})


if __name__ == "__main__":
    main()
