# SPDX-License-Identifier: BSD-3-Clause
"""Plots of a comparison: path from above, flight data over time, differences over time."""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import Any

import numpy as np

from sitl.logs.plot import new_figure
from sitl.vehicle.kinds import KINDS

from .compare import Comparison

GOLDEN, NEW, LIMIT = "#b8860b", "#1f5fa8", "#c0392b"
_WIDE = 11.0
_DPI = 110
_SHOWN = ("position", "cross_track", "altitude", "delay", "speed", "climb", "tilt", "heading")


def _png(figure: Any) -> bytes:
    out = io.BytesIO()
    figure.savefig(out, dpi=_DPI, format="png")
    return out.getvalue()


def _colours() -> Any:
    """Colour map from the new flight's blue to the red of limits."""
    from matplotlib.colors import LinearSegmentedColormap

    return LinearSegmentedColormap.from_list("distance", (NEW, "#7d4fa3", LIMIT))


def _quiet(axis: Any) -> None:
    axis.grid(alpha=0.25, lw=0.6)
    axis.tick_params(labelsize=10, color="#888")
    for side in ("top", "right"):
        axis.spines[side].set_visible(False)
    for side in ("left", "bottom"):
        axis.spines[side].set_color("#999")


def plan(comparison: Comparison) -> bytes:
    """Both paths from above; the new one is coloured by its distance from golden's. PNG bytes."""
    golden, new = comparison.pair.golden, comparison.pair.new
    cross = comparison.differences["cross_track"]
    limit = comparison.tolerance.limit("cross_track.max")
    top = max(limit if np.isfinite(limit) else 0.0, cross.max, 0.02)
    extent = [float(np.ptp(np.concatenate([golden[name], new[name]]))) + 2.0 for name in ("north", "east")]
    shape = extent[0] / extent[1]
    figure = new_figure(_WIDE, float(np.clip((_WIDE - 2.0) * shape, 4.0, 8.0)))
    from matplotlib.collections import LineCollection  # after new_figure, which says what is missing

    axis = figure.subplots()
    axis.plot(golden["east"], golden["north"], color=GOLDEN, lw=5, alpha=0.35, solid_capstyle="round", label="golden")
    points = np.stack([new["east"], new["north"]], axis=1)
    lines = LineCollection(
        list(np.stack([points[:-1], points[1:]], axis=1)), array=cross.size[:-1], cmap=_colours(), lw=1.8, zorder=3
    )
    lines.set_clim(0.0, top)
    axis.add_collection(lines)
    bar = figure.colorbar(lines, ax=axis, shrink=0.8, pad=0.01)
    bar.set_label("new: distance from the golden path [m]", fontsize=11)
    bar.ax.tick_params(labelsize=10)
    if np.isfinite(limit):
        bar.ax.axhline(limit, color=LIMIT, lw=1.5)
    for at, seq in new.items:
        north, east = (float(np.interp(at, new.t, new[name])) for name in ("north", "east"))
        axis.plot(east, north, "o", ms=4, color="#222", zorder=4)
        axis.annotate(str(seq), (east, north), textcoords="offset points", xytext=(5, 4), fontsize=10, color="#222")
    axis.plot(golden["east"][0], golden["north"][0], "s", ms=6, color="#222", label="start", zorder=4)
    if comparison.first is not None:
        north, east = (float(np.interp(comparison.first.t, new.t, new[name])) for name in ("north", "east"))
        label = "first divergence"
        axis.plot(east, north, "o", ms=13, mfc="none", mec=LIMIT, mew=2, ls="none", label=label, zorder=5)
    axis.set_aspect("equal", adjustable="datalim")
    axis.margins(0.08)
    axis.set(xlabel="east [m]", ylabel="north [m]")
    axis.legend(loc="best", fontsize=10, framealpha=0.9)
    _quiet(axis)
    return _png(figure)


def flown(comparison: Comparison) -> bytes:
    """Height, speed, attitude and energy of both flights over time. PNG bytes."""
    golden, new = comparison.pair.golden, comparison.pair.new

    def heading(track: Any) -> Any:
        values = np.degrees(track["yaw"])
        return np.where(np.abs(np.diff(values, prepend=values[:1])) > 180.0, np.nan, values)

    rows: list[tuple[str, Callable[[Any], Any]]] = [
        ("above home [m]", lambda track: -track["down"]),
        ("ground speed [m/s]", lambda track: np.hypot(track["vn"], track["ve"])),
        ("roll [deg]", lambda track: np.degrees(track["roll"])),
        ("pitch [deg]", lambda track: np.degrees(track["pitch"])),
        ("heading [deg]", heading),
        ("energy [Wh]", lambda track: track["energy"]),
    ]
    if not KINDS[new.kind].flies:
        del rows[2:4], rows[0]
    figure = new_figure(_WIDE, 1.6 * len(rows) + 0.4)
    axes = figure.subplots(len(rows), 1, sharex=True)
    for axis, (label, column) in zip(axes, rows, strict=True):
        axis.plot(golden.t, column(golden), color=GOLDEN, lw=3.2, alpha=0.45, label="golden")
        axis.plot(new.t, column(new), color=NEW, lw=1.1, label="new")
        axis.set_ylabel(label, fontsize=10)
        _events(axis, comparison)
        _quiet(axis)
    axes[0].legend(loc="upper right", ncols=2, fontsize=10, framealpha=0.9)
    figure.align_ylabels(axes)
    _name_items(axes[0], comparison)
    axes[-1].set_xlabel(f"simulated time since {_since(comparison)} [s]", fontsize=11)
    return _png(figure)


def differing(comparison: Comparison) -> bytes:
    """Each difference over time with its limit. PNG bytes."""
    shown = [comparison.differences[name] for name in _SHOWN]
    if not KINDS[comparison.pair.new.kind].flies:
        shown = [series for series in shown if np.isfinite(comparison.tolerance.limit(f"{series.name}.max"))]
    figure = new_figure(_WIDE, 1.6 * len(shown) + 0.4)
    axes = np.atleast_1d(figure.subplots(len(shown), 1, sharex=True))
    for axis, series in zip(axes, shown, strict=True):
        limit = comparison.tolerance.limit(f"{series.name}.max")
        is_bad = series.max > limit + 1e-9
        if is_bad:
            over = series.size > limit
            axis.fill_between(
                series.t, 0, 1, where=over, transform=axis.get_xaxis_transform(), color=LIMIT, alpha=0.1, lw=0
            )
        axis.plot(series.t, series.values, color=NEW, lw=1.1)
        signs = (limit, -limit) if series.values[np.isfinite(series.values)].min(initial=0.0) < 0.0 else (limit,)
        reach = 1.25 * max(series.max, 1e-3)
        if np.isfinite(limit):
            for value in signs:
                axis.axhline(value, color=LIMIT, lw=1.0, ls="--", alpha=0.8)
            reach = max(reach, 1.25 * limit) if series.max > 0.2 * limit else max(reach, 0.5 * limit)
        axis.set_ylim(-reach if len(signs) == 2 else -0.04 * reach, reach)
        axis.set_ylabel(f"{series.title}\n[{series.unit}]", fontsize=10, color=LIMIT if is_bad else "#222")
        _events(axis, comparison)
        _quiet(axis)
    figure.align_ylabels(axes)
    _name_items(axes[0], comparison)
    axes[-1].set_xlabel(f"simulated time since {_since(comparison)} [s]", fontsize=11)
    return _png(figure)


def _since(comparison: Comparison) -> str:
    return {"AUTO": "AUTO began", "armed": "arming", "start": "power-on"}[comparison.pair.align]


def _events(axis: Any, comparison: Comparison) -> None:
    new = comparison.pair.new
    for at, _ in new.items:
        axis.axvline(at, color="#666", lw=0.6, alpha=0.5)
    if comparison.first is not None:
        axis.axvline(comparison.first.t, color=LIMIT, lw=1.2, alpha=0.8)
    axis.set_xlim(0.0, max(float(new.t[-1]), float(comparison.pair.golden.t[-1])))


def _name_items(axis: Any, comparison: Comparison) -> None:
    """Label the mission items above a panel, as far as there is space."""
    new = comparison.pair.new
    last, spacing = -np.inf, 0.015 * max(float(new.t[-1]), 1.0)
    for at, seq in new.items:
        if at - last >= spacing:
            axis.annotate(
                str(seq), (at, 1.0), xycoords=("data", "axes fraction"), textcoords="offset points", xytext=(0, 2),
                fontsize=10, ha="center", color="#444",
            )  # fmt: skip
            last = at
