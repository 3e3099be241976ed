# SPDX-License-Identifier: BSD-3-Clause
"""The paper's benchmark, trained again: as in the textbooks and as its authors coded it, over many seeds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .. import algorithms
from ..errors import AgentError
from ..evaluate import evaluate_run
from ..runs import folder as folders
from ..runs.config import RunConfig
from ..runs.folder import RunFolder
from .blocks import BLOCK
from .document import Document
from .group import Group
from .paper_figures import BEST_EPISODE, ENVIRONMENT, MEAN_REWARDS, REAL_TIME_FACTOR, TITLES
from .paper_reasons import reasons
from .sections import aggregates, blocks_csv, draw_curves, greedy_play, with_interval, write_csv
from .statistics import mean_interval

JITTER = 0.1
"""By which greedy play moves the starts [m, rad]: from one start every episode would be the same."""


@dataclass(frozen=True)
class Variant:
    """A way to learn the paper's task."""

    name: str
    settings: Mapping[str, Any]


TEXTBOOK = Variant("textbook", {})
AS_CODED = Variant("as coded", {"as_coded": True})
VARIANTS = (TEXTBOOK, AS_CODED)
SINGLE_CHANGES = (
    Variant("noise", {"exploration": "noise"}),
    Variant("first visit", {"first_visit": True}),
    Variant("terminal bootstrap", {"terminal_bootstrap": True}),
    Variant("redraw", {"redraw": True}),
    Variant("gamma 0.8", {"gamma": 0.8}),
    Variant("as coded, gamma 0.8", {"as_coded": True, "gamma": 0.8}),
)
"""Each thing that the code does otherwise, alone; and all of them, with the discount of the code at that time."""
STEP_TIMES = (0.1, 0.3, 0.5)
"""Others than the environment's [s]."""


def runs_of(
    folder: Path,
    algorithm: str,
    variant: Variant,
    seeds: Sequence[int],
    episodes: int,
    options: Mapping[str, Any] | None = None,
) -> list[RunFolder]:
    """The runs of a variant, made where they are not there yet, and at least so long.

    Args:
        folder: of all.
        algorithm: "qlearn" or "sarsa".
        variant: see ``Variant``.
        seeds: one run each.
        episodes: of each.
        options: of the environment, which the paper's does not have.

    Raises:
        AgentError: there are other runs in its place.
    """
    settings = algorithms.load(algorithm).settings(algorithm, variant.settings)
    found = []
    for seed in seeds:
        config = RunConfig(ENVIRONMENT, algorithm, dict(options or {}), settings, seed, episodes)
        name = "-".join(
            [
                algorithm,
                variant.name.replace(",", "").replace(" ", "-"),
                *(f"{k}-{v}" for k, v in (options or {}).items()),
            ]
        )
        path = folders.seed_folder(folder / "runs" / name, seed)
        if not folders.is_run(path):
            found.append(RunFolder.create(path, config))
            continue
        run = RunFolder(path)
        different = run.config.differences(config)
        if different:
            raise AgentError(f"{path} differs in {', '.join(different)}; choose another --out")
        if (run.config.episodes or 0) < episodes:
            run.extend(episodes, None)
        found.append(run)
    return found


def write_report(groups: Mapping[tuple[str, str], Group], extra: Sequence[Group], folder: Path, play: int) -> Path:
    """The report of the benchmark.

    Args:
        groups: (algorithm, variant) -> its runs, of all ``VARIANTS``.
        extra: runs with one thing changed.
        folder: for the files.
        play: greedy episodes of each run.

    Returns:
        path of the Markdown.
    """
    every = list(groups.values())
    seeds, checks = len(every[0].runs), every[0].config.settings
    document = Document("The paper's benchmark: Q-learning and Sarsa on circuit2")
    document.paragraph(
        f"{ENVIRONMENT}, {every[0].rewards.shape[1]} episodes of at most {every[0].config.max_steps} steps, "
        f"alpha 0.2, gamma 0.9, epsilon 0.9 x 0.9986 an episode down to 0.05, {seeds} seeds. The paper shows one run "
        'of each. "Textbook" is Q-learning and Sarsa as textbooks have them, "as coded" has what the authors\' code '
        "did otherwise."
    )
    document.heading(f"Mean reward per {BLOCK} episodes")
    _table(document, groups, folder)
    _shortfalls(document, groups)
    paper = {f"{TITLES[a]}, paper": MEAN_REWARDS[a] for a in TITLES}
    document.picture(draw_curves(folder / "curves.png", every, BLOCK, paper), "raw and averaged learning curves")
    aggregates(document, folder, every, BLOCK)
    document.heading("Played greedily")
    document.paragraph(
        f"What was learnt, without learning and exploring: {play} episodes a seed, from the paper's start moved by up "
        f"to {JITTER:g} m and {JITTER:g} rad, since from the very start every episode is the same: the robot has no "
        "noise. The best table of a run plays. With a constant step size tables never settle; so every "
        f"{checks['check_every']} episodes the table drove {checks['check_episodes']} episodes from other moved "
        "starts, and the one with the highest mean reward was kept. A lap of circuit2 is right, right, left, right, "
        "right, right."
    )
    played = {g.name: {"moved starts": [evaluate_run(run, play, jitter=JITTER) for run in g.runs]} for g in every}
    greedy_play(document, folder, played)
    if extra:
        document.heading("One thing changed at a time")
        document.paragraph(
            f"Mean reward per {BLOCK} episodes of the textbook learners with one thing changed, mean over seeds."
        )
        _changes(document, groups, extra)
        document.points(reasons({group.name: group for group in [*every, *extra]}))
    _time(document, every)
    blocks_csv(folder / "blocks.csv", [*every, *extra], BLOCK)
    return document.write(folder)


def _table(document: Document, groups: Mapping[tuple[str, str], Group], folder: Path) -> None:
    head, columns = ["episodes"], []
    for algorithm, title in TITLES.items():
        head.append(f"{title}, paper")
        columns.append([str(mean) for mean in MEAN_REWARDS[algorithm]])
        for variant in VARIANTS:
            mean, half = mean_interval(groups[algorithm, variant.name].blocks())
            head.append(f"{title}, {variant.name}")
            columns.append([with_interval(m, h) for m, h in zip(mean, half)])
    count = max(len(column) for column in columns[1::3])
    names = [f"{k * BLOCK} to {(k + 1) * BLOCK}" for k in range(count)]
    rows = [[name, *(column[k] if k < len(column) else "" for column in columns)] for k, name in enumerate(names)]
    best = ["best episode"]
    for algorithm in TITLES:
        best.append(f"about {BEST_EPISODE[algorithm]}")
        best += [f"{groups[algorithm, variant.name].best:.0f}" for variant in VARIANTS]
    document.table(head, [*rows, best])
    write_csv(folder / "paper.csv", head, [*rows, best])


def _shortfalls(document: Document, groups: Mapping[tuple[str, str], Group]) -> None:
    """Where ours stays below the paper's by more than the seeds' spread."""
    points = []
    for (algorithm, variant), group in groups.items():
        blocks = group.blocks()
        count = min(blocks.shape[1], len(MEAN_REWARDS[algorithm]))
        theirs, spread = np.array(MEAN_REWARDS[algorithm][:count]), blocks.std(axis=0, ddof=min(len(blocks) - 1, 1))
        ours = blocks.mean(axis=0)[:count]
        below = [k for k in range(count) if ours[k] < theirs[k]]
        far = [k for k in below if ours[k] + spread[k] < theirs[k]]
        text = (
            f"{TITLES[algorithm]}, {variant}: at or above the paper's mean in {count - len(below)} of {count} intervals"
        )
        if below:
            text += f", below it but within a standard deviation of the seeds in {len(below) - len(far)}"
            text += f", further below in {len(far)}"
        if far:
            text += " (" + ", ".join(f"{k * BLOCK} to {(k + 1) * BLOCK}" for k in far) + ")"
        points.append(text + ".")
    document.points(points)


def _changes(document: Document, groups: Mapping[tuple[str, str], Group], extra: Sequence[Group]) -> None:
    columns = []
    for algorithm, title in TITLES.items():
        columns.append((f"{title}, textbook", groups[algorithm, TEXTBOOK.name].blocks().mean(axis=0)))
    columns += [(group.name, group.blocks().mean(axis=0)) for group in extra]
    count = max(len(means) for _, means in columns)
    head = ["", *(f"{k * BLOCK}" for k in range(count))]
    document.table(head, [[name, *(f"{mean:.0f}" for mean in means)] for name, means in columns])


def _time(document: Document, groups: Sequence[Group]) -> None:
    document.heading("Time")
    rows = []
    for group in groups:
        simulated, wall = group.simulated_s.mean(), group.wall_s.mean()
        there = simulated / REAL_TIME_FACTOR / 3600.0
        rows.append(
            [group.name, f"{simulated / 3600.0:.0f} h", f"{wall:.1f} s", f"{simulated / wall:,.0f}", f"{there:.1f} h"]
        )
    document.paragraph(
        f"Of the episodes of a run, mean over seeds. The paper's simulation ran at about {REAL_TIME_FACTOR} times real "
        "time."
    )
    document.table(["", "simulated", "wall time", "times real time", f"at {REAL_TIME_FACTOR} times"], rows)
