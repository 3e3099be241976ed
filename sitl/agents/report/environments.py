# SPDX-License-Identifier: BSD-3-Clause
"""The benchmark of the recipes: each is trained over some seeds and played greedily, with pictures of where it went."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from ..evaluate import Interrupted, until_stopped
from ..recipes import Recipe, names
from ..runs.local import SendProgress, Stopped
from . import curves
from .document import Document
from .driven import Driven, drive
from .group import Group
from .paper_tables import REAL_TIME_FACTOR
from .sections import write_csv
from .trails import draw_trails

_TURTLEBOT = "turtlebot"
Item = tuple[Path, Recipe]


@dataclass(frozen=True)
class Dish:
    """Results of a recipe."""

    recipe: Recipe
    group: Group
    """Runs of the recipe, by seed."""
    driven: Sequence[Driven]
    """An evaluation of each."""

    @cached_property
    def paper_speed(self) -> int:
        """Times real time at which the paper's simulation ran this robot."""
        return REAL_TIME_FACTOR if self.driven[0].facts.robot == _TURTLEBOT else 1

    @property
    def has_laps(self) -> bool:
        """Whether laps are counted in its world."""
        return not math.isnan(self.driven[0].evaluation.mean_laps)

    def seeds(self) -> list[int]:
        """Seeds of the runs."""
        return [run.config.seed for run in self.group.runs]


def drive_one(item: Item, send_progress: SendProgress, stopped: Stopped) -> Driven | None:
    """Play what one run has learnt, as its recipe says; a ``Work``. Tells 1 after each episode; None when stopped."""
    path, recipe = item
    try:
        return drive(path, recipe.evaluation, until_stopped(send_progress, stopped))
    except Interrupted:
        return None


def write_report(dishes: Sequence[Dish], folder: Path) -> Path:
    """The report.

    Args:
        dishes: results of the recipes.
        folder: for the files.

    Returns:
        path of the Markdown.
    """
    seeds = len(dishes[0].group.runs)
    document = Document("The environments, learnt")
    document.paragraph(
        f"Each recipe trained with {seeds} seed{'s' if seeds > 1 else ''} and then played without learning and "
        "exploring. Values are means over seeds, with the lowest and the highest seed in brackets where they differ."
    )
    _played(document, dishes)
    _trained(document, dishes)
    _recipes(document, dishes)
    for dish in dishes:
        _pictures(document, dish, folder)
    write_csv(folder / "environments.csv", _HEAD, [row for dish in dishes for row in _rows(dish)])
    return document.write(folder)


def _played(document: Document, dishes: Sequence[Dish]) -> None:
    document.heading("Played greedily")
    rows = []
    for dish in dishes:
        found, plan = [driven.evaluation for driven in dish.driven], dish.recipe.evaluation
        count = plan.episodes
        safe = [count * (1.0 - one.crash_rate) for one in found]
        laps = with_range([one.mean_laps for one in found], ".1f") if dish.has_laps else "-"
        rows.append(
            [
                dish.recipe.name,
                _starts(dish),
                f"{with_range(safe, '.3g')} of {count}",
                laps,
                with_range([one.mean_simulated_s / 60.0 for one in found], ".1f"),
                f"{_limit_s(dish) / 60.0:.1f}",
                with_range([driven.farthest_m for driven in dish.driven], ".0f"),
                with_range([driven.left for driven in dish.driven], ".3g"),
                with_range([one.mean_reward for one in found], ",.0f"),
            ]
        )
    head = [
        "", "starts", "episodes without a crash", "laps an episode", "minutes an episode", "at most", "farthest [m]",
        "left the world", "mean reward",
    ]  # fmt: skip
    document.table(head, rows)
    document.paragraph(
        "Minutes are of simulated time, until a crash or the last step. Farthest: the greatest distance from the start "
        "in an episode, median of the episodes. Left the world: episodes that ended, neither by a crash nor by a goal "
        "reached, outside of the rectangle that its walls lie in, by an exit or a window; a world without walls is not "
        "left."
    )


def _trained(document: Document, dishes: Sequence[Dish]) -> None:
    document.heading("Trained")
    rows = []
    for dish in dishes:
        simulated, wall = dish.group.simulated_s, dish.group.wall_s
        seconds = float(simulated.mean())
        slow = "only in real time" if dish.paper_speed == 1 else f"at {dish.paper_speed} times"
        rows.append(
            [
                dish.recipe.name,
                with_range(_episodes(dish), ",.0f"),
                with_range(_steps(dish), ",.0f"),
                _duration(seconds),
                _duration(float(wall.mean())),
                with_range((simulated / wall).tolist(), ",.0f"),
                f"{_duration(seconds / dish.paper_speed)} ({slow})",
            ]
        )
    document.paragraph(
        "Of a run. Wall time has the checks in it that keep the best table, and the learning of networks; simulated "
        "time has only the episodes that were learnt from. The paper's simulation ran Turtlebot at about "
        f"{REAL_TIME_FACTOR} times real time, and vehicles with an autopilot in real time only."
    )
    head = ["", "episodes", "steps", "simulated", "wall time", "times real time", "the same at the paper's speed"]
    document.table(head, rows)


def _recipes(document: Document, dishes: Sequence[Dish]) -> None:
    document.heading("Recipes")
    rows = []
    for dish in dishes:
        facts = dish.driven[0].facts
        rows.append(
            [
                dish.recipe.name, dish.recipe.env, dish.recipe.algorithm, facts.observation, facts.action,
                f"{facts.step_s:g} s",
            ]
        )  # fmt: skip
    document.table(["", "environment", "algorithm", "observation", "actions", "step"], rows)


def _pictures(document: Document, dish: Dish, folder: Path) -> None:
    recipe, first = dish.recipe, dish.driven[0]
    document.heading(recipe.name)
    if recipe.summary:
        document.paragraph(f"{recipe.summary}.")
    if recipe.name in names():
        document.paragraph(f"`sitl train --recipe {recipe.name}`")
    document.picture(curves.draw_run(dish.group.runs, folder / f"{recipe.name}-curve.png"), "learning curve")
    crashed = [played.crashed for played in first.evaluation.episodes[: len(first.trails)]]
    title = f"{recipe.name}: {len(crashed)} greedy episodes, {sum(crashed) or 'no'} crash{'es' * (sum(crashed) != 1)}"
    path = draw_trails(folder / f"{recipe.name}-trails.png", first.facts.world, first.trails, crashed, title)
    document.picture(path, f"trails of {len(crashed)} greedy episodes, seed {dish.seeds()[0]}")


_HEAD = (
    "recipe", "seed", "environment", "algorithm", "episodes", "steps", "simulated_s", "wall_s", "times_real_time",
    "paper_wall_s", "played", "without_crash", "laps", "minutes", "at_most_minutes", "farthest_m", "left",
    "mean_reward",
)  # fmt: skip


def _rows(dish: Dish) -> list[list[object]]:
    rows: list[list[object]] = []
    every = zip(dish.seeds(), _episodes(dish), _steps(dish), dish.group.simulated_s, dish.group.wall_s, dish.driven)
    for seed, episodes, steps, simulated, wall, driven in every:
        found = driven.evaluation
        count = len(found.episodes)
        rows.append(
            [
                dish.recipe.name, seed, dish.recipe.env, dish.recipe.algorithm, episodes, steps,
                round(float(simulated), 1), round(float(wall), 2), round(float(simulated / wall), 1),
                round(float(simulated) / dish.paper_speed, 1), count, round(count * (1.0 - found.crash_rate)),
                found.mean_laps, found.mean_simulated_s / 60.0, _limit_s(dish) / 60.0, driven.farthest_m, driven.left,
                found.mean_reward,
            ]
        )  # fmt: skip
    return rows


def _episodes(dish: Dish) -> list[int]:
    return [len(run.episodes.rows()) for run in dish.group.runs]


def _steps(dish: Dish) -> list[int]:
    return [int(run.episodes.column("steps").sum()) for run in dish.group.runs]


def _limit_s(dish: Dish) -> float:
    """Most simulated time of an evaluated episode [s]."""
    return (dish.recipe.evaluation.max_steps or dish.recipe.max_steps) * dish.driven[0].facts.step_s


def _starts(dish: Dish) -> str:
    plan = dish.recipe.evaluation
    start = {**dish.recipe.options, **plan.options}.get("start")
    where = {"turned": "any heading", "random": "anywhere", None: "the paper's"}.get(start, str(start))
    return f"{where}, ± {plan.jitter:g} m, rad" if plan.jitter > 0.0 else where


def with_range(values: Sequence[float], form: str) -> str:
    """Mean as text, with the least and the greatest value where they are others."""
    mean, low, high = (format(float(pick(values)), form) for pick in (np.mean, min, max))
    return mean if low == high else f"{mean} ({low} .. {high})"


def _duration(seconds: float) -> str:
    """A duration [s] as text."""
    if seconds < 120.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 7200.0 else f"{seconds / 3600.0:,.0f} h"
