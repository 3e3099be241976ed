# SPDX-License-Identifier: BSD-3-Clause
"""Turns of 180 degrees, which both ways round are as long: which way a vehicle takes is decided by a degree of its
heading, so the twin may take the other one. That tells nothing of airframe or autopilot.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from .agreement import Window
from .flight_log import FlightLog
from .streams import QUANTITIES, Stream

Array = np.ndarray[Any, Any]

_STEP_S = 0.1
_TURNS = 5.0
"""A vehicle that turns slower keeps its heading [deg/s]."""
_HALF, _ABOUT = 180.0, 10.0
"""What is a half turn: 180 degrees, by so much more or less."""
_AROUND_S = 0.5
"""Begins and ends slowly."""
_BEFORE_S = 0.05
"""At the end of a window an open segment is put into the next state."""
_MOVED = 5.0
"""What both turn at least in a stretch of which the direction is compared [deg]."""


class HalfTurn(NamedTuple):
    """A half turn of a flight."""

    begin: float
    end: float
    """Since arming [s]."""
    by: float
    """Clockwise [deg]."""


def heading(log: FlightLog) -> Stream | None:
    """Of a flight, going on beyond a full turn [deg]; None: it has too little of it."""
    quantity = next(one for one in QUANTITIES[log.kind] if one.name == "yaw")
    found = quantity.of(log)
    if found is None or len(found.time) < 2:
        return None
    return Stream(found.time, np.degrees(np.unwrap(np.radians(found.values), axis=0)))


def half_turns(course: Stream) -> list[HalfTurn]:
    """Those of a flight, in the order of time.

    Args:
        course: the heading, as ``heading`` gives it.
    """
    time = np.arange(course.time[0], course.time[-1], _STEP_S)
    rate = np.diff(np.interp(time, course.time, course.values[:, 0])) / _STEP_S
    sign = np.where(np.abs(rate) > _TURNS, np.sign(rate), 0.0)
    edges = np.flatnonzero(np.diff(np.concatenate(([0.0], sign, [0.0]))))
    found = []
    for first, last in itertools.pairwise(edges):
        if sign[first] == 0.0:
            continue
        begin, end = float(time[first]) - _AROUND_S, float(time[last]) + _AROUND_S
        by = turned(course, begin, end)
        if abs(abs(by) - _HALF) < _ABOUT:
            found.append(HalfTurn(begin, end, by))
    return found


def turned(course: Stream, begin: float, end: float) -> float:
    """By how much a vehicle turned between two times [deg]."""
    before, after = np.interp((begin, end), course.time, course.values[:, 0])
    return float(after - before)


def opposite_turns(course: Stream | None, twin: Stream | None, windows: Sequence[Window]) -> list[HalfTurn]:
    """Half turns of a log's flight that its twin made the other way round, as long as one of the two is at it.

    Args:
        course, twin: headings of the two, as ``heading`` gives them.
        windows: the log's time, and how much later the twin does the same.
    """
    if course is None or twin is None:
        return []
    found = []
    for turn in half_turns(course):
        for window in windows:
            begin, end = max(window.begin, turn.begin), min(window.end - _BEFORE_S, turn.end)
            if end <= begin:
                continue
            by, here = (turned(one, begin + at, end + at) for one, at in ((course, 0.0), (twin, window.shift)))
            if by * here < 0.0 and min(abs(by), abs(here)) > _MOVED:
                late = window.shift
                found.append(turn._replace(begin=turn.begin + min(late, 0.0), end=turn.end + max(late, 0.0)))
                break
    return found


def without(windows: Sequence[Window], turns: Sequence[HalfTurn], whole: bool) -> list[Window]:
    """Windows less the time of half turns.

    Args:
        windows: of the log's time.
        turns: that do not count.
        whole: leave out a window as a whole where a turn is in it.
    """
    found = list(windows)
    for turn in turns:
        rest = []
        for window in found:
            if turn.end <= window.begin or turn.begin >= window.end:
                rest.append(window)
            elif not whole:
                parts = (window._replace(end=turn.begin), window._replace(begin=turn.end))
                rest += [part for part in parts if part.end > part.begin]
        found = rest
    return found


def words(turns: Sequence[HalfTurn], where: str = "") -> list[str]:
    """What the report says of them."""
    if not turns:
        return []
    at = ", ".join(f"{turn.begin:.0f} s" for turn in turns)
    return [
        f"{where}the twin turns by 180 deg the other way round than the log's vehicle (at {at}): both ways are as "
        "long, and a degree of heading decides. Heading and turn rate do not count meanwhile"
    ]
