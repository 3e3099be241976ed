# SPDX-License-Identifier: BSD-3-Clause
"""The trails of episodes in their world, seen from above."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from sitl.worlds import World

from . import curves
from .driven import Floats

_PAPER, _WALL, _OTHER = "#fafaf7", "#3e444c", "#d5d9dd"
_TRAIL, _START, _CRASH = "#1f77b4", "#2ca02c", "#d62728"
_BORDER_M = 0.4
_OUTSIDE = 0.15
"""Margin that is shown where trails leave the world, as a fraction of its size."""
_MARGIN_M = 2.0
"""Margin around trails that fill a small part of a large world [m]."""
_HEIGHT, _WIDEST = 7.5, 13.0
"""Height and greatest width of the picture [inch]."""


def draw_trails(path: Path, world: World, trails: Sequence[Floats], crashed: Sequence[bool], title: str) -> Path:
    """Draw trails in a world; returns the path of the picture.

    Args:
        path: path of the picture, a PNG.
        world: world whose solids are drawn: dark those at the height of its plan, light those above or below it.
        trails: x, y [m], each of shape (n, 2).
        crashed: whether each ended in a crash.
        title: over the picture.

    Raises:
        MissingExtra: matplotlib is not installed.
    """
    low, high = _extent(world, trails)
    wide, tall = (high - low).tolist()
    width = min(max(_HEIGHT * wide / tall, 4.0), _WIDEST)
    made, axes = curves.figure(width, width * tall / wide + 0.3)
    ax = axes[0, 0]
    ax.set_facecolor(_PAPER)
    at = world.plan_height
    for solid in sorted(world.solids, key=lambda solid: solid.low <= at <= solid.high):
        inside = solid.low <= at <= solid.high
        xy = solid.footprint()
        ax.fill(xy[:, 0], xy[:, 1], color=_WALL if inside else _OTHER, linewidth=0.8, zorder=2 if inside else 1)
    alpha = float(np.clip(6.0 / max(len(trails), 1), 0.25, 0.8))
    for trail in trails:
        ax.plot(trail[:, 0], trail[:, 1], color=_TRAIL, alpha=alpha, linewidth=0.9, zorder=3)
    starts = np.array([trail[0] for trail in trails])
    ax.plot(*starts.T, "o", color=_START, markersize=5, zorder=4, label="start")
    ends = np.array([trail[-1] for trail, hit in zip(trails, crashed) if hit])
    if len(ends):
        ax.plot(*ends.T, "X", color=_CRASH, markeredgecolor="white", markersize=10, zorder=5, label="crash")
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), xlabel="x [m]", ylabel="y [m]", aspect="equal")
    ax.set_title(title, loc="left", fontsize=11)
    ax.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, frameon=False, borderaxespad=0.2)
    return curves.save(made, path)


def _extent(world: World, trails: Sequence[Floats]) -> tuple[Floats, Floats]:
    """Corners of the shown area [m]: the world, or the part of a large world with trails; of trails that lead far out
    of
    it, only the beginning."""
    x0, y0, x1, y1 = world.bounds
    border = max(_BORDER_M, _OUTSIDE * max(x1 - x0, y1 - y0))
    points = np.concatenate(trails)
    low, high = points.min(axis=0), points.max(axis=0)
    margin = np.where(low < (x0, y0), border, _BORDER_M), np.where(high > (x1, y1), border, _BORDER_M)
    return np.maximum(low - _MARGIN_M, (x0, y0) - margin[0]), np.minimum(high + _MARGIN_M, (x1, y1) + margin[1])
