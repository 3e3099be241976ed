# SPDX-License-Identifier: BSD-3-Clause
"""Areas and corridors cut into parallel lines, which are flown one way and the next one back."""

from __future__ import annotations

import math

from .plane import Point, along, moved, shifted

Line = list[Point]
FROM_RIGHT, FROM_END = 1, 2
"""Bits of an entry: the rightmost line first; each line begins where it would have ended."""


def count_of(width: float, spacing: float) -> int:
    """Number of lines that cover a width [m]: each covers half a spacing on both sides, plus a thousandth."""
    return max(1, math.ceil(width / spacing - 1e-3))


def across_polygon(polygon: list[Point], spacing: float, heading: float) -> list[Line]:
    """Lines over a polygon, from left to right, each in the direction of ``heading`` [rad].

    They lie ``spacing`` [m] apart and evenly in the width of the polygon. Of a polygon with bays a line runs from its
    first edge to its last.
    """
    forward = (math.cos(heading), math.sin(heading))
    right = (-forward[1], forward[0])
    side = [p[0] * right[0] + p[1] * right[1] for p in polygon]
    ahead = [p[0] * forward[0] + p[1] * forward[1] for p in polygon]
    low, width = min(side), max(side) - min(side)
    count = count_of(width, spacing)
    first = low + (width - (count - 1) * spacing) / 2.0
    lines = []
    for k in range(count):
        at = first + k * spacing
        cuts = []
        for j in range(len(polygon)):
            a, b = side[j - 1], side[j]
            if (a <= at < b) or (b <= at < a):
                cuts.append(ahead[j - 1] + (ahead[j] - ahead[j - 1]) * (at - a) / (b - a))
        if len(cuts) >= 2:
            ends = (min(cuts), max(cuts))
            lines.append([(right[0] * at + forward[0] * s, right[1] * at + forward[1] * s) for s in ends])
    return lines


def along_corridor(polyline: list[Point], width: float, spacing: float) -> list[Line]:
    """Lines beside each other over a corridor, from left to right."""
    count = count_of(width, spacing)
    return [shifted(polyline, (k - (count - 1) / 2.0) * spacing) for k in range(count)]


def lengthened(line: Line, distance: float) -> Line:
    """A line that begins and ends so much further out [m]."""
    if distance == 0.0:
        return line
    first = moved(line[0], along(line[1], line[0]), distance)
    last = moved(line[-1], along(line[-2], line[-1]), distance)
    return [first, *line[1:-1], last]


def there_and_back(lines: list[Line], entry: int, turnaround: float, alternate: bool = False) -> Line:
    """The path over all lines.

    Args:
        lines: from left to right.
        entry: where it begins (FROM_RIGHT, FROM_END).
        turnaround: how far it goes beyond both ends of each line before it turns [m].
        alternate: every other line first, the ones between on the way back.
    """
    ordered = lines[::-1] if entry & FROM_RIGHT else lines
    if alternate:
        ordered = ordered[::2] + ordered[1::2][::-1]
    path: Line = []
    for k, line in enumerate(ordered):
        whole = lengthened(line, turnaround)
        path += whole[::-1] if (k % 2 == 1) != bool(entry & FROM_END) else whole
    return path
