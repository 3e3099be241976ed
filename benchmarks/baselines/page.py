# SPDX-License-Identifier: BSD-3-Clause
"""Tables of results for docs/baselines.md, and the policies that the package contains."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from sitl.agents import baselines
from sitl.agents.report.statistics import interquartile_mean, suite_interval, trained_interval, wilson
from sitl.agents.runs.files import write_bytes

from . import defaults, shipped, work
from .campaign import Campaign
from .conditions import AUTOPILOTS, CONDITIONS, ESTIMATE, KINDS, NOMINAL, ROBUST, SEED, UNSEEN, named
from .entries import Entry
from .records import Record
from .work import figures

PAGE, REAL_PAGE = shipped.DOCS / "baselines.md", shipped.DOCS / "mental-rehearsal.md"
NONE = "*No results yet.*"
LEARNT = 0.5
"""Share of episodes that a policy solves at least before it comes with the package."""


def row(cells: Sequence[object]) -> str:
    """A row of a table."""
    return f"| {' | '.join(str(cell) for cell in cells)} |"


def table(heads: Sequence[str], rows: Sequence[Sequence[object]], texts: int = 1) -> str:
    """A table whose first columns are text; a sentence where it has no rows."""
    if not rows:
        return NONE
    return "\n".join(
        [row(heads), f"|{'---|' * texts}{'---:|' * (len(heads) - texts)}", *(row(cells) for cells in rows)]
    )


def link(entry: Entry) -> str:
    """The name, as a link to the page of the task."""
    task = re.sub(r"-v\d+$", "", entry.env.removeprefix("sitl/")).removesuffix("Discrete")
    return f"[{entry.name}](envs/{task}.md)"


def of_seeds(found: Campaign, entry: Entry, what: str) -> list[Record]:
    """Evaluations of all trainings under a condition."""
    records = (found.episodes(entry, seed, what) for seed in range(found.seeds))
    return [record for record in records if record is not None]


def percent(records: Sequence[Record], what: str = "reached") -> str:
    """A rate over trainings and episodes with its interval: of one training Wilson's."""
    if not records:
        return ""
    values = np.stack([figures(record, what) for record in records])
    value, low, high = trained_interval(values)
    if len(records) == 1:
        low, high = wilson(int(values.sum()), values.size)
    return f"{100 * value:.1f} ({100 * low:.0f} .. {100 * high:.0f})"


def returns(records: Sequence[Record]) -> str:
    """Mean returns: interquartile mean over trainings, and its interval; of one training the normal distribution's."""
    if len(records) == 1:
        return "{} ± {}".format(*shipped.mean(records[0]["reward"]))
    value, low, high = trained_interval(np.stack([figures(record, "reward") for record in records]))
    return f"{value:.1f} ({low:.1f} .. {high:.1f})"


def results(found: Campaign) -> str:
    """All plain baselines that have results."""
    rows = []
    for entry in found.chosen:
        records = of_seeds(found, entry, NOMINAL)
        if entry.is_variant or not records:
            continue
        drawn = found.episodes(entry, "random", NOMINAL)
        trained = [found.training(entry, record["seed"]) for record in records]
        steps, took = (np.mean([float(one[what]) for one in trained if one]) for what in ("steps", "took_s"))
        crashes = 100 * float(interquartile_mean(np.array([figures(one, "crashed").mean() for one in records])))
        rows.append(
            (link(entry), entry.recipe.algorithm.upper(), len(records), percent(records),
             percent(of_seeds(found, entry, ESTIMATE)), percent(of_seeds(found, entry, UNSEEN)),
             f"{crashes:.1f}", returns(records),
             "{} ± {}".format(*shipped.mean(drawn["reward"])) if drawn else "", f"{steps:,.0f}", f"{took:.0f} s")
        )  # fmt: skip
    heads = ("policy", "algorithm", "trainings", "success [%]", "by the estimate [%]", "in unseen worlds [%]",
             "crashes [%]", "return", "random policy", "training steps", "training time")  # fmt: skip
    return table(heads, rows, 2)


def suites(found: Campaign) -> str:
    """Over all tasks: those that have as many trainings as are wanted."""
    rows = []
    groups = {
        "continuous actions": lambda name: not name.endswith(baselines.DISCRETE),
        "discrete actions": lambda name: name.endswith(baselines.DISCRETE),
        "all": lambda name: True,
    }
    for title, fits in groups.items():
        scores = []
        for entry in found.chosen:
            records = of_seeds(found, entry, NOMINAL)
            if not entry.is_variant and fits(entry.name) and len(records) == found.seeds:
                scores.append([figures(record, "reached").mean() for record in records])
        if scores:
            value, low, high = (100 * one for one in suite_interval(np.array(scores)))
            rows.append((title, len(scores), found.seeds, f"{value:.1f} ({low:.1f} .. {high:.1f})"))
    return table(("tasks with", "tasks", "trainings of each", "success [%], interquartile mean"), rows)


def elsewhere(found: Campaign, kind: str) -> str:
    """Baselines of a kind of vehicle in other conditions; variants below their plain ones."""
    conditions = (key for key, one in CONDITIONS.items() if one.group == ROBUST and kind in one.kinds)
    whats = [NOMINAL, *conditions, *AUTOPILOTS]
    rows: list[tuple[str, ...]] = []
    for entry in sorted(found.chosen, key=lambda one: (one.plain, one.is_variant)):
        cells = [of_seeds(found, entry, what) for what in whats]
        if entry.name.startswith(kind) and any(cells[1:]):
            rows.append((f"`{entry.name}`", str(max(map(len, cells))), *map(percent, cells)))
    used = [k for k in range(2, 2 + len(whats)) if any(cells[k] for cells in rows)]
    heads = ("policy", "trainings", *(named(what).title for what in whats))
    shown = [0, 1, *used]
    return table([heads[k] for k in shown], [[cells[k] for k in shown] for cells in rows])


def autopilots(found: Campaign) -> str:
    """Policies on the programs of other autopilots, beside the same episodes on ours."""
    rows = []
    for entry in found.chosen:
        seed = found.flown_seed(entry)
        ours = found.episodes(entry, seed, NOMINAL)
        real = [found.episodes(entry, seed, what) for what in AUTOPILOTS]
        if entry.is_variant or ours is None or not any(real):
            continue
        count = max(len(one["reached"]) for one in real if one)
        same = {**ours, "reached": ours["reached"][:count], "crashed": ours["crashed"][:count]}
        cells = (_counted(one) for one in (same, *real))
        rows.append((f"`{entry.name}`", percent([ours]), *cells))
    heads = ("policy", f"ours, {named(NOMINAL).episodes} episodes [%]", "ours, the same episodes")
    return table((*heads, *(named(what).title for what in AUTOPILOTS)), rows)


def _counted(record: Record | None) -> str:
    """Successes, and crashes where there are any."""
    if record is None:
        return ""
    crashes = record["crashed"].count("1")
    crashed = f", {crashes} crashed" if crashes else ""
    return f"{record['reached'].count('1')} of {len(record['reached'])}{crashed}"


def tables(found: Campaign) -> dict[str, str]:
    """Mark on the page of baselines -> what stands there."""
    return {
        "results": results(found),
        "suites": suites(found),
        **{f"{ROBUST} {kind}": elsewhere(found, kind) for kind in KINDS},
        "defaults": table(("id", "PPO", "SAC, or DQN of discrete actions"), defaults.table_rows(found), 3),
    }


def write(found: Campaign) -> None:
    """Put all tables on their pages."""
    fill(PAGE, tables(found))
    fill(REAL_PAGE, {"autopilots": autopilots(found)})


def fill(page: Path, made_of: Mapping[str, str]) -> None:
    """Put tables between their marks on a page."""
    text = page.read_text(encoding="utf-8")
    for what, made in made_of.items():
        between = re.compile(rf"(<!-- {re.escape(what)} -->\n).*?(<!-- /{re.escape(what)} -->)", re.DOTALL)
        text = between.sub(lambda at, made=made: f"{at[1]}\n{made}\n\n{at[2]}", text)  # type: ignore[misc]
    write_bytes(page, text.encode())


def ship(found: Campaign, say: Callable[[str], None]) -> None:
    """Make the median training of each baseline the policy that the package contains, and its figures the pages'."""
    rows = shipped.kept()
    for entry in found.chosen:
        records = {record["seed"]: record for record in of_seeds(found, entry, NOMINAL)}
        if entry.is_variant or not records:
            continue
        seed = shipped.median({
            seed: (float(figures(one, "reached").mean()), float(figures(one, "reward").mean()))
            for seed, one in records.items()
        })  # fmt: skip
        if figures(records[seed], "reached").mean() < LEARNT:
            say(f"{entry.name}: seed {seed} has not learnt its task; the policy in the package stays")
            continue
        training = found.training(entry, seed)
        assert training is not None
        if training["key"] != shipped.key_of(entry.name):
            job = work.Job(entry.name, seed, (), False, found.references.digest(entry.plain), found.runs)
            if not job.policy.exists():
                say(f"{entry.name}: seed {seed} is trained again, because its policy is not in {job.policy.parent}")
                work.train(job, lambda message: None, lambda: False)
            if work.sha256(job.policy) != training["policy"]:
                say(f"{entry.name}: seed {seed} gives another policy here than the one with these results; it stays")
                continue
            write_bytes(baselines.file(entry.name), job.policy.read_bytes())
        rows[entry.name] = _row(found, entry, training, records[seed], len(records))
    shipped.write(rows)


def _row(found: Campaign, entry: Entry, training: Record, record: Record, trainings: int) -> dict[str, Any]:
    drawn = found.episodes(entry, "random", NOMINAL)
    return {
        "env": entry.env, "recipe": entry.recipe.name, "algorithm": entry.recipe.algorithm,
        "steps": entry.recipe.steps or 0, "episodes": len(record["reward"]), "seed": SEED,
        "reward": shipped.mean(record["reward"]), "solved": record["reached"].count("1"),
        "crashed": record["crashed"].count("1"),
        "drawn": shipped.mean(drawn["reward"]) if drawn else (math.nan, math.nan),
        "learnt_s": training["took_s"], "key": training["key"], "training": training["seed"], "trainings": trainings,
    }  # fmt: skip
