# SPDX-License-Identifier: BSD-3-Clause
"""A flight to compare: its track, and where it comes from."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from sitl.core.compile import Progress
from sitl.logs import track_bin, track_tlog
from sitl.logs.tlog import LogError
from sitl.logs.track import Track
from sitl.logs.track_observer import TrackObserver
from sitl.recording.blocks import is_recording
from sitl.recording.recording import Recording
from sitl.recording.recording import read as read_recording
from sitl.recording.replay import Replay

SECTION = "track"
"""Name of a recording's section that holds its track."""


@dataclass(frozen=True)
class Flight:
    """One of the two flights."""

    name: str
    track: Track
    header: dict[str, Any] | None = None
    """Description of the run (``sitl.recording.identity``); None: unknown."""
    digests: dict[str, Any] | None = None
    """Digests of the vehicle's final state and of its telemetry; None: unknown."""
    coarse: bool = False
    """Times of modes and arming are known to a heartbeat (1 s) only."""
    notes: tuple[str, ...] = field(default=())
    """Remarks on the source of the track."""


def read(path: str | Path, system: int | None = None, progress: Progress | None = None) -> Flight:
    """The flight in a recording (.rec), a .tlog or a .bin.

    A recording without a track is flown again for it.

    Raises:
        LogError, RecordingError: the file cannot be read, or holds no flight.
    """
    file = Path(path)
    if not file.exists():
        raise LogError(f"{str(path)!r} does not exist")
    suffix = file.suffix.lower()
    if is_recording(file) or suffix in (".rec", ".snapshot"):
        return of_recording(read_recording(file), progress)
    if suffix == ".tlog":
        return Flight(str(path), track_tlog.read(file, system), coarse=True)
    if suffix == ".bin":
        return Flight(str(path), track_bin.read(file))
    raise LogError(f"{str(path)!r} is no recording, and neither .tlog nor .bin by its name")


def of_recording(recording: Recording, progress: Progress | None = None) -> Flight:
    """The flight of a recording."""
    if SECTION in recording.sections:
        track = Track.from_bytes(recording.sections[SECTION])
        return Flight(str(recording.path), track, recording.header, recording.end)
    replay = Replay(recording, progress=progress)
    observer = TrackObserver(replay.simulation)
    try:
        astray = replay.run()
        track = observer.track()
    finally:
        replay.close()
    notes = ["it keeps no track: flown again for it"]
    notes += [f"not as recorded: {text}" for text in replay.differences]
    notes += [f"the flight is another one: {text}" for text in astray]
    return Flight(str(recording.path), track, recording.header, recording.end, notes=tuple(notes))
