# SPDX-License-Identifier: BSD-3-Clause
"""Tracks: as bytes and back, the same from every log, and how two of them are brought together."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.logs import track_bin, track_observer
from sitl.logs.dataflash.columns import Columns
from sitl.logs.tlog import LogError
from sitl.logs.track import Track
from sitl.logs.track_columns import COLUMNS, QUANTA, TrackError
from sitl.logs.track_observer import TrackObserver
from sitl.missions.comparison import alignment
from sitl.missions.comparison.alignment import AlignmentError, match, pair, part
from sitl.missions.comparison.flight import measure, read
from sitl.recording.entries import of_state
from sitl.simulation import Core, Simulation
from tests.logs.log_files import binary, written
from tests.missions.comparison.conftest import straight


@given(st.lists(st.lists(st.floats(-1e5, 1e5), min_size=11, max_size=11), max_size=30))
def test_bytes_give_back_a_track_to_its_quanta(rows: list[list[float]]) -> None:
    data = np.array(rows).reshape(-1, len(COLUMNS))
    data[:, 0] = 0.1 * np.arange(len(data))
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


def moved(track: Track, columns: slice, by: tuple[float, ...], since: float = 0.0) -> Track:
    """Shifted by constants from some time on."""
    data = track.data.copy()
    data[data[:, 0] >= since, columns] += by
    return replace(track, data=data)


def later(track: Track, by: float) -> Track:
    """All of it later by the vehicle's own clock."""
    data = track.data.copy()
    data[:, 0] += by
    shifted = {
        name: [(event[0] + by, *event[1:]) for event in getattr(track, name)]
        for name in ("modes", "items", "texts", "armed")
    }
    return replace(track, data=data, **shifted)


def test_the_same_flight_begun_later_is_the_same() -> None:
    both = pair(straight(), later(straight(), 7.0))
    assert both.align == "AUTO"
    assert both.starts == pytest.approx((0.0, 7.0))
    found = measure(both)
    assert max(series.max for series in found.series) < 1e-6
    assert found.missed.max() < 1e-6


def test_a_wait_on_the_way_is_a_delay_and_no_cross_track() -> None:
    found = measure(pair(straight(20.0), straight(20.0, wait=1.5)))
    assert found["cross_track"].max < 0.02
    assert found["delay"].max == pytest.approx(1.5, abs=0.1)
    assert found["position"].max == pytest.approx(3.0, abs=0.1)


def test_a_shifted_way_is_cross_track_and_hardly_delay() -> None:
    new = moved(straight(), slice(1, 3), (0.3, 0.4))
    found = measure(pair(straight(), new))
    assert found["position"].max == pytest.approx(0.5, abs=0.02)
    assert found["position"].rms == pytest.approx(0.5, abs=0.02)
    assert 0.28 <= found["cross_track"].max <= 0.52
    assert np.nanmedian(np.abs(found["delay"].values)) < 0.25  # 0.4 m further along at 2 m/s


def test_height_and_heading_have_signs() -> None:
    new = moved(straight(), slice(3, 4), (-0.5,), since=5.0)
    new = moved(new, slice(9, 10), (-3.1,))
    golden = moved(straight(), slice(9, 10), (3.1,))
    found = measure(pair(golden, new))
    assert found["altitude"].max == pytest.approx(0.5)
    assert found["altitude"].values[-1] == pytest.approx(0.5)
    assert found["heading"].max == pytest.approx(np.degrees(2.0 * np.pi - 6.2), abs=0.2)
    assert found["altitude"].first_over(0.1) == pytest.approx(50, abs=1)


def test_a_part_left_out_is_missed() -> None:
    golden = straight(20.0)
    short = golden.between(0.0, 10.0)
    found = measure(pair(golden, short))
    assert found["cross_track"].max < 0.02
    assert found.missed.max() == pytest.approx(20.0, abs=0.5)


def test_a_heartbeat_late_is_no_delay_where_the_log_is_coarse() -> None:
    track = straight(20.0, wait=5.0)
    late = replace(track, modes=[(0.0, "GUIDED"), (0.7, "AUTO")], armed=[(0.0, True)])
    coarse = pair(track, late, coarse=True)
    assert measure(coarse)["delay"].max < 0.01
    assert "clocks brought together by -0.70 s" in coarse.notes[0]
    assert measure(pair(track, late))["delay"].max == pytest.approx(0.7, abs=0.01)


@pytest.mark.parametrize("late, noted", [(0.1, True), (2.0, True), (2.1, False), (3.5, False)])
def test_clocks_are_brought_together_by_two_seconds_at_most(late: float, noted: bool) -> None:
    """A heartbeat comes once a second, and one may be lost."""
    track = straight(20.0, wait=5.0)
    other = replace(track, modes=[(0.0, "GUIDED"), (late, "AUTO")], armed=[(0.0, True)])
    found = pair(track, other, coarse=True)
    assert [note for note in found.notes if "clocks" in note] == (
        [f"clocks brought together by {-late:+.2f} s: a log tells when AUTO began to a heartbeat only"] if noted else []
    )


def test_what_happened_before_the_start_stays_there_when_clocks_are_brought_together() -> None:
    """The new flight's log tells of AUTO at 0.7 s as golden's at 1 s: its clock begins 0.3 s before its AUTO."""
    track = later(straight(20.0, wait=5.0), 1.0)
    golden = replace(track, modes=[(0.5, "GUIDED"), (1.7, "AUTO")], armed=[(0.5, True)])
    new = replace(track, modes=[(0.5, "GUIDED"), (1.9, "AUTO")], armed=[(0.5, True)], texts=[(1.8, 6, "Arming motors")])
    both = pair(golden, new, coarse=True)
    assert "brought together by -0.20 s" in both.notes[0]
    assert both.new.modes == [(0.0, "AUTO")]
    assert not both.new.texts


def climb_and_leg(north: float) -> Track:
    """Up by 10 m at 1 m/s, then north at 2 m/s, from a place so far north."""
    track = straight(20.0)
    climb = np.minimum(track.t, 10.0)
    data = track.data.copy()
    data[:, 1], data[:, 2], data[:, 3] = north + 2.0 * (track.t - climb), 0.0, -climb
    data[:, 4], data[:, 5], data[:, 6] = 2.0 * (track.t > 10.0), 0.0, -1.0 * (track.t <= 10.0)
    return replace(track, data=data)


def test_a_vehicle_that_stands_or_climbs_beside_a_leg_is_not_early() -> None:
    """Where it stands in GPS noise, it is nearer to a part of golden's way that golden came to later."""
    found = measure(pair(climb_and_leg(0.0), climb_and_leg(1.0)))
    assert found["delay"].max < 0.6  # 1 m at 2 m/s


def test_matching_never_goes_back() -> None:
    golden, new = straight(20.0), moved(straight(20.0, wait=0.8), slice(1, 3), (0.05, -0.04))
    index = match(new, golden).index
    assert (np.diff(np.round(index)) >= -1.0).all()


def test_only_what_was_armed_is_disarmed() -> None:
    track = replace(straight(60.0), armed=[(0.4, False), (10.0, True), (50.0, False)])
    whole = part(track, "start")  # a heartbeat that says "disarmed" ends nothing
    assert whole.t[-1] == pytest.approx(50.0) and whole.armed[:2] == [(0.4, False), (10.0, True)]
    assert part(track, "armed").t[-1] == pytest.approx(40.0)


def test_a_log_that_arming_has_opened_is_armed_from_its_beginning(tmp_path: Path) -> None:
    """As of the real ArduPilot with LOG_DISARMED 0: its first record of arming is that it is over."""
    formats = {"PARM": ("QNf", "TimeUS,Name,Value"), "EV": ("QB", "TimeUS,Id"), "ARM": ("QB", "TimeUS,ArmState")}
    first = ("PARM", 43_500_000, b"LOG_DISARMED", 0.0)
    armed = binary([first, ("ARM", 44_000_000, 1)], formats)
    assert track_bin.armings(Columns(written(tmp_path / "x.bin", armed))) == [(44.0, True)]
    over = binary([first, ("EV", 90_000_000, 11), ("ARM", 90_000_001, 0)], formats)
    assert track_bin.armings(Columns(written(tmp_path / "x.bin", over))) == [(43.5, True), (90.0, False)]


def test_another_kind_or_nothing_flown_is_said() -> None:
    with pytest.raises(AlignmentError, match="golden is of a copter, the new flight of a rover"):
        pair(straight(), replace(straight(), kind="rover"))
    with pytest.raises(AlignmentError, match="the new flight has no samples"):
        pair(straight(), replace(straight(), data=np.zeros((0, 11))))
    with pytest.raises(AlignmentError, match="'armed': the new flight has no such moment"):
        pair(straight(), replace(straight(), armed=[(0.0, False)]), "armed")


def test_flights_far_apart_are_each_seen_from_home() -> None:
    away = replace(straight(), home=(-36.0, 150.0, 10.0))
    both = pair(straight(), away)
    assert measure(both)["position"].max == 0.0
    assert "km from the golden flight's home" in both.notes[0]


def test_flights_that_are_too_long_to_compare_say_how_long_may_be(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(alignment, "MOST_CELLS", 50_000)
    with pytest.raises(AlignmentError, match=r"0\.0 hours are too long to be compared: at most 0\.0"):
        match(straight(20.0), moved(straight(20.0), slice(1, 2), (0.1,)))


def test_a_track_ends_where_it_may_be_no_longer(core: Core, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(track_observer, "LONGEST_S", 2.0)
    simulation = Simulation(core=core, seed=5)
    observer = TrackObserver(simulation)
    simulation.advance(30.0)
    track = observer.track()
    simulation.close()
    assert track.t[-1] - track.t[0] == pytest.approx(2.0)


@pytest.mark.parametrize("ahead", [0.05, -0.05, 0.15, -0.15])
def test_matches_lie_between_samples_on_either_side(ahead: float) -> None:
    """At 2 m/s, and 0.2 m from sample to sample: who is 5 cm ahead of a sample is a fortieth of a second early."""
    golden, new = straight(20.0), moved(straight(20.0), slice(1, 2), (ahead,))
    found = match(new, golden)
    on_the_way = slice(5, 90)
    assert found.delay[on_the_way] == pytest.approx(-ahead / 2.0, abs=1e-6)
    assert found.cross[on_the_way] == pytest.approx(0.0, abs=1e-6)
    assert (found.index[on_the_way] - np.arange(201)[on_the_way]) == pytest.approx(ahead / 0.2, abs=1e-6)
