# SPDX-License-Identifier: BSD-3-Clause
"""Tracks: as bytes and back, and the same from an observer, a recording, a .tlog and a .bin."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.logs.tlog import LogError
from sitl.logs.track import COLUMNS, QUANTA, Track, TrackError
from sitl.logs.track_observer import TrackObserver
from sitl.missions.comparison.flight import read
from sitl.recording.entries import of_state
from sitl.simulation import Core, Simulation
from tests.missions.comparison.compared_flights import straight


@given(st.lists(st.lists(st.floats(-1e5, 1e5), min_size=11, max_size=11), max_size=30))
def test_bytes_give_back_a_track_to_its_quanta(rows: list[list[float]]) -> None:
    data = np.array(rows).reshape(-1, len(COLUMNS))
    track = Track("rover", data, (1.0, 2.0, 3.0), [(0.5, "HOLD")], [(1.0, 3)], [(2.0, 6, "hé")], [(0.0, True)])
    back = Track.from_bytes(track.to_bytes())
    assert np.allclose(back.data, track.quantised().data, atol=1e-9)
    assert (np.abs(back.data - data) <= QUANTA * 0.5 + 1e-6).all()
    assert (back.kind, back.home, back.modes, back.items, back.texts, back.armed) == (
        "rover", (1.0, 2.0, 3.0), [(0.5, "HOLD")], [(1.0, 3)], [(2.0, 6, "hé")], [(0.0, True)],
    )  # fmt: skip


def test_equal_tracks_give_equal_bytes_and_few() -> None:
    data = straight(120.0).to_bytes()
    assert data == straight(120.0).to_bytes()
    assert len(data) < 10_000


def test_damaged_bytes_are_no_track() -> None:
    data = straight().to_bytes()
    for bad in (b"", b"something else", data[:-3], data[:20], data[:-20] + bytes([data[-20] ^ 1]) + data[-19:]):
        with pytest.raises(TrackError):
            Track.from_bytes(bad)


def test_a_part_of_a_track_begins_with_the_mode_at_that_time() -> None:
    part = straight(20.0).between(5.0, 15.0)
    assert part.t[0] == pytest.approx(5.0)
    assert part.t[-1] == pytest.approx(15.0)
    assert part.modes == [(5.0, "AUTO")]
    assert part.items == [(10.0, 1)]
    assert part.texts == [(10.0, 6, "Reached command #1")]


def test_another_home_moves_places_only() -> None:
    track = straight()
    moved = track.seen_from((track.home[0] + 1e-4, track.home[1], track.home[2] + 2.0))
    assert moved["north"] - track["north"] == pytest.approx(-11.13, abs=0.01)
    assert moved["down"] - track["down"] == pytest.approx(2.0)
    assert (moved["vn"] == track["vn"]).all()
    assert moved.seen_from(track.home).data == pytest.approx(track.data)


def test_an_observer_looks_at_whole_tenths_and_changes_nothing(core: Core) -> None:
    watched, alone = (Simulation(core=core, seed=5) for _ in range(2))
    observer = TrackObserver(watched)
    for simulation in (watched, alone):
        simulation.advance(23.456)
    track = observer.track()
    assert of_state(watched) == of_state(alone)
    assert track.t == pytest.approx(np.arange(200, 235) * 0.1)
    assert track["down"][-1] == pytest.approx(float(watched.v.autopilot.estimate.pos[2]), abs=0.5)
    assert track.armed == [(0.0, False)]
    assert track.modes == [(0.0, "STABILIZE")]
    for simulation in (watched, alone):
        simulation.close()


def test_time_and_place_go_on_over_a_reboot(core: Core) -> None:
    simulation = Simulation(core=core, seed=5)
    observer = TrackObserver(simulation)
    simulation.advance(25.0)
    simulation.request_reboot()
    simulation.advance(25.0)
    track = observer.track()
    simulation.close()
    assert (np.diff(track.t) > 0.099).all()
    assert track.t[-1] == pytest.approx(50.0)
    assert np.abs(np.diff(track.data[:, 1:4], axis=0)).max() < 3.0


@pytest.mark.parametrize("kind", ["copter", "rover"])
@pytest.mark.parametrize("ending", ["tlog", "bin"])
def test_logs_tell_the_same_flight_as_the_recording(squares: Path, kind: str, ending: str) -> None:
    recorded = read(squares / f"{kind}.rec").track
    logged = read(squares / f"{kind}.{ending}").track.seen_from(recorded.home)
    begin, end = max(recorded.t[0], logged.t[0]), min(recorded.t[-1], logged.t[-1])
    assert end - begin > 55.0
    a, b = recorded.between(begin, end), logged.between(begin, end)
    off = np.abs(a.data - b.data)
    off[:, 7:10] = np.minimum(off[:, 7:10], 2.0 * np.pi - off[:, 7:10])
    assert (off.max(axis=0) <= 2.0 * QUANTA + 0.002).all()
    assert [seq for _, seq in a.items] == [seq for _, seq in b.items]
    assert [t for t, _ in a.items] == pytest.approx([t for t, _ in b.items], abs=0.01)
    assert [mode for _, mode in a.modes] == [mode for _, mode in b.modes]
    assert [text for _, _, text in a.texts] == [text for _, _, text in b.texts]


@pytest.mark.parametrize("name", ["x.tlog", "x.bin", "x.rec", "x.csv"])
def test_what_is_no_log_says_so(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    with pytest.raises(LogError, match="does not exist"):
        read(path)
    path.write_bytes(b"nothing that flies" * 10)
    with pytest.raises(ValueError, match=name.replace(".", r"\.")):
        read(path)


def test_a_system_that_is_not_in_the_log_is_named(squares: Path) -> None:
    with pytest.raises(LogError, match="system id 7"):
        read(squares / "copter.tlog", system=7)
