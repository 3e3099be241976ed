# SPDX-License-Identifier: BSD-3-Clause
"""A flight to compare: its track, and where it comes from."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from sitl.core import elementary_arrays as arrays
from sitl.core.compile import Progress
from sitl.core.sums import lengths
from sitl.logs import forms, track_bin, track_tlog
from sitl.logs.tlog import LogError
from sitl.logs.track import Track
from sitl.logs.track_observer import BITS_BYTES, TrackObserver
from sitl.recording.recording import Recording
from sitl.recording.recording import read as read_recording
from sitl.recording.replay import Replay

from .alignment import MOVING, Matched, Pair, match

SECTION = "track"
"""Name of a recording's section that holds its track."""
BITS = "bits"
"""Name of the section with digests of the track before it was rounded."""


@dataclass(frozen=True)
class Flight:
    """One of the two flights."""

    name: str
    track: Track
    header: dict[str, Any] | None = None
    """Description of the run (``sitl.recording.identity``); None: unknown."""
    digests: dict[str, Any] | None = None
    """Digests of the vehicle's final state and of its telemetry; None: unknown."""
    bits: tuple[bytes, ...] = ()
    """Digests of the flight to its last bit, up to every tenth second and up to its end; none: unknown."""
    coarse: bool = False
    """Times of modes and arming are known to a heartbeat (1 s) only."""
    notes: tuple[str, ...] = field(default=())
    """Remarks on the source of the track."""


def read(path: str | Path, system: int | None = None, progress: Progress | None = None) -> Flight:
    """The flight in a recording (.rec), a .tlog or a DataFlash log (.bin, .log), by what the file holds.

    A recording without a track is flown again for it. The flight's notes say what a log lacks.

    Raises:
        LogError, RecordingError: the file cannot be read, or holds no flight.
    """
    file = Path(path)
    form = forms.of(file)
    if form == forms.RECORDING:
        return of_recording(read_recording(file), progress)
    if form == forms.TLOG:
        track = track_tlog.read(file, system)
    elif form == forms.DATAFLASH:
        track = track_bin.read(file)
    else:
        raise LogError(f"{str(path)!r} is {form}: flights are read from recordings (.rec), .tlog, .bin and .log")
    return Flight(str(path), track, coarse=form == forms.TLOG, notes=tuple(track.notes))


def of_recording(recording: Recording, progress: Progress | None = None) -> Flight:
    """The flight of a recording."""
    digests = recording.end if recording.has_digests else None
    if SECTION in recording.sections:
        track = Track.from_bytes(recording.sections[SECTION])
        return Flight(str(recording.path), track, recording.header, digests, _bits(recording.sections.get(BITS, b"")))
    replay = Replay(recording, progress=progress)
    observer = TrackObserver(replay.simulation)
    try:
        astray = replay.run()
        track = observer.track()
    finally:
        replay.close()
    notes = ["it keeps no track: flown again for it"]
    notes += [f"changed since the recording: {text}" for text in replay.differences]
    notes += [f"the replay differs: {text}" for text in astray]
    return Flight(str(recording.path), track, recording.header, digests, notes=tuple(notes))


def _bits(section: bytes) -> tuple[bytes, ...]:
    return tuple(section[k : k + BITS_BYTES] for k in range(0, len(section), BITS_BYTES))


Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class Series:
    """One difference over the time of the new flight; NaN where there is nothing to compare."""

    name: str
    """Name as in tolerance files."""
    title: str
    unit: str
    quantum: float
    """Largest difference that rounding explains."""
    t: Array
    """Times since the common start, shape (n,) [s]."""
    values: Array
    """New minus golden, shape (n,); distances have no sign."""
    gap: Array | None = None
    """Vector from golden to the new flight, north, east, down, shape (n, 3) [m]; distances only."""

    @property
    def size(self) -> Array:
        """Magnitudes, shape (n,); NaN as 0."""
        return np.nan_to_num(np.abs(self.values))

    @property
    def max(self) -> float:
        """The largest magnitude, in the series' unit."""
        return float(self.size.max(initial=0.0))

    @property
    def rms(self) -> float:
        """Root mean square, in the series' unit."""
        known = self.values[np.isfinite(self.values)]
        return float(np.sqrt(np.mean(known * known))) if len(known) else 0.0

    def worst(self) -> int:
        """Index of the largest magnitude."""
        return int(np.argmax(self.size)) if len(self.values) else 0

    def first_over(self, limit: float) -> int | None:
        """Index of the first sample larger than ``limit``, in the series' unit; None: there is none."""
        over = np.flatnonzero(self.size > limit + 1e-9)
        return int(over[0]) if len(over) else None


@dataclass(frozen=True)
class Differences:
    """All differences of two flights."""

    series: tuple[Series, ...]
    matched: Matched
    """Matching position on golden's path of each sample of the new flight."""
    missed: Array
    """Horizontal distance from each sample of golden to the new flight's path, which shows what was left out [m]."""

    def __getitem__(self, name: str) -> Series:
        return next(series for series in self.series if series.name == name)


def measure(pair: Pair) -> Differences:
    """Compare two aligned flights sample by sample."""
    golden, new = pair.golden, pair.new
    t, position = new.t, new.data[:, 1:4]
    matched, back = match(new, golden), match(golden, new)

    def of(name: str) -> Array:
        return matched.of(golden[name])

    at_time = np.stack([np.interp(t, golden.t, golden[name]) for name in ("north", "east", "down")], axis=1)
    both = (t <= golden.t[-1] + 1e-6) & (t >= golden.t[0] - 1e-6)
    drift = np.where(both[:, None], position - at_time, np.nan)
    path = np.stack([of(name) for name in ("north", "east", "down")], axis=1)
    aside = position - path
    flat = aside * (1.0, 1.0, 0.0)
    speed = arrays.hypot(golden["vn"], golden["ve"])
    fast = np.sqrt(matched.of(speed * speed + np.square(golden["vd"])))
    then = np.stack([of(name) for name in ("vn", "ve", "vd")], axis=1)
    ahead = (new.data[:, 4:7] * then).sum(axis=1) / np.maximum(lengths(then), 1e-9)
    # where paths come close (a climb's end and the leg that follows) the nearer one may be another part of golden's
    delay = np.where(np.minimum(fast, ahead) > MOVING, matched.delay, np.nan)
    tilt = arrays.hypot(*(new[name] - of(name) for name in ("roll", "pitch")))
    yaw = np.interp(matched.index, np.arange(len(golden)), np.unwrap(golden["yaw"]))
    heading = (new["yaw"] - yaw + np.pi) % (2.0 * np.pi) - np.pi
    found = (
        Series("position", "position at the same time", "m", 0.0175, t, lengths(drift), drift),
        Series("cross_track", "cross-track", "m", 0.015, t, matched.cross, flat),
        Series("altitude", "altitude", "m", 0.0101, t, -aside[:, 2]),
        Series("delay", "delay along the path", "s", 0.05, t, delay),
        Series("speed", "ground speed", "m/s", 0.015, t, arrays.hypot(new["vn"], new["ve"]) - matched.of(speed)),
        Series("climb", "climb rate", "m/s", 0.0101, t, of("vd") - new["vd"]),
        Series("tilt", "roll and pitch", "deg", 0.15, t, np.degrees(tilt)),
        Series("heading", "heading", "deg", 0.101, t, np.degrees(heading)),
    )
    return Differences(found, matched, back.cross)
