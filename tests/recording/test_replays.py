# SPDX-License-Identifier: BSD-3-Clause
"""A replay gives the same bytes at the same times, wherever and however often it is flown."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from sitl import vehicles
from sitl.recording import identity
from sitl.recording.entries import EntryKind, RecordingError
from sitl.recording.recorder import Recorder
from sitl.recording.recording import read
from sitl.recording.replay import Replay
from sitl.simulation import Core, Simulation
from tests.recording.conftest import SECONDS, Frames, Recorded, hop


def test_every_frame_again_at_its_time(hopped: Recorded, core: Core) -> None:
    for step_us in (2500, 330_000, 1_000_000_000):
        replay = Replay(read(hopped.path), core=core)
        tap = Frames()
        replay.simulation.bridge.taps.append(tap)
        while not replay.is_over:
            replay.advance_to(replay.simulation.time_us + step_us)
        assert replay.verify() == [] == replay.differences
        assert tap.frames == hopped.frames


def test_the_recording_says_what_happened(hopped: Recorded) -> None:
    recording = read(hopped.path)
    assert recording.end is not None and recording.end["stopped"] == "the script ended"
    assert recording.end_us == SECONDS * 1e6
    kinds = [entry.kind for entry in recording.entries]
    assert kinds.count(EntryKind.CONNECTED) == kinds.count(EntryKind.LINK) == 2
    assert kinds.count(EntryKind.UNLINK) == kinds.count(EntryKind.DISCONNECTED) == 1
    assert recording.header["seed"] == 7 and recording.header["params"] == {"SIM_WIND_SPD": 4.0}
    assert hopped.path.stat().st_size < 6000


def test_a_replay_that_is_recorded_gives_the_same_file(hopped: Recorded, core: Core, tmp_path: Path) -> None:
    again = tmp_path / "again.rec"
    replay = Replay(read(hopped.path), core=core, record=again)
    replay.run()
    replay.close()
    assert again.read_bytes() == hopped.path.read_bytes()


def test_in_another_process(hopped: Recorded, tmp_path: Path) -> None:
    again = tmp_path / "again.rec"
    code = (
        "import sys; from sitl.recording.replay import Replay; from sitl.recording.recording import read; "
        "r = Replay(read(sys.argv[1]), record=sys.argv[2]); print(r.run()); r.close()"
    )
    done = subprocess.run([sys.executable, "-c", code, hopped.path, again], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"
    first, second = read(hopped.path), read(again)
    assert (second.entries, second.end) == (first.entries, first.end)


def test_a_gain_changed_by_one_percent_is_seen_and_where(hopped: Recorded, core: Core, tmp_path: Path) -> None:
    other = read(hop(tmp_path / "gain.rec", core, gain=2.02).path)
    mixed = type(other)(other.path, other.header, read(hopped.path).entries, read(hopped.path).end)
    replay = Replay(mixed, core=core)
    astray = replay.run()
    assert astray[0] == "the vehicle's state differs from some time between 0 and 10 s on"  # the gain is part of it
    assert astray[1] == "telemetry differs from some time between 50 and 60 s on"
    assert astray[2] == "the telemetry of 2 of 2 channels differs"
    assert "parameter PSC_VELXY_P None -> 2.02" in identity.differences(read(hopped.path).header, other.header)


def test_a_lost_message_is_seen(hopped: Recorded, core: Core) -> None:
    recording = read(hopped.path)
    came = max(at for at, entry in enumerate(recording.entries) if entry.kind is EntryKind.CONNECTED)
    take_off = max(at for at, entry in enumerate(recording.entries[:came]) if entry.kind is EntryKind.RECEIVED)
    entries = recording.entries[:take_off] + recording.entries[take_off + 1 :]
    replay = Replay(type(recording)(recording.path, recording.header, entries, recording.end), core=core)
    assert any("channels differs" in text for text in replay.run())


def test_a_recording_begins_at_power_on(core: Core, tmp_path: Path) -> None:
    simulation = Simulation(core=core)
    simulation.advance(1.0)
    with pytest.raises(RecordingError, match=r"begins at power-on; 1\.000 s have passed"):
        Recorder(simulation, tmp_path / "late.rec")
    fresh = Simulation(core=core)
    Recorder(fresh, tmp_path / "one.rec")
    with pytest.raises(RecordingError, match="being recorded already"):
        Recorder(fresh, tmp_path / "two.rec")
    with pytest.raises(RecordingError, match="cannot be written: "):
        Recorder(Simulation(core=core), "/dev/null/x.rec")


def test_a_restored_vehicle_cannot_be_replayed(core: Core, tmp_path: Path) -> None:
    simulation = Simulation(core=core)
    Recorder(simulation, tmp_path / "back.rec")
    before = simulation.snapshot()
    simulation.advance(1.0)
    simulation.restore(before)
    simulation.close()
    with pytest.raises(RecordingError, match=r"at 1\.000 s the vehicle was put back to a snapshot: it cannot be flown"):
        Replay(read(tmp_path / "back.rec"), core=core)


def test_digests_do_not_depend_on_how_often_it_is_written(core: Core, tmp_path: Path) -> None:
    simulation = Simulation(core=core)
    Recorder(simulation, tmp_path / "sevens.rec", 7_000_000)
    simulation.advance(31.0)
    simulation.close()
    recording = read(tmp_path / "sevens.rec")
    checks = [entry.time_us for entry in recording.entries if entry.kind is EntryKind.CHECK]
    assert checks == [10_000_000, 20_000_000, 30_000_000]
    assert Replay(recording, core=core).run() == []


AIRFRAME = """
from sitl import vehicles
AIRFRAME = vehicles.load("erle_copter").changed(mass=1.5)
"""


def test_a_file_that_a_recording_names_is_not_run(core: Core, tmp_path: Path) -> None:
    """Somebody's file lies where the header says; the flight is the recorded one all the same."""
    file, marker = tmp_path / "heavy.py", tmp_path / "marker"
    file.write_text(AIRFRAME)
    flown = hop(tmp_path / "heavy.rec", core, frame=str(file))
    assert read(flown.path).header["frame"] == str(file)
    file.write_text(f"open({str(marker)!r}, 'w')\n" + AIRFRAME)
    replay = Replay(read(flown.path), core=core)
    assert replay.run() == [] == replay.differences
    assert not marker.exists()
    file.unlink()
    assert Replay(read(flown.path), core=core, record=tmp_path / "again.rec").run() == []
    assert Replay(read(flown.path), frame="erle_copter", core=core).differences  # the user's word counts


@pytest.mark.parametrize("name", vehicles.names())
def test_an_airframe_comes_back_from_its_properties(name: str) -> None:
    """All that a simulation takes from an airframe is the same."""
    airframe = vehicles.load(name)
    again = vehicles.of_data(type(airframe), vehicles.to_data(airframe))
    assert again.record().tobytes() == airframe.record().tobytes()
    assert again.parameters == airframe.parameters and again.name == airframe.name
