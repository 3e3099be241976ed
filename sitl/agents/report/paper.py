# SPDX-License-Identifier: BSD-3-Clause
"""The paper's benchmark, trained again: as in the textbooks and as its authors coded it, over many seeds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .. import algorithms
from ..runs import folder as folders
from ..runs.backends import Workers
from ..runs.config import RunConfig
from ..runs.evaluation_plan import EvaluationPlan
from ..runs.folder import RunFolder
from .document import BLOCK, Document
from .group import Group
from .paper_reasons import reasons
from .paper_tables import ENVIRONMENT, MEAN_REWARDS, TITLES, beside_paper, changes, shortfalls, times
from .sections import aggregates, blocks_csv, curves_text, draw_curves, greedy_play, interval_text

JITTER = 0.1
"""Distance by which greedy play moves the starts, in x and y [m] and yaw [rad]: from one start all episodes are the
same."""


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
        folder: folder of the benchmark.
        algorithm: "qlearn" or "sarsa".
        variant: see ``Variant``.
        seeds: one run each.
        episodes: episodes of each run.
        options: options of the environment, which the paper's does not have.

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
        found.append(RunFolder.ensure(folders.seed_folder(folder / "runs" / name, seed), config))
    return found


def write_report(
    groups: Mapping[tuple[str, str], Group],
    extra: Sequence[Group],
    folder: Path,
    play: int,
    workers: Workers | None = None,
) -> Path:
    """The report of the benchmark.

    Args:
        groups: (algorithm, variant) -> its runs, of all ``VARIANTS``.
        extra: runs with one thing changed.
        folder: for the files.
        play: greedy episodes of each run.
        workers: workers that play them.

    Returns:
        path of the Markdown.
    """
    common = min(group.rewards.shape[1] for group in [*groups.values(), *extra])
    groups = {key: group.first(common) for key, group in groups.items()}
    extra = [group.first(common) for group in extra]
    every = list(groups.values())
    seeds, settings = len(every[0].runs), every[0].config.settings
    document = Document("The paper's benchmark: Q-learning and Sarsa on circuit2")
    document.paragraph(
        f"{ENVIRONMENT}, {common} episodes of at most {every[0].config.max_steps} steps, alpha {settings['alpha']}, "
        f"gamma {settings['gamma']}, epsilon {settings['epsilon']} x {settings['epsilon_decay']} an episode down to "
        f"{settings['epsilon_floor']}, {seeds} seed{'s' if seeds > 1 else ''}. The paper shows one run of each. "
        '"Textbook" is Q-learning and Sarsa as textbooks have them, "as coded" has what the authors\' code did '
        "otherwise."
    )
    document.heading(f"Mean reward per {BLOCK} episodes")
    document.paragraph(interval_text(every))
    beside_paper(document, groups, folder)
    document.points(shortfalls(groups))
    if not extra:
        document.paragraph("`--changes` trains with one thing changed at a time: what the differences come from.")
    paper = {f"{TITLES[a]}, paper": MEAN_REWARDS[a] for a in TITLES}
    document.paragraph(curves_text(BLOCK))
    document.picture(draw_curves(folder / "curves.png", every, BLOCK, paper), "raw and averaged learning curves")
    aggregates(document, folder, every, BLOCK)
    document.heading("Played greedily")
    document.paragraph(
        f"What was learnt, without learning and exploring: {play} episodes a seed, from the paper's start moved by up "
        f"to {JITTER:g} m and {JITTER:g} rad, since from the very start every episode is the same: the robot has no "
        "noise. The best table of a run plays. With a constant step size tables never settle; so every "
        f"{settings['check_every']} episodes the table drove {settings['check_episodes']} episodes from other moved "
        "starts, and the one with the highest mean reward was kept. A lap of circuit2 is right, right, left, right, "
        "right, right."
    )
    plan = EvaluationPlan(episodes=play, jitter=JITTER)
    greedy_play(document, folder, every, [plan] * len(every), workers)
    if extra:
        document.heading("One thing changed at a time")
        document.paragraph(
            f"Mean reward per {BLOCK} episodes of the learners above, and of the textbook learners with one thing "
            "changed, mean over seeds; the head has the first episode of each block."
        )
        changes(document, every, extra)
        document.points(reasons({group.name: group for group in [*every, *extra]}))
    times(document, every)
    blocks_csv(folder / "blocks.csv", [*every, *extra], BLOCK)
    return document.write(folder)
