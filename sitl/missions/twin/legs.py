# SPDX-License-Identifier: BSD-3-Clause
"""How far a mission had come, and two flights of it laid over each other item by item.

A leg's length and the vehicle's distance to its path decide when a waypoint counts as reached, so two flights of one
mission pass it at different times: a leg of a centimetre takes half a second, and the cube root of its length. From
then on the same moment of the mission is another moment of the flight.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from typing import NamedTuple

from sitl.logs.kind import mode_name

from .agreement import Window
from .flight_log import FlightLog

_BEGINS = re.compile(r"Mission: (\d+) ")
"""Text of ArduPilot's at the beginning of each item of a mission."""
_AUTO = "AUTO"
_SAME_S = 1e-3
"""Commands that take no time begin together."""


class Item(NamedTuple):
    """An item of a mission, the more often it was flown the higher its round."""

    number: int
    round: int


class Begun(NamedTuple):
    """The beginning of an item."""

    time: float
    """Since arming [s]."""
    item: Item


def begun(texts: Iterable[tuple[float, str]]) -> list[Begun]:
    """Items in the order in which they began; of those that began together the last.

    Args:
        texts: (time since arming [s], status text), in the order of time.
    """
    count: Counter[int] = Counter()
    found: list[Begun] = []
    for time, text in texts:
        match = _BEGINS.match(text)
        if match is None or time < 0.0:
            continue
        number = int(match[1])
        count[number] += 1
        if found and time - found[-1].time < _SAME_S:
            found.pop()
        found.append(Begun(time, Item(number, count[number])))
    return found


def begun_in(log: FlightLog) -> list[Begun]:
    """Items that began in a log's flight; at the disarming the mission begins anew, which nobody flies."""
    if not log.has("MSG", "Message"):
        return []
    table = log.columns["MSG"]
    times = log.since_arming(table).tolist()
    return begun((t, str(text)) for t, text in zip(times, table["Message"]) if t < log.span.length - _SAME_S)


class Step(NamedTuple):
    """A moment from which on both flights count their time."""

    logged: float
    flown: float
    """Since arming [s]."""
    item: Item | None
    """That begins; None: both left AUTO."""


def steps(log: FlightLog, flown: FlightLog) -> list[Step]:
    """Items that began in both flights, and the ends of missions by a change of mode."""
    there = {one.item: one.time for one in begun_in(flown)}
    found = [Step(one.time, there[one.item], one.item) for one in begun_in(log) if one.item in there]
    if not found or not log.has("MODE"):
        return found
    table = log.table("MODE")
    numbers = table["ModeNum" if "ModeNum" in table else "Mode"]
    for time, number in zip(log.since_arming(table).tolist(), numbers):
        if found[0].logged < time <= log.span.length and mode_name(log.kind, int(number)).upper() != _AUTO:
            found.append(Step(time, time, None))
    return sorted(found, key=lambda step: step.logged)


def windows(log: FlightLog, flown: FlightLog) -> tuple[Window, ...]:
    """Both flights from item to item, as long as the shorter of the two is on its way; before the first item and after
    a mission they go by the time since arming. Without a mission there are none."""
    found = steps(log, flown)
    if not found:
        return ()
    begin = Step(0.0, 0.0, None)
    end = Step(log.span.length, max(flown.span.length, log.span.length), None)
    made = []
    for one, after in zip((begin, *found), (*found, end)):
        length = min(after.logged - one.logged, after.flown - one.flown)
        if length > 0.0:
            made.append(Window(one.logged, one.logged + length, one.flown - one.logged))
    return tuple(made)


_LATE_S = 0.1
"""Two flights that are nearer to each other pass their waypoints together."""


def late(found: list[Step]) -> list[str]:
    """In words, how much later or earlier the twin was; empty: never by much."""
    moved = [(step.flown - step.logged, step) for step in found if step.item is not None]
    if not moved or max(abs(by) for by, _ in moved) < _LATE_S:
        return []
    by, most = max(moved, key=lambda pair: abs(pair[0]))
    assert most.item is not None
    first = next(step for by, step in moved if abs(by) >= _LATE_S)
    assert first.item is not None
    return [
        f"the twin begins mission item {most.item.number} {abs(by):.1f} s {'later' if by > 0.0 else 'earlier'} than "
        f"the log's vehicle, which is the most; from item {first.item.number} on ({first.logged:.0f} s) it is out of "
        f"step by {_LATE_S:g} s or more"
    ]
