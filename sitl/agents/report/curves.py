# SPDX-License-Identifier: BSD-3-Clause
"""Learning curves: of a run as the paper drew them (raw and averaged), and of many runs side by side."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import cycle, product
from pathlib import Path
from typing import Any

import numpy as np

from sitl.core.whole_file import whole_file
from sitl.errors import MissingExtra

from ..errors import AgentError
from ..runs.folder import RunFolder
from .document import BLOCK, Floats, block_means, moving_mean, rewards_of
from .statistics import mean_interval

COLOURS = ("#1f77b4", "#d62728", "#2ca02c", "#ff7f0e", "#9467bd", "#8c564b", "#17becf", "#7f7f7f")
_LINES = ("-", "--", ":", "-.")


def styles() -> Iterator[tuple[str, str]]:
    """Distinct pairs of colour and line style, without end."""
    return cycle((colour, line) for line, colour in product(_LINES, COLOURS))


def figure(width: float = 9.0, height: float = 5.0, rows: int = 1, columns: int = 1, **options: Any) -> Any:
    """A figure that needs no screen, and its axes, an array of shape (rows, columns); width, height [inch].

    Raises:
        MissingExtra: matplotlib is not installed.
    """
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        raise MissingExtra("pictures need matplotlib: pip install 'gym-sitl[report]'") from None
    made = Figure((width, height), layout="constrained")
    FigureCanvasAgg(made)
    return made, made.subplots(rows, columns, squeeze=False, **options)


def fit_to_lines(axes: Any) -> None:
    """Limits of y by the lines on axes, with a quarter of their extent around; wide bands do not squeeze them."""
    drawn = [float(y) for line in axes.get_lines() for y in line.get_ydata()]
    lowest, highest = min(drawn), max(drawn)
    around = 0.25 * (highest - lowest) or 0.05 * abs(highest) or 1.0
    axes.set_ylim(lowest - around, highest + around)


def save(made: Any, path: Path) -> Path:
    """Write it as PNG, whole or not at all; returns the path.

    Raises:
        AgentError: it cannot be written.
    """
    with whole_file(path, AgentError) as beside:
        made.savefig(beside, format="png", dpi=110, metadata={"Software": None})
    return path


def draw_raw(axes: Any, rewards: Floats, title: str, block: int = BLOCK) -> None:
    """One run on axes: each episode in blue, means of blocks in red, as the paper's figures."""
    axes.plot(rewards, color=COLOURS[0], linewidth=0.5, label="each episode")
    means = block_means(rewards, block)
    middles = np.minimum(np.arange(len(means)) * block + 0.5 * block, len(rewards) - 1)
    axes.plot(middles, means, color=COLOURS[1], linewidth=2.0, marker=".", label=f"mean of {block} episodes")
    axes.set(title=title, xlabel="episode", ylabel="reward")
    axes.grid(alpha=0.3)
    axes.legend(loc="upper left")


def draw_run(runs: Sequence[RunFolder], path: Path, block: int | None = None) -> Path:
    """The curve of a run, or of the first run of a group beside the mean of all.

    Raises:
        AgentError: no episodes yet, or it cannot be written.
        MissingExtra: matplotlib is not installed.
    """
    rewards = rewards_of(runs)
    block = block or min(BLOCK, max(rewards.shape[1] // 15, 1))
    config = runs[0].config
    made, axes = figure(columns=1 if len(runs) == 1 else 2, width=9.0 if len(runs) == 1 else 14.0)
    draw_raw(axes[0, 0], rewards[0], f"{config.env}, {config.algorithm}, seed {config.seed}", block)
    if len(runs) > 1:
        draw_means(axes[0, 1], {f"mean of {len(runs)} seeds": rewards}, block)
    return save(made, path)


def draw_means(axes: Any, groups: Mapping[str, Floats], window: int = BLOCK) -> None:
    """Moving means of groups of runs: the mean over seeds with its 95 % interval.

    A point is the mean of the ``window`` episodes that end there; there is none before so many are done. Intervals of
    few seeds are wide: the axis goes by the means.
    """
    for (colour, style), (name, rewards) in zip(styles(), groups.items()):
        first = min(window, rewards.shape[1])
        smooth = moving_mean(rewards, window)[:, first - 1 :]
        mean, half = mean_interval(smooth)
        episodes = np.arange(first, first + smooth.shape[1])
        axes.plot(episodes, mean, color=colour, linestyle=style, label=name, marker="." if len(episodes) == 1 else "")
        if len(rewards) > 1:
            axes.fill_between(episodes, mean - half, mean + half, color=colour, alpha=0.2, linewidth=0)
    fit_to_lines(axes)
    axes.set(xlabel="episode", ylabel=f"reward, mean of {window} episodes")
    axes.grid(alpha=0.3)
    axes.legend(loc="upper left")
