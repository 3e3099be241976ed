# SPDX-License-Identifier: BSD-3-Clause
"""Whatever is in a log: it is read, or refused by an error of ours."""

from __future__ import annotations

import contextlib
import json
import lzma
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from sitl.errors import SitlError
from sitl.logs import track_bin, track_tlog
from sitl.logs.tlog_flight import read as read_columns
from sitl.logs.track import Track
from sitl.logs.track_bytes import MAGIC
from sitl.logs.track_columns import COLUMNS, TrackError
from sitl.missions.comparison.alignment import part
from sitl.missions.comparison.flight import read
from sitl.missions.tlog_replay.log import Log
from tests import mutations
from tests.logs.log_files import V32, V36, binary, flight, old_flight, telemetry, text

COUNT = 80


@pytest.mark.parametrize(
    ("name", "data", "reader"),
    [
        ("x.bin", binary(flight(), V36), track_bin.read),
        ("y.bin", binary(old_flight(), V32), track_bin.read),
        ("x.log", text(old_flight(), V32), track_bin.read),
        ("x.tlog", telemetry(), track_tlog.read),
        ("y.tlog", telemetry(), Log),
        ("z.bin", binary(flight(), V36), read),
        ("z.tlog", telemetry(), read_columns),
    ],
)
def test_damaged_logs(tmp_path: Path, name: str, data: bytes, reader: Callable[[Path], object]) -> None:
    path = tmp_path / name
    whole = 0
    for damaged in mutations.of_bytes(data, COUNT):
        path.write_bytes(damaged)
        with contextlib.suppress(SitlError):
            reader(path)
            whole += 1
    assert whole > COUNT // 10, "most damage leaves something to read"


def small_track() -> Track:
    data = np.zeros((30, len(COLUMNS)))
    data[:, 0] = 0.1 * np.arange(30)
    data[:, 1] = np.sin(data[:, 0])
    home = (-35.3632, 149.1652, 584.0)
    return Track("copter", data, home, [(0.0, "GUIDED"), (1.0, "AUTO")], [(2.0, 1)], [(1.5, 6, "hello")], [(0.0, True)])


def test_damaged_tracks_of_recordings() -> None:
    raw = lzma.decompress(small_track().to_bytes()[len(MAGIC) :])
    size = int.from_bytes(raw[:4], "little")
    header, columns = json.loads(raw[4 : 4 + size]), raw[4 + size :]

    def packed(header: object, columns: bytes) -> bytes:
        words = json.dumps(header).encode()
        return MAGIC + lzma.compress(len(words).to_bytes(4, "little") + words + columns, preset=0)

    assert len(Track.from_bytes(packed(header, columns))) == 30
    for other in mutations.of_json(header, COUNT):
        with contextlib.suppress(TrackError):
            Track.from_bytes(packed(other, columns)).between(0.0, 2.0).quantised()
    for damaged in mutations.of_bytes(columns, COUNT):
        with contextlib.suppress(TrackError):
            Track.from_bytes(packed(header, damaged))


def test_a_track_that_unpacks_to_much_is_refused() -> None:
    words = b'{"kind":"copter","home":[0,0,0],"modes":[],"items":[],"texts":[],"armed":[],"samples":1000000000}'
    head = len(words).to_bytes(4, "little") + words
    for body in (bytes(100), bytes(1 << 26)):
        with pytest.raises(TrackError, match="damaged"):
            Track.from_bytes(MAGIC + lzma.compress(head + body, preset=0))
    for t in ([0.0, 0.0], [0.0, 1e9], [1.0, 0.5]):
        data = np.zeros((2, len(COLUMNS)))
        data[:, 0] = t
        with pytest.raises(TrackError, match="do not rise, or go too far"):
            Track.from_bytes(Track("copter", data).to_bytes())


def test_an_event_long_before_all_samples_takes_no_memory() -> None:
    track = small_track()
    track.armed = [(-1e11, True)]
    assert len(part(track, "armed")) <= 30
