# SPDX-License-Identifier: BSD-3-Clause
"""The report of a rehearsal: for each change how much of the reward transfers, runs side by side."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from sitl.envs.randomisation import DRAWS
from sitl.envs.robots.boots import SINGLE

from ..report import curves
from ..report.document import Document
from ..report.sections import write_csv
from ..runs.files import make_folder
from .change import GROUPS
from .rehearse import Rehearsed, Tried
from .transfer_ratio import Ratio, mean_of
from .trial import MARGIN

CHANGES = (
    "section", "run", "change", "group", "mean_reward", "share", "low", "high", "crash_share", "false_alarm_share",
    "above_first", "above_first_low", "above_first_high", "seen", "refused",
)  # fmt: skip
EPISODES = ("section", "run", "run_seed", "change", "seed", "episode", "reward", "crashed", "false_alarm")


def write_changes(path: Path, sections: Mapping[str, Sequence[Rehearsed]]) -> None:
    """A row for each run and change, and one for each run at home. The first run is not held against itself.

    Raises:
        AgentError: it cannot be written.
    """
    rows: list[Sequence[Any]] = []
    for title, rehearsed in sections.items():
        for one in rehearsed:
            rows.append((title, one.name, "home", "", one.home.mean, 1.0, 1.0, 1.0, *_parts(one.home), *4 * [""], ""))
            advantages = [None] * len(one.changes) if one is rehearsed[0] else one.advantages(rehearsed[0])
            for change, tried, share, above in zip(one.changes, one.tried, one.transfer_ratios(), advantages):
                values: Sequence[Any] = ("",) * 6 if share is None else (tried.mean, *share, *_parts(tried))
                last = (*(above or ("", "", "")), int(tried.seen), tried.refused)
                rows.append((title, one.name, change.name, change.group, *values, *last))
    write_csv(path, CHANGES, rows)


def write_episodes(path: Path, sections: Mapping[str, Sequence[Rehearsed]], seed: int) -> None:
    """A row for each episode.

    Args:
        path: path of the file.
        sections: title -> runs.
        seed: seed that the episodes were played with.

    Raises:
        AgentError: it cannot be written.
    """
    rows = (
        (title, one.name, run.config.seed, name, seed, episode, float(reward), int(crash), int(false))
        for title, rehearsed in sections.items()
        for one in rehearsed
        for name, tried in [("home", one.home), *zip([change.name for change in one.changes], one.tried)]
        for run, *values in zip(one.runs, tried.rewards, tried.crashed, tried.false_alarms)
        for episode, (reward, crash, false) in enumerate(zip(*values))
    )
    write_csv(path, EPISODES, rows)


def _parts(tried: Tried) -> tuple[float, float]:
    """Fractions of the episodes that ended in a crash, and in a false one."""
    return float(tried.crashed.mean()), float(tried.false_alarms.mean())


SEEN = " (seen)"
WEAK = 0.2
"""Fraction of crashes without a change above which the report warns."""
_LINE = 0.32
"""Height of a change in the picture [inch]."""


def write_report(sections: Mapping[str, Sequence[Rehearsed]], folder: Path, seed: int = 0) -> Path:
    """Write report.md, report.html, a picture a section, rehearsal.csv (a row a change) and episodes.csv.

    Args:
        sections: title -> runs side by side, all under the same changes.
        folder: for the files.
        seed: seed that the episodes were played with.

    Returns:
        path of the Markdown.

    Raises:
        AgentError: a file cannot be written.
        MissingExtra: matplotlib is not installed.
    """
    make_folder(folder)
    document = Document("Mental rehearsal")
    document.paragraph(
        "What was learnt in one simulation, at home, plays in others that it has not seen. The share is the mean "
        "reward under a change by that at home, of the same episodes (starts and seeds); in brackets its 95 % "
        "bootstrap interval over episodes, and over seeds where there are several; episodes that began with the same "
        "boot of the vehicle count as one draw. A reward below 0 gives a negative "
        "share. A crash is false when noise alone made a reading one: nothing was touched, and nothing stood within "
        f"the crash range and {100 * MARGIN:.0f} cm."
    )
    for title, rehearsed in sections.items():
        document.heading(title)
        _section(document, folder, title, rehearsed)
    write_changes(folder / "rehearsal.csv", sections)
    write_episodes(folder / "episodes.csv", sections, seed)
    return document.write(folder)


def _section(document: Document, folder: Path, title: str, rehearsed: Sequence[Rehearsed]) -> None:
    document.table(
        ["run", "environment", "algorithm", "seeds", "episodes a seed", "trained with", "reward at home", "crashes"],
        [_about(one) for one in rehearsed],
    )
    cautions = _cautions(rehearsed)
    if cautions:
        document.points(cautions)
    document.table(*_table(rehearsed))
    refused = {(c.name, t.refused): None for one in rehearsed for c, t in zip(one.changes, one.tried) if t.refused}
    if refused:
        document.paragraph("Not played:")
        document.points([f"{name}: {why}" for name, why in refused])
    document.paragraph("Means over the changes of each group, each change counting the same:")
    document.table(*_groups(rehearsed))
    if any(one.changes for one in rehearsed):
        name = "".join(c if c.isalnum() else "-" for c in title.lower())
        document.picture(draw(folder / f"{name}.png", rehearsed), f"share of the reward that transfers, {title}")


def _about(one: Rehearsed) -> list[str]:
    config = one.runs[0].config
    randomised = config.env_options.get("randomise")
    drawn_names = [name for name in randomised or () if name != DRAWS]
    drawn = ", ".join(drawn_names) or "one simulation"
    home = one.home
    seeds, episodes = home.rewards.shape
    return [
        one.name, config.env, config.algorithm, str(seeds), str(episodes), drawn, _reward(home.mean), crashes(home),
    ]  # fmt: skip


def _table(rehearsed: Sequence[Rehearsed]) -> tuple[list[str], list[list[str]]]:
    head = ["change", "group"]
    for one in rehearsed:
        label = f"{one.name}: " if len(rehearsed) > 1 else ""
        head += [f"{label}reward", f"{label}share", f"{label}crashes"]
    head += [f"{one.name} - {rehearsed[0].name}" for one in rehearsed[1:]]
    ratios = [one.transfer_ratios() for one in rehearsed]
    advantages = [one.advantages(rehearsed[0]) for one in rehearsed[1:]]
    rows = []
    for k, change in enumerate(rehearsed[0].changes):
        row = [change.name, change.group]
        for one, found in zip(rehearsed, ratios):
            tried, its = one.tried[k], found[k]
            if its is None:
                row += ["", "not played", ""]
            else:
                row += [_reward(tried.mean), percent(its) + (SEEN if tried.seen else ""), crashes(tried)]
        above = (some[k] for some in advantages)
        rows.append([*row, *("" if its is None else percent(its) for its in above)])
    return head, rows


def _groups(rehearsed: Sequence[Rehearsed]) -> tuple[list[str], list[list[str]]]:
    """Head and rows of the table of means over the changes: of each group, of all, and of those that no training
    covered."""
    changes = rehearsed[0].changes
    played = [k for k in range(len(changes)) if not any(one.tried[k].refused for one in rehearsed)]
    unseen = [k for k in played if not any(one.tried[k].seen for one in rehearsed)]
    lines = {group: [k for k in played if changes[k].group == group] for group in GROUPS}
    lines.update({"all changes": played, **({"all unseen": unseen} if unseen != played else {})})
    head = ["group", "changes"]
    for one in rehearsed:
        label = f"{one.name}: " if len(rehearsed) > 1 else ""
        head += [f"{label}reward", f"{label}share"]
    rows = []
    for title, numbers in lines.items():
        if not numbers:
            continue
        row = [title, str(len(numbers))]
        for one in rehearsed:
            ratios, value = one.transfer_ratios(), float(np.mean([one.tried[k].mean for k in numbers]))
            part = mean_of([ratios[k] for k in numbers])
            row += [_reward(value), "-" if math.isnan(part) else f"{_whole(part)} %"]
        rows.append(row)
    return head, rows


def _cautions(rehearsed: Sequence[Rehearsed]) -> list[str]:
    """Cautions for the reader, before the results."""
    out = []
    weak = [one.name for one in rehearsed if one.home.crashed.mean() > WEAK]
    if weak:
        out.append(
            f"At home, too, {' and '.join(weak)} crashed in more than {100 * WEAK:.0f} % of the episodes: what is not "
            "learnt cannot transfer, and such shares say little (they may be above 100 %)."
        )
    poor = [one.name for one in rehearsed if one.home.mean <= 0.0]
    if poor:
        out.append(f"At home {' and '.join(poor)} earned nothing (a mean reward of 0 or less): no share, written as -.")
    if any(len(one.runs) == 1 for one in rehearsed):
        out.append(
            "Where there is one seed the intervals do not hold the luck of training: another seed of the same run may "
            "lie far outside of them."
        )
    once = [one.name for one in rehearsed if {*one.home.boots} == {SINGLE}]
    if once:
        out.append(
            f"All episodes of {' and '.join(once)} begin with one and the same boot, and so with the same error of the "
            "estimate: the intervals do not hold how much boots differ (--boots 64 does)."
        )
    if len(rehearsed) > 1:
        first = rehearsed[0].name
        out.append(
            f"A share is of a run's own home: a run that earns less everywhere can still have the greater share. The "
            f"last columns hold the runs against each other: reward above that of {first} under the same change, as a "
            f"share of the reward of {first} at home."
        )
    if any(tried.seen for one in rehearsed for tried in one.tried):
        out.append(f"{SEEN.strip()}: the randomisation of the training covers the change, so that it was not unseen.")
    return out


def _reward(value: float) -> str:
    """Three digits at least: rewards of 17.26 and 17.32 are not the same."""
    return f"{value:.{0 if abs(value) >= 100.0 else 1 if abs(value) >= 10.0 else 2}f}"


def crashes(tried: Tried) -> str:
    """Number of crashes, and how many of them were by a reading only."""
    text, false_alarms = f"{int(tried.crashed.sum())} of {tried.crashed.size}", int(tried.false_alarms.sum())
    return f"{text} ({false_alarms} false)" if false_alarms else text


def percent(ratio: Ratio) -> str:
    """A ratio and its interval in percent, as text."""
    if math.isnan(ratio.value):
        return "-"
    return f"{_whole(ratio.value)} % ({_whole(ratio.low)} .. {_whole(ratio.high)})"


def _whole(part: float) -> str:
    """A ratio in percent; never -0."""
    return "-" if math.isnan(part) else str(round(100.0 * part))


def draw(path: Path, rehearsed: Sequence[Rehearsed]) -> Path:
    """Transfer ratios as dots with their intervals, a line a change, a colour a run."""
    changes = rehearsed[0].changes
    made, axes = curves.figure(9.0, 1.2 + _LINE * len(changes) * (1.0 + 0.25 * (len(rehearsed) - 1)))
    ax = axes[0, 0]
    lines = np.arange(len(changes), dtype=float)
    for number, (colour, one) in enumerate(zip(curves.COLOURS * 9, rehearsed)):
        offset = 0.6 * ((number + 0.5) / len(rehearsed) - 0.5)
        ratios = zip(lines, one.transfer_ratios())
        found = [(line, ratio) for line, ratio in ratios if ratio and not math.isnan(ratio.value)]
        values = np.array([ratio for _, ratio in found], float).reshape(-1, 3) * 100.0
        spread = np.abs(values[:, 1:] - values[:, :1]).T
        ax.errorbar(
            values[:, 0], [line + offset for line, _ in found], xerr=spread, fmt="o", color=colour, label=one.name,
            capsize=2.0, markersize=4.5, linewidth=1.2,
        )  # fmt: skip
    ax.axvline(100.0, color="black", linewidth=0.8)
    ax.axvline(0.0, color="grey", linewidth=0.5)
    ax.set_yticks(lines, [change.name for change in changes])
    ax.set(xlabel="share of the reward at home [%]", ylim=(len(changes) - 0.4, -0.6))
    ax.grid(axis="x", alpha=0.3)
    made.legend(loc="outside upper center", ncols=4)
    return curves.save(made, path)
