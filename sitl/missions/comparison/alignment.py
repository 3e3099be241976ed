# SPDX-License-Identifier: BSD-3-Clause
"""Aligns two flights: in time, from the start of their missions; and along the path, independent of time."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from sitl.core import elementary_arrays as arrays
from sitl.core.geodesy import offset_ne
from sitl.core.sums import lengths
from sitl.errors import OptionError
from sitl.logs.track import Track, is_angle, sampled
from sitl.logs.track_columns import NAMES

Array = np.ndarray[Any, Any]

STEP = 0.1
"""Time between two samples [s]."""
ELSEWHERE = 500.0
"""Distance between homes above which each flight is compared relative to its own home [m]."""
BAND = 20.0
"""Half width of the band of the alignment around equal times, beyond the difference in duration [s]."""
LONGER = 120.0
"""Largest difference in duration that widens the band [s]."""
HEARTBEAT = 2.0
"""Largest delay of mode changes in a ground station's log [s]."""
LAZY = 0.05
"""Weight of time where many samples are at one position (a hover), so that the sample at the same time is matched
[m/s]."""
MOST_CELLS = 1 << 28
"""Of the alignment: samples of one flight times those of the band; two bytes each."""
MOVING = 0.5
"""Speed along golden's direction below which a position gives no time [m/s]."""
START_NAMES = {"AUTO": "AUTO began", "armed": "arming", "start": "power-on"}


class AlignmentError(OptionError):
    """Two flights that have nothing in common to compare."""


@dataclass(frozen=True)
class Pair:
    """Two flights with a common clock, which starts at the start of both, and a common home."""

    golden: Track
    new: Track
    """Samples every 0.1 s from 0 on; event times since the same start."""
    align: str
    """"AUTO", "armed" or "start"."""
    starts: tuple[float, float]
    """Start by each flight's own clock [s]."""
    notes: tuple[str, ...]


def pair(
    golden: Track,
    new: Track,
    align: str = "auto",
    coarse: bool = False,
    names: tuple[str, str] = ("golden", "the new flight"),
) -> Pair:
    """Align two flights in time.

    Args:
        golden, new: the two.
        align: as a tolerance has it.
        coarse: the start of one is known to a heartbeat only: then their paths bring the clocks together.
        names: what errors call them.

    Raises:
        AlignmentError: they are of different kinds of vehicles, or one lacks the start that is asked for.
    """
    if golden.kind != new.kind:
        raise AlignmentError(f"{names[0]} is of a {golden.kind}, {names[1]} of a {new.kind}")
    for title, track in zip(names, (golden, new), strict=True):
        if len(track) < 2:
            raise AlignmentError(f"{title} has no samples: its estimator never had an origin")
    golden, new = golden.quantised(), new.quantised()
    notes = []
    north, east = offset_ne(golden.home[0] * 1e7, golden.home[1] * 1e7, new.home[0] * 1e7, new.home[1] * 1e7)
    away = float(arrays.hypot(north, east))
    if away <= ELSEWHERE:
        new = new.seen_from((golden.home[0], golden.home[1], new.home[2]))  # heights stay above each one's home
    else:
        notes.append(
            f"flown {away / 1000.0:.1f} km from the golden flight's home: each flight is relative to its own home"
        )
    for name in ("AUTO", "armed", "start") if align == "auto" else (align,):
        first, second = begin(golden, name), begin(new, name)
        if first is not None and second is not None:
            found = Pair(_from(golden, first), _from(new, second), name, (first, second), tuple(notes))
            return _with_aligned_clocks(found, golden, new) if coarse else found
    which = names[0] if begin(golden, align) is None else names[1]
    raise AlignmentError(f"align = {align!r}: {which} has no such moment ({START_NAMES.get(align, align)})")


def _with_aligned_clocks(found: Pair, golden: Track, new: Track) -> Pair:
    """The pair with clocks shifted by the new flight's median delay along the path, when that is at most a
    heartbeat's."""
    matched = match(found.new, found.golden)
    moving = matched.of(lengths(found.golden.data[:, 4:7])) > MOVING
    late = float(np.median(matched.delay[moving])) if moving.any() else 0.0
    if not STEP / 2.0 < abs(late) <= HEARTBEAT:
        return found
    first, second = found.starts
    note = f"clocks brought together by {late:+.2f} s: a log tells when {START_NAMES[found.align]} to a heartbeat only"
    return Pair(
        _from(golden, first),
        _from(new, second + late, second),
        found.align,
        (first, second + late),
        (*found.notes, note),
    )


def begin(track: Track, align: str) -> float | None:
    """Start of the comparison by the flight's own clock [s]; None: there is none."""
    armed = next((t for t, state in track.armed if state), None)
    if align == "armed":
        return armed
    if align == "AUTO":
        return (
            None if armed is None else next((t for t, mode in track.modes if mode == "AUTO" and t >= armed - 2.0), None)
        )
    return 0.0


def part(track: Track, align: str) -> Track:
    """A flight from a moment on, with its clock starting there, to the next disarming or the end.

    Raises:
        AlignmentError: there is no such moment in it.
    """
    start = begin(track, align)
    if start is None:
        raise AlignmentError(f"align = {align!r}: there is no such moment ({START_NAMES.get(align, align)})")
    return _from(track, start)


def _end(track: Track, start: float) -> float:
    """Time of the first disarming after a time, or of the last sample [s]."""
    was_armed = False  # a ground station's log begins with a heartbeat that says "disarmed": that ends nothing
    for t, state in track.armed:
        if was_armed and not state and t > start:
            return t
        was_armed = state
    return float(track.t[-1])


def _from(track: Track, start: float, logged: float | None = None) -> Track:
    """The part of a track from a time [s] to the next disarming or the end, with its clock starting there.

    Args:
        track: the whole flight.
        start: where the clock begins [s].
        logged: time at which the log records that moment [s]; events count from there. None: at ``start``.
    """
    stop = _end(track, start)
    t = track.t
    first = max(math.ceil((t[0] - 1e-6 - start) / STEP), 0)  # what an event says may be far before all samples
    times = start + np.arange(first, int((min(stop, t[-1]) - start) / STEP + 1e-6) + 1) * STEP
    times = times[times >= t[0] - 1e-6]
    series = {name: (t, track[name]) for name in NAMES[1:]}
    cut = track.between(start if logged is None else logged, stop + 1.0)
    if logged is not None and cut.modes:
        cut.modes[0] = (start, cut.modes[0][1])

    def shifted(events: list[Any]) -> list[Any]:
        return [(event[0] - start, *event[1:]) for event in events]

    if not len(times):
        raise AlignmentError(f"nothing was sampled after {start:.1f} s: there is nothing to compare")
    data = sampled(times, series, is_angle)
    data[:, 0] -= start
    data[:, -1] -= data[0, -1]  # energy
    return Track(
        track.kind, data, track.home, shifted(cut.modes), shifted(cut.items), shifted(cut.texts), shifted(cut.armed)
    )


@dataclass(frozen=True)
class Matched:
    """For each sample of a flight, its matching position on another flight's path."""

    index: Array
    """As a fractional index into the other's samples."""
    cross: Array
    """Horizontal distance from that position, shape (n,) [m]."""
    delay: Array
    """Delay relative to the other flight at that position, shape (n,) [s]."""

    def of(self, column: Array) -> Array:
        """The other flight's values at the matching positions."""
        return np.interp(self.index, np.arange(len(column)), column)


def match(flight: Track, other: Track) -> Matched:
    """Match each sample of ``flight`` with the nearest position on the path of ``other``, in increasing order."""
    f, o = flight.data[:, 1:4], other.data[:, 1:4]
    if flight.data.shape == other.data.shape and (flight.data[:, :4] == other.data[:, :4]).all():
        return Matched(np.arange(len(f), dtype=float), np.zeros(len(f)), np.zeros(len(f)))
    nearest = _warp(f, o, flight.t, other.t)
    return _refined(f, o, flight.t, other.t, nearest)


def _warp(f: Array, o: Array, tf: Array, to: Array) -> Array:
    """Dynamic time warping within a band: index into ``o`` of each row of ``f``, never falling."""
    first = round((tf[0] - to[0]) / STEP)
    width = int((BAND + min(abs(tf[-1] - to[-1]), LONGER)) / STEP)
    offsets = np.arange(-width, width + 1)
    if len(f) * len(offsets) > MOST_CELLS:
        hours = MOST_CELLS / len(offsets) * STEP / 3600.0
        raise AlignmentError(f"{len(f) * STEP / 3600.0:.1f} hours are too long to be compared: at most {hours:.1f}")
    total = np.zeros(len(offsets))
    came = np.zeros((len(f), len(offsets)), np.int16)
    for i in range(len(f)):
        j = i + first + offsets
        near = o[np.clip(j, 0, len(o) - 1)] - f[i]
        late = LAZY * STEP * offsets
        cost = (near * near).sum(axis=1) + late * late
        if i:
            best = np.minimum.accumulate(total)
            where = np.maximum.accumulate(np.where(total == best, np.arange(len(total)), 0))
            after = np.minimum(np.arange(len(total)) + 1, len(total) - 1)  # the other's index may stay or grow
            came[i], cost = where[after], cost + best[after]
        total = cost
    out = np.zeros(len(f), np.int64)
    k = int(np.argmin(total))
    for i in range(len(f) - 1, -1, -1):
        out[i] = i + first + offsets[k]
        k = int(came[i, k])
    return np.clip(out, 0, len(o) - 1)


def _refined(f: Array, o: Array, tf: Array, to: Array, nearest: Array) -> Matched:
    """The nearest point of the two lines that meet in each matched sample."""
    best = np.full(len(f), np.inf)
    index = nearest.astype(float)
    for step in (-1, 1):
        end = np.clip(nearest + step, 0, len(o) - 1)
        along = o[end] - o[nearest]
        square = (along * along).sum(axis=1)
        fraction = np.where(square > 1e-9, ((f - o[nearest]) * along).sum(axis=1) / np.maximum(square, 1e-9), 0.0)
        fraction = np.clip(fraction, 0.0, 1.0)
        gap = f - o[nearest] - fraction[:, None] * along
        away = (gap * gap).sum(axis=1)
        better = away < best - 1e-12
        best = np.where(better, away, best)
        index = np.where(better, nearest + step * fraction * (end != nearest), index)
    rows = np.arange(len(o))
    position = np.stack([np.interp(index, rows, o[:, k]) for k in range(2)], axis=1)
    cross = arrays.hypot(*(f[:, :2] - position).T)
    return Matched(index, cross, tf - np.interp(index, rows, to))
