# SPDX-License-Identifier: BSD-3-Clause
"""What is wrong with a file is said with its name and the place."""

from __future__ import annotations

import contextlib
import itertools
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.core import code_in_files
from sitl.errors import SitlError
from sitl.logs.tlog import LogError
from sitl.missions.comparison.flight import of_recording
from sitl.recording import blocks, recorder, recording
from sitl.recording.blocks import (
    END,
    ENTRIES,
    HEADER,
    LZMA,
    MARK,
    PLAIN,
    SECTION,
    BlockReader,
    BlockWriter,
    is_recording,
)  # fmt: skip
from sitl.recording.entries import Entry, EntryKind, RecordingError, decode, encode, read_varint, varint
from sitl.recording.recorder import Recorder
from sitl.recording.recording import Recording, read
from sitl.recording.replay import Replay
from sitl.run.runner import open_log
from sitl.simulation import Core, Simulation
from tests import mutations
from tests.full_disk import WORDS, full_disk
from tests.recording.conftest import Recorded

ENTRIES_OF_ANY_KIND = st.lists(
    st.tuples(st.integers(0, 2**40), st.sampled_from(EntryKind), st.integers(0, 2**30), st.binary(max_size=300))
)


@given(ENTRIES_OF_ANY_KIND)
def test_entries_survive_being_written(rows: list[tuple[int, EntryKind, int, bytes]]) -> None:
    entries = [Entry(*row) for row in sorted(rows, key=lambda row: row[0])]
    before, raw = 0, b""
    for entry in entries:
        raw += encode(entry, before)
        before = entry.time_us
    assert list(decode(raw, 0)) == entries
    if raw:
        with pytest.raises(ValueError):
            list(decode(raw[:-1], 0))
            raise ValueError  # cut between two entries: fewer of them


@given(st.integers(0, 2**63))
def test_numbers(value: int) -> None:
    assert read_varint(varint(value), 0) == (value, len(varint(value)))


def test_cut_anywhere(hopped: Recorded, tmp_path: Path) -> None:
    data = hopped.path.read_bytes()
    cut = tmp_path / "cut.rec"
    for size in range(0, len(data), 97):
        cut.write_bytes(data[:size])
        with pytest.raises(
            RecordingError, match=r"cut\.rec.*(empty|no recording|cut short|nothing of it|ends at byte)"
        ):
            read(cut)


def test_damaged_anywhere(hopped: Recorded, tmp_path: Path) -> None:
    data = bytearray(hopped.path.read_bytes())
    bad = tmp_path / "bad.rec"
    for at in range(0, len(data), 61):
        data[at] ^= 0x10
        bad.write_bytes(data)
        with pytest.raises(RecordingError, match=r"bad\.rec"):
            read(bad)
        data[at] ^= 0x10
    bad.write_bytes(data + b"more")
    with pytest.raises(RecordingError, match=f"4 bytes follow its end at byte {len(data)}"):
        read(bad)


def test_the_place_of_damage_is_named(hopped: Recorded, tmp_path: Path) -> None:
    data = bytearray(hopped.path.read_bytes())
    blocks = list(BlockReader(hopped.path))
    data[blocks[1].at + 40] ^= 1
    bad = tmp_path / "bad.rec"
    bad.write_bytes(data)
    with pytest.raises(RecordingError, match=f"block 1 at byte {blocks[1].at} of {len(data)} does not match its check"):
        read(bad)


def test_foreign_files(tmp_path: Path) -> None:
    file = tmp_path / "x.rec"
    file.write_bytes(b"QGC WPL 110\n0 1 ...")
    assert not is_recording(file)
    with pytest.raises(RecordingError, match="no recording of a run: it begins with b'QGC WPL '"):
        read(file)
    file.write_bytes(MARK + b"\x07rest")
    with pytest.raises(RecordingError, match="format 7; this program reads format 1"):
        read(file)
    with pytest.raises(RecordingError, match="cannot be read: No such file"):
        read(tmp_path / "absent.rec")


def test_a_header_that_misses_something(tmp_path: Path) -> None:
    writer = BlockWriter(tmp_path / "x.rec")
    writer.write(HEADER, json.dumps({"version": {}}).encode())
    writer.write(END, b"{}")
    writer.close()
    with pytest.raises(RecordingError, match="block at byte 12: it misses airframe, epoch_us"):
        read(tmp_path / "x.rec")


def test_a_killed_run_can_be_flown_as_far_as_it_was_written(core: Core, tmp_path: Path) -> None:
    from sitl.client.endpoint import Endpoint

    path = tmp_path / "killed.rec"
    simulation = Simulation(core=core)
    recorder = Recorder(simulation, path, flush_us=1_000_000)
    client = Endpoint()
    simulation.bridge.add_link(client.link)
    for _ in range(25):
        client.send("HEARTBEAT", type=6, autopilot=8)
        simulation.advance(1.0)
    assert recorder.path == path  # nothing is closed: as after SIGKILL
    with pytest.raises(RecordingError, match=r"without its end mark; its run was killed.*goes up to 24\.000 s"):
        read(path)
    recording = read(path, unfinished=True)
    assert sum(entry.kind is EntryKind.RECEIVED for entry in recording.entries) == 25
    replay = Replay(recording, core=core)
    assert replay.run() == [] and replay.simulation.time_us == 24_000_000


@pytest.mark.parametrize(
    "change, message",
    [
        ({"frame": "gone"}, "airframe 'gone' is not known.*--frame FILE gives another"),
        ({"frame": None, "airframe": {"name": "odd"}}, "data of an airframe.*KeyError.*--frame FILE gives another"),
        ({"frame": "x.py", "vehicle": "boat"}, "vehicle 'boat' is none of copter, rover"),
        ({"world": {"file": "gone.toml", "name": "w", "digest": ""}}, "world file 'gone.toml' cannot be read.*--world"),
        ({"physics": "hil:tcp:127.0.0.1:1"}, "its physics was at the other end of a link"),
    ],
)
def test_what_cannot_be_made_again(hopped: Recorded, core: Core, change: dict[str, object], message: str) -> None:
    recording = read(hopped.path)
    recording.header.update(change)
    with pytest.raises(RecordingError, match=f"hop.rec.*{message}"):
        Replay(recording, core=core)


def test_files_that_a_recording_names_are_read_only_where_the_user_says_so(hopped, core, tmp_path, monkeypatch):
    monkeypatch.setenv(code_in_files.VARIABLE, "")
    (tmp_path / "there").mkdir()
    elsewhere = tmp_path / "there" / "w.toml"
    elsewhere.write_text("[floor]\nz = 0.0\n")
    heights = tmp_path / "there" / "h.npy"
    np.save(heights, np.zeros((3, 3)))
    for change, says in [
        ({"world": {"file": str(elsewhere), "name": "w", "digest": ""}}, f"world = '{elsewhere}'.*--world {elsewhere}"),
        ({"terrain": f"{heights}:30"}, f"terrain = '{heights}:30'.*--terrain {heights}:30"),
        ({"world": {"file": "/dev/zero", "name": "w", "digest": ""}}, "world = '/dev/zero'"),
    ]:
        recording = read(hopped.path)
        recording.header.update(change)
        with pytest.raises(RecordingError, match=f"hop.rec.* reaches outside of this process: {says}"):
            Replay(recording, core=core)
    recording = replace(read(hopped.path), path=elsewhere.with_name("hop.rec"))  # beside it
    recording.header.update({"world": {"file": str(elsewhere), "name": "w", "digest": ""}})
    Replay(recording, core=core).simulation.close()
    recording = read(hopped.path)
    recording.header.update({"world": {"file": "/dev/zero", "name": "w", "digest": ""}})
    Replay(recording, core=core, world=elsewhere).simulation.close()


def test_a_long_recording_is_packed_in_whole_entries(
    hopped: Recorded, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, header, rows = tmp_path / "long.rec", read(hopped.path).header, []
    writer, before = BlockWriter(path), 0
    writer.write(HEADER, json.dumps(header).encode())
    for k in range(40):
        some = [Entry(1000 * k + i, EntryKind.RECEIVED, 1, bytes([k]) * (7 * i + k)) for i in range(9)]
        times = [before, *(entry.time_us for entry in some)]
        writer.write(ENTRIES, b"".join(map(encode, some, times)))
        rows += some
        before = some[-1].time_us
    writer.write(END, json.dumps({"time_us": before, "stopped": "", "state": "", "channels": {}}).encode())
    writer.close()
    monkeypatch.setattr(recorder, "PACKED_BYTES", 1000)
    recorder.repack(path)
    assert sum(block.kind == ENTRIES for block in BlockReader(path)) > 5
    assert read(path).entries == rows and read(path).end_us == before


def test_entries_that_contradict_each_other(hopped: Recorded, core: Core) -> None:
    for entry in (
        Entry(5, EntryKind.RECEIVED, 77, b"x"),
        Entry(5, EntryKind.UNLINK, 9),
        Entry(5, EntryKind.CONNECTED, 3, b"\x07"),
    ):
        recording = read(hopped.path)
        recording.entries.insert(1, entry)
        with pytest.raises(RecordingError, match=r"hop\.rec': at 0\.000 s"):
            Replay(recording, core=core).run()
    recording = read(hopped.path)
    del recording.header["version"]["sources"]
    with pytest.raises(RecordingError, match="what it was made of cannot be understood: KeyError"):
        Replay(recording, core=core)


@pytest.mark.parametrize(
    "entry",
    [
        Entry(5, EntryKind.CONGESTED),
        Entry(5, EntryKind.CONGESTED, 1, b"\x01\x80"),
        Entry(5, EntryKind.LINK, 5, b"[" * 50_000),
        Entry(5, EntryKind.STREAMS, 0, b"[]"),
        Entry(5, EntryKind.FAULT, 0, b"\xff\xff"),
        Entry(5, EntryKind.NOT_REPLAYABLE, 0, b"\xff\xff"),
        Entry(5, EntryKind.DISCONNECTED, 77, b"\xff"),
    ],
)
def test_entries_that_make_no_sense(hopped: Recorded, core: Core, entry: Entry) -> None:
    recording = read(hopped.path)
    after = next(k for k, other in enumerate(recording.entries) if other.time_us > entry.time_us)
    recording.entries.insert(after, entry)
    with pytest.raises(SitlError):
        Replay(recording, core=core).run()


@pytest.mark.parametrize("data", [b"\xff" * 100_000 + b"\x01", b"\xff" * 9 + b"\x02"])
def test_numbers_beyond_64_bits(data: bytes) -> None:
    with pytest.raises(ValueError, match="64 bits"):
        read_varint(data, 0)


@pytest.mark.parametrize(
    "kind, change, message",
    [
        (HEADER, {"version": "x"}, "its version is 'x'"),
        (HEADER, {"version": {"sources": [], "compiled core": ""}}, "its version names no sources"),
        (HEADER, {"world": "x"}, "its world is 'x'"),
        (HEADER, {"params": [[1], [2]]}, "its params is"),
        (
            HEADER,
            {"airframe": {"name": "x", "properties": {}, "parameters": 3}},
            "its airframe has no name, prop",
        ),
        (END, {"time_us": None}, "it ends at None us"),
        (END, {"time_us": 1e308}, "it ends at 1e.308 us"),
        (END, {"time_us": -1}, "it ends at -1 us"),
        (END, {"time_us": 1 << 63}, "it ends at"),
        (END, {"channels": None}, "its channels are None"),
    ],
)
def test_values_of_other_types(
    hopped: Recorded, tmp_path: Path, kind: int, change: dict[str, Any], message: str
) -> None:
    writer = BlockWriter(tmp_path / "x.rec")
    for block in BlockReader(hopped.path):
        changed = json.dumps({**json.loads(block.data), **change}).encode() if block.kind == kind else block.data
        writer.write(block.kind, changed)
    writer.close()
    with pytest.raises(RecordingError, match=message):
        read(tmp_path / "x.rec")


def with_airframe(path: Path, changed: Path, airframe: Callable[[dict[str, Any]], dict[str, Any]]) -> Path:
    """A recording with another airframe in its header."""
    writer = BlockWriter(changed)
    for block in BlockReader(path):
        data = block.data
        if block.kind == HEADER:
            header = json.loads(data)
            data = json.dumps({**header, "airframe": airframe(header["airframe"])}).encode()
        writer.write(block.kind, data)
    writer.close()
    return changed


def test_the_old_name_of_an_airframes_properties_is_read(hopped: Recorded, tmp_path: Path, core: Core) -> None:
    """Version 0.1 wrote "figures"."""
    old = with_airframe(
        hopped.path, tmp_path / "old.rec", lambda a: {"figures" if k == "properties" else k: v for k, v in a.items()}
    )
    replay = Replay(read(old), core=core)
    assert replay.run() == [] == replay.differences
    both = with_airframe(hopped.path, tmp_path / "both.rec", lambda a: {**a, "figures": {}})
    with pytest.raises(RecordingError, match="there are 'figures' and 'properties'"):
        read(both)


@pytest.mark.parametrize("kind", [HEADER, END])
def test_lists_without_end(hopped: Recorded, tmp_path: Path, kind: int) -> None:
    writer = BlockWriter(tmp_path / "x.rec")
    for block in BlockReader(hopped.path):
        writer.write(block.kind, b"[" * 100_000 if block.kind == kind else block.data)
    writer.close()
    with pytest.raises(RecordingError, match="within each other"):
        read(tmp_path / "x.rec")


def test_another_version_is_flown_and_named(hopped: Recorded, core: Core) -> None:
    recording = read(hopped.path)
    recording.header["version"]["sources"]["bridge"] = "0"
    recording.header["version"]["gym-sitl"] = "0.0"
    recording.header["airframe"]["properties"]["mass"] *= 1.01
    replay = Replay(recording, core=core)
    assert replay.run() == []
    assert replay.differences[0] == "sources of bridge"
    assert replay.differences[1].startswith("gym-sitl 0.0 then")
    assert replay.differences[2].startswith("airframe erle_copter: property mass 1.15")


def test_what_says_that_it_unpacks_to_much_is_refused(
    hopped: Recorded, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Small files of one repeated entry, or of nothing but zeros."""
    monkeypatch.setattr(recording, "SPARE_ENTRIES", 1000)
    monkeypatch.setattr(blocks, "SPARE", 1 << 20)
    header = next(iter(BlockReader(hopped.path)))
    path = tmp_path / "x.rec"
    for kind, data, words in (
        (
            ENTRIES,
            encode(Entry(0, EntryKind.PROCESSED), 0) * 60_000,
            "more than [0-9]{4,5} entries, and no recording of",
        ),
        (
            SECTION,
            bytes(1 << 23),
            "cannot be unpacked: it has more than [0-9]+ bytes, and no recording of this size does",
        ),
    ):
        writer = BlockWriter(path)
        writer.write(HEADER, header.data)
        for _ in range(2):
            writer.write(kind, data, LZMA)
        writer.close()
        assert path.stat().st_size < 50_000
        with pytest.raises(RecordingError, match=words):
            read(path)


def test_any_damage_that_checksums_do_not_show(hopped: Recorded, tmp_path: Path) -> None:
    whole = list(BlockReader(hopped.path))
    path = tmp_path / "x.rec"

    def take() -> Recording:
        found = read(path, unfinished=True)
        if "track" in found.sections:
            of_recording(found)
        return found

    outcomes = set()
    for k, block in enumerate(whole):
        changed = mutations.of_bytes(block.data[:2000], 60, seed=k)
        if block.kind in (HEADER, END):
            values = mutations.of_json(json.loads(block.data), 60, seed=k)
            changed = itertools.chain(changed, (json.dumps(value).encode() for value in values))
        for data in changed:
            writer = BlockWriter(path)
            for other in whole:
                writer.write(other.kind, data if other is block else other.data[:2000], PLAIN)
            writer.close()
            outcomes.add(type(mutations.read_or_refused(take, SitlError, "x.rec")))
    assert outcomes == {Recording, type(None)}


@pytest.mark.parametrize("room", [0, 200, 5_000, 20_000])
def test_a_disk_that_is_full_leaves_a_recording_that_says_where_it_ends(core: Core, tmp_path: Path, room: int) -> None:
    path = tmp_path / "x.rec"
    simulation = Simulation(core=core, seed=7)
    with full_disk(room), contextlib.suppress(RecordingError):
        try:
            Recorder(simulation, path)
            simulation.advance(31.0)
        finally:
            simulation.close()
    assert [file.name for file in tmp_path.iterdir()] == ["x.rec"]
    with contextlib.suppress(RecordingError):
        found = read(path, unfinished=True)
        assert found.end is not None or "without its end mark" in found.fault


def test_a_disk_without_room_for_packing_keeps_the_recording(hopped: Recorded, tmp_path: Path) -> None:
    path = tmp_path / "x.rec"
    path.write_bytes(hopped.path.read_bytes())
    with full_disk(1000):
        recorder.repack(path)
    assert path.read_bytes() == hopped.path.read_bytes()
    assert list(tmp_path.iterdir()) == [path]


def test_a_run_that_an_error_breaks_off_has_no_digests_that_a_replay_could_differ_from(
    core: Core, tmp_path: Path
) -> None:
    simulation = Simulation(core=core, seed=7)
    Recorder(simulation, tmp_path / "x.rec")
    open_log(simulation, tmp_path, "x")
    with full_disk(20_000), pytest.raises(LogError, match=rf"x\.tlog' cannot be written: {WORDS}"):
        simulation.advance(60.0)
    simulation.close()
    found = read(tmp_path / "x.rec")
    assert found.end is not None and found.end["stopped"] == "broken off" and not found.has_digests
    replay = Replay(found, core=core)
    assert replay.run() == []
    replay.close()
