# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of a twin's report: the path from above, quantities over time, open segments."""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import Any

import numpy as np

from sitl.logs.plot import new_figure

from .agreement import Agreement
from .streams import Quantity
from .twin import Twin

Array = np.ndarray[Any, Any]

LOGGED, FLOWN, CHANGED = "#b8860b", "#1f5fa8", "#c0392b"
_WIDE, _DPI, _ROW = 11.0, 100, 1.35
_HIDDEN = ("position", "consumed")
_MOST_POINTS = 4000
_OPEN = ("roll", "pitch", "roll_rate", "pitch_rate", "yaw_rate", "climb", "acceleration", "motors")


def _png(figure: Any) -> bytes:
    out = io.BytesIO()
    figure.savefig(out, dpi=_DPI, format="png")
    return out.getvalue()


def _quiet(axis: Any) -> None:
    axis.grid(alpha=0.25, lw=0.6)
    axis.tick_params(labelsize=9, color="#888")
    for side in ("top", "right"):
        axis.spines[side].set_visible(False)
    for side in ("left", "bottom"):
        axis.spines[side].set_color("#999")


def _of(agreements: Sequence[Agreement], name: str) -> Agreement | None:
    return next((one for one in agreements if one.quantity.name == name), None)


def plan(twin: Twin) -> bytes:
    """The paths from above. PNG bytes."""
    whole, changed = _of(twin.whole, "position"), _of(twin.difference, "position")
    figure = new_figure(_WIDE, 5.5)
    axis = figure.subplots()
    if whole is not None:
        axis.plot(whole.logged[:, 1], whole.logged[:, 0], color=LOGGED, lw=5, alpha=0.4, label="logged")
        axis.plot(whole.flown[:, 1], whole.flown[:, 0], color=FLOWN, lw=1.4, label="twin")
        axis.plot(*whole.logged[0, ::-1], "s", ms=6, color="#222", label="armed here")
    if changed is not None:
        axis.plot(changed.flown[:, 1], changed.flown[:, 0], color=CHANGED, lw=1.2, ls="--", label="changed twin")
    axis.set_aspect("equal", adjustable="datalim")
    axis.margins(0.08)
    axis.set(xlabel="east of where it was armed [m]", ylabel="north [m]")
    axis.legend(loc="best", fontsize=10, framealpha=0.9)
    _quiet(axis)
    return _png(figure)


def _mean(quantity: Quantity, values: Array) -> Array:
    """One line of a quantity: the mean of motors; a heading goes on beyond a full turn."""
    line = np.unwrap(values[:, 0], period=360.0) if quantity.is_angle else values.mean(1)
    return line - 360.0 * np.floor(line[0] / 360.0 + 0.5) if quantity.is_angle and len(line) else line


def _thin(*lines: Array) -> tuple[Array, ...]:
    step = max(len(lines[0]) // _MOST_POINTS, 1)
    return tuple(line[::step] for line in lines)


def flown(twin: Twin) -> bytes:
    """Each quantity that moves over time: logged, of the twin, of the changed twin. PNG bytes; empty: there is none."""
    shown = [one for one in twin.whole if one.quantity.name not in _HIDDEN and not one.quantity.is_asked]
    if not shown:
        return b""
    figure = new_figure(_WIDE, _ROW * len(shown) + 0.6)
    axes = np.atleast_1d(figure.subplots(len(shown), 1, sharex=True))
    for axis, one in zip(axes, shown, strict=True):
        logged, line = _mean(one.quantity, one.logged), _mean(one.quantity, one.flown)
        time, logged, line = _thin(one.time, logged, line)
        axis.plot(time, logged, color=LOGGED, lw=3.0, alpha=0.45, label="logged")
        axis.plot(time, line, color=FLOWN, lw=1.0, label="twin")
        changed = _of(twin.difference, one.quantity.name)
        if changed is not None:
            time, line = _thin(changed.time, _mean(one.quantity, changed.flown))
            axis.plot(time, line, color=CHANGED, lw=0.9, ls="--", label="changed twin")
        axis.set_ylabel(_label(one.quantity), fontsize=9)
        _quiet(axis)
    handles = max((axis.get_legend_handles_labels() for axis in axes), key=lambda pair: len(pair[0]))
    _legend_above(axes[0], *handles)
    figure.align_ylabels(axes)
    axes[-1].set_xlabel("time since arming [s]", fontsize=10)
    return _png(figure)


def _legend_above(axis: Any, handles: Sequence[Any], labels: Sequence[str]) -> None:
    """Where it hides no line."""
    axis.legend(handles, labels, loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3, fontsize=9, frameon=False)


def _label(quantity: Quantity) -> str:
    words = quantity.title.replace(" above the position of arming", "").replace("upward ", "up ")
    return f"{words}\n[{quantity.unit}]"


def opened(twin: Twin) -> bytes:
    """Open segments: each begins in the logged state. PNG bytes; empty: no quantity has any."""
    shown = [one for name in _OPEN if (one := _of(twin.segments, name)) is not None]
    if not shown:
        return b""
    figure = new_figure(_WIDE, _ROW * len(shown) + 0.6)
    axes = np.atleast_1d(figure.subplots(len(shown), 1, sharex=True))
    for axis, one in zip(axes, shown, strict=True):
        logged, line = _mean(one.quantity, one.logged), _mean(one.quantity, one.flown)
        axis.plot(*_thin(one.time, logged), color=LOGGED, lw=3.0, alpha=0.45, label="logged")
        number = np.searchsorted(twin.begins, one.time + 1e-3)
        for k in np.unique(number):
            axis.plot(one.time[number == k], line[number == k], color=FLOWN, lw=1.0)
        for begin in twin.begins:
            axis.axvline(begin, color="#777", lw=0.5, alpha=0.5)
        axis.set_ylabel(_label(one.quantity), fontsize=9)
        _quiet(axis)
    axes[0].plot([], [], color=FLOWN, lw=1.0, label="twin, from the logged state at each grey line")
    _legend_above(axes[0], *axes[0].get_legend_handles_labels())
    figure.align_ylabels(axes)
    axes[-1].set_xlabel("time since arming [s]", fontsize=10)
    return _png(figure)
