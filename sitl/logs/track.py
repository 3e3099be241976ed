# SPDX-License-Identifier: BSD-3-Clause
"""What is compared of a flight: where the vehicle believed to be, ten times a second, and what happened when."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..core.geodesy import offset_ne
from .track_bytes import Content, pack, unpack
from .track_columns import COLUMNS, LONGEST_S, NAMES, QUANTA, STEP_US, Array, TrackError


@dataclass
class Track:
    """One vehicle's flight."""

    kind: str
    """Name of the kind of vehicle."""
    data: Array
    """(n, 11): ``COLUMNS``."""
    home: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Latitude, longitude [deg], altitude above mean sea level [m] of the location that positions are counted from:
    home as of the first arming."""
    modes: list[tuple[float, str]] = field(default_factory=list)
    """(time, mode) whenever it changed; the first is the mode at the start."""
    items: list[tuple[float, int]] = field(default_factory=list)
    """(time, mission item) as they were reached."""
    texts: list[tuple[float, int, str]] = field(default_factory=list)
    """(time, severity, text)"""
    armed: list[tuple[float, bool]] = field(default_factory=list)
    """(time, armed) whenever it changed."""
    notes: list[str] = field(default_factory=list)
    """What the log that it was read from lacks, and what stands for that; not kept in bytes."""

    def __len__(self) -> int:
        return len(self.data)

    def __getitem__(self, name: str) -> Array:
        """A column."""
        return np.asarray(self.data[:, NAMES.index(name)])

    @property
    def t(self) -> Array:
        """Times of the samples [s]."""
        return self["t"]

    def between(self, begin: float, end: float) -> Track:
        """The part within [begin, end] [s]; the first mode is the one active at ``begin``."""
        rows = (self.t >= begin - 1e-6) & (self.t <= end + 1e-6)
        before = [mode for t, mode in self.modes if t <= begin]

        def cut(events: list[Any]) -> list[Any]:
            return [event for event in events if begin - 1e-6 <= event[0] <= end + 1e-6]

        modes = [mode for mode in cut(self.modes) if mode[0] > begin]
        modes = [(begin, before[-1]), *modes] if before else modes
        return replace(
            self, data=self.data[rows], modes=modes, items=cut(self.items), texts=cut(self.texts), armed=cut(self.armed)
        )

    def quantised(self) -> Track:
        """The track as it is read back from its bytes."""
        data = np.round(self.data / QUANTA) * QUANTA

        def at(events: list[Any]) -> list[Any]:
            return [(round(event[0], 4), *event[1:]) for event in events]

        return replace(
            self, data=data, modes=at(self.modes), items=at(self.items), texts=at(self.texts), armed=at(self.armed)
        )

    def seen_from(self, home: tuple[float, float, float]) -> Track:
        """The track relative to another home: latitude, longitude [deg], altitude [m]."""
        if home == self.home:
            return self
        north, east = offset_ne(home[0] * 1e7, home[1] * 1e7, self.home[0] * 1e7, self.home[1] * 1e7)
        data = self.data.copy()
        data[:, 1:4] += (north, east, home[2] - self.home[2])
        return replace(self, data=data, home=home)

    def to_bytes(self) -> bytes:
        """All of it in few bytes (``track_bytes``): about 4 kB a minute."""
        events = (self.modes, self.items, self.texts, self.armed)
        return pack(Content(self.kind, self.home, *events, self.data))

    @staticmethod
    def from_bytes(data: bytes) -> Track:
        """A track from its bytes.

        Raises:
            TrackError: the bytes are no track, or damaged.
        """
        found = unpack(data)
        events = (found.modes, found.items, found.texts, found.armed)
        return Track(found.kind, found.data, found.home, *events)


def sample_times(first: float, last: float, title: str) -> Array:
    """Whole tenths of a second from one time to another [s].

    Raises:
        TrackError: they are farther apart than a track is long; it begins with the title.
    """
    if not last - first <= LONGEST_S:
        raise TrackError(
            f"{title} tells of positions from {first:.1f} s to {last:.1f} s: at most "
            f"{LONGEST_S / 3600.0:.0f} hours are read"
        )
    step = STEP_US * 1e-6
    return np.asarray(np.arange(math.ceil(first / step - 1e-6), math.floor(last / step + 1e-6) + 1) * step)


def sampled(times: Array, series: dict[str, tuple[Array, Array]], unwrap: Callable[[str], bool]) -> Array:
    """Columns at the given times from series that have times of their own, straight between their samples.

    ``series``: column -> (times, values); a column that is not there is 0. ``unwrap``: whether a column is an angle.
    """
    data = np.zeros((len(times), len(COLUMNS)))
    data[:, 0] = times
    for k, name in enumerate(NAMES[1:], 1):
        if name in series and len(series[name][0]):
            t, values = series[name]
            found = np.interp(times, t, np.unwrap(values) if unwrap(name) else values)
            data[:, k] = (found + np.pi) % (2.0 * np.pi) - np.pi if unwrap(name) else found
    return data


def is_angle(name: str) -> bool:
    """Whether a column is in radians."""
    return name in ("roll", "pitch", "yaw")
