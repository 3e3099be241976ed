# SPDX-License-Identifier: BSD-3-Clause
"""What logs of all formats show of a flight, each message at its own time, and the track that comes of it."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..core.geodesy import offset_ne
from .track import Track, is_angle, sample_times, sampled
from .track_columns import Array, TrackError

Rows = Sequence[tuple[float, ...]] | Array
MOST_DEG = (90.0, 180.0)


def location_row(t: float, lat: float, lon: float, alt: float) -> tuple[float, float, float, float] | None:
    """A location: time [s], latitude, longitude [deg], altitude above mean sea level [m]; None: it is none.

    Before it knows where it is, an autopilot is at 0, 0.
    """
    is_location = math.isfinite(alt) and abs(lat) <= MOST_DEG[0] and abs(lon) <= MOST_DEG[1] and (lat or lon)
    return (t, lat, lon, alt) if is_location and math.isfinite(t) else None


def complete(
    track: Track,
    title: str,
    locations: Rows,
    homes: Sequence[tuple[float, ...]],
    speeds: Rows = (),
    attitudes: Rows = (),
    energies: Rows = (),
) -> Track:
    """Give a track its home and its samples.

    Args:
        track: with its events; what is missing is noted in it.
        title: what errors call the log.
        locations: ``location_row``; at least two at different times.
        homes: as locations: where home was from when on.
        speeds: time [s], north, east, down [m/s]; none: of the locations.
        attitudes: time [s], roll, pitch, yaw [rad].
        energies: time [s], energy taken from the battery [Wh].

    Raises:
        TrackError: the times are too far apart.
    """
    location, speed, attitude, energy = (
        _array(rows, n) for rows, n in ((locations, 4), (speeds, 4), (attitudes, 4), (energies, 2))
    )
    t = location[:, 0]
    if len(t) < 2 or not t[-1] > t[0]:
        raise TrackError(f"{title} tells of one position only")
    times = sample_times(float(t[0]), float(t[-1]), title)
    track.home = lat, lon, alt = _home(track, homes, location)
    ne = np.array([offset_ne(lat * 1e7, lon * 1e7, row[1] * 1e7, row[2] * 1e7) for row in location])
    series: dict[str, tuple[Array, Array]] = {
        "north": (t, ne[:, 0]),
        "east": (t, ne[:, 1]),
        "down": (t, alt - location[:, 3]),
    }
    for names, rows in ((("vn", "ve", "vd"), speed), (("roll", "pitch", "yaw"), attitude), (("energy",), energy)):
        if len(rows):
            series |= {name: (rows[:, 0], rows[:, k]) for k, name in enumerate(names, 1)}
    if not len(speed):
        rising = np.concatenate(([True], np.diff(t) > 0.0))
        for v, x in (("vn", "north"), ("ve", "east"), ("vd", "down")):
            series[v] = (t[rising], np.gradient(series[x][1][rising], t[rising]))
        track.notes.append("it has no velocities: they are taken from its positions")
    if not len(attitude):
        track.notes.append("it has no attitude")
    if not len(energy):
        track.notes.append("it has no energy of the battery")
    track.data = sampled(times, series, is_angle)
    return track


def integrated(powers: Rows) -> Array:
    """(Time [s], energy [Wh]) from (time [s], power [W])."""
    power = _array(powers, 2)
    steps = np.diff(power[:, 0], prepend=power[:1, 0]) * power[:, 1] / 3600.0
    return np.column_stack([power[:, 0], np.cumsum(steps)])


def _array(rows: Rows, columns: int) -> Array:
    """Rows in the order of their times, without what is no number."""
    found = np.array(rows, float).reshape(-1, columns)
    found = found[np.isfinite(found).all(axis=1)]
    return np.asarray(found[np.argsort(found[:, 0], kind="stable")])


def _home(track: Track, homes: Sequence[tuple[float, ...]], location: Array) -> tuple[float, float, float]:
    """Home as of the first arming, or what comes nearest to it."""
    armed = next((t for t, state in track.armed if state), float(location[0, 0]))
    known = [home for home in homes if home[0] <= armed + 1.0] or homes
    if known:
        _, lat, lon, alt = next((home for home in known if home[0] >= armed), known[-1])
    else:
        _, lat, lon, alt = location[min(int(np.searchsorted(location[:, 0], armed)), len(location) - 1)]
    return (float(lat), float(lon), float(alt))
