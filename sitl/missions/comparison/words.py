# SPDX-License-Identifier: BSD-3-Clause
"""Times and differences in words: "12.4 s after item 3: 0.8 m east of the golden position"."""

from __future__ import annotations

import math

import numpy as np

from sitl.core.sums import lengths

from .alignment import START_NAMES, Pair
from .events import ADDED, MISSING, Event
from .flight import Series

_NED = (("north", "south"), ("east", "west"), ("below", "above"))


def when(pair: Pair, t: float) -> str:
    """A time [s] relative to the new flight's last event."""
    before = [(at, f"item {seq}") for at, seq in pair.new.items if at <= t]
    before += [(at, f"mode {mode}") for at, mode in pair.new.modes if 0.0 < at <= t]
    since, what = max(before, default=(0.0, START_NAMES[pair.align]), key=lambda event: event[0])
    return f"{t - since:.1f} s after {what}"


def direction(gap: np.ndarray, of: str) -> str:
    """ "0.80 m east of the golden path", "0.51 m south of and 0.43 m above the golden path": the parts that matter.

    Args:
        gap: NED (3,) [m].
        of: what it is from.
    """
    size = float(lengths(gap))
    parts = [
        f"{abs(value):.2f} m {names[0 if value > 0 else 1]}"
        for value, names in zip(gap, _NED, strict=True)
        if abs(value) >= 0.4 * size
    ]
    is_vertical = [part.endswith(_NED[2]) for part in parts]
    if any(is_vertical) and len(parts) > 1:
        parts = [" and ".join(parts[:-1]) + " of", parts[-1]]
    return " and ".join(parts) + (" " if any(is_vertical) else " of ") + of


def deviation(series: Series, k: int) -> str:
    """Sample ``k`` of a difference, in words."""
    value = float(series.values[k])
    if series.gap is not None:
        return direction(series.gap[k], "the golden " + ("position" if series.name == "position" else "path"))
    size, later = abs(value), "later" if value > 0 else "earlier"
    return {
        "altitude": f"{size:.2f} m {'above' if value > 0 else 'below'} the golden path",
        "delay": f"{size:.2f} s {later} than the golden flight at the same point of the path",
        "speed": f"{size:.2f} m/s {'faster' if value > 0 else 'slower'} than the golden flight",
        "climb": f"climb rate {size:.2f} m/s {'higher' if value > 0 else 'lower'} than in the golden flight",
        "tilt": f"roll and pitch differ by {size:.1f} deg",
        "heading": f"heading {size:.1f} deg {'right' if value > 0 else 'left'} of the golden heading",
    }[series.name]


def event_text(event: Event, difference: str) -> str:
    """How an event of the new flight differs from golden, in words."""
    if difference == MISSING:
        return f"{event.what} is missing (golden: at {event.golden or 0.0:.1f} s)"
    if difference == ADDED:
        return f"{event.what} is new"
    later = "later" if event.shift > 0 else "earlier"
    return f"{event.what} comes {abs(event.shift):.2f} s {later} than in the golden flight"


def number(value: float, unit: str) -> str:
    """A value with its unit."""
    if not math.isfinite(value):
        return "-"
    digits = 1 if unit == "deg" else 3 if 0.0 < value < 0.1 else 2
    return f"{value:.{digits}f} {unit}" if unit else f"{value:g}"
