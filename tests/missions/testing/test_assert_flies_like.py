# SPDX-License-Identifier: BSD-3-Clause
"""Goldens are written when that is asked for and at no other time, and differences are found."""

from __future__ import annotations

import warnings
from pathlib import Path

import pytest

from sitl.missions.testing.factory import VehicleFactory
from sitl.missions.testing.golden import FlightChanged, GoldenStore, OldGolden
from sitl.missions.testing.vehicle import Copter
from sitl.recording.recording import read
from tests.recording.older import without_bits


def hop(vehicle: Copter, east: float = 5.0) -> Copter:
    vehicle.takeoff(5)
    vehicle.fly_to(10, east)
    vehicle.land()
    return vehicle


@pytest.fixture
def golden(make: VehicleFactory, store: GoldenStore, tmp_path: Path) -> Path:
    store.update = True
    hop(make("copter")).assert_flies_like("golden/hop.rec")
    store.update = False
    store.checked.clear()
    store.written.clear()
    return tmp_path / "golden" / "hop.rec"


def test_the_same_flight_is_like_golden(make: VehicleFactory, golden: Path) -> None:
    assert "track" in read(golden).sections and golden.stat().st_size < 20_000
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        hop(make("copter")).assert_flies_like("golden/hop.rec")


def test_what_changes_within_the_limits_is_told(make: VehicleFactory, golden: Path) -> None:
    gain = make("copter").parameter("PSC_POSXY_P")
    copter = hop(make("copter", params={"PSC_POSXY_P": 1.001 * gain}))
    with pytest.warns(
        FlightChanged, match=r"hop\.rec: within the limits of the golden flight, but no longer the same: .* after "
    ):
        copter.assert_flies_like("golden/hop.rec", "same")
    with pytest.raises(AssertionError, match="does not fly like the golden flight"):
        copter.assert_flies_like("golden/hop.rec")
    copter.assert_flies_like("golden/hop.rec", "0.5 m")


def test_an_old_golden_is_held_to_limits_with_a_warning_and_written_anew(
    make: VehicleFactory, store: GoldenStore, golden: Path
) -> None:
    store.how = "pytest x --sitl-update-golden"
    without_bits(golden)
    copter = hop(make("copter"))
    with pytest.warns(OldGolden, match=r"hop\.rec: .* record it anew .*: pytest x --sitl-update-golden"):
        copter.assert_flies_like("golden/hop.rec")
    store.update = True
    copter.assert_flies_like("golden/hop.rec")
    assert store.written == [golden] and "bits" in read(golden).sections


def test_without_golden_it_says_how_to_make_one(make: VehicleFactory, store: GoldenStore, tmp_path: Path) -> None:
    store.how = "pytest x --sitl-update-golden"
    with pytest.raises(AssertionError, match=r"there is no golden flight .*hop\.rec; .* pytest x --sitl-update-golden"):
        hop(make("copter")).assert_flies_like("golden/hop.rec")
    assert not (tmp_path / "golden").exists()


def test_another_way_is_found_and_golden_stays(make: VehicleFactory, golden: Path) -> None:
    before = golden.read_bytes()
    with pytest.raises(AssertionError, match=r"(?s)golden .*hop.rec.*s after .* of the golden"):
        hop(make("copter"), east=6.0).assert_flies_like("golden/hop.rec")
    assert golden.read_bytes() == before


def test_a_gain_that_is_one_percent_more_is_found(make: VehicleFactory, store: GoldenStore) -> None:
    store.update = True
    copter = make("copter")
    copter.fly_mission("copter/square")
    copter.assert_flies_like("square.rec")
    store.update = False
    other = make("copter", params={"PSC_VELXY_P": 1.01 * copter.parameter("PSC_VELXY_P")})
    other.fly_mission("copter/square")
    with pytest.raises(AssertionError, match=r"(?s)s after item \d: .* golden.*PSC_VELXY_P .* -> 2\.02"):
        other.assert_flies_like("square.rec")


def test_tolerances_are_taken(make: VehicleFactory, golden: Path, tmp_path: Path) -> None:
    named = ("position", "cross_track", "altitude", "speed", "climb", "tilt", "heading")
    wide = {name: {"max": False, "rms": False} for name in named}
    (tmp_path / "close.toml").write_text("[position]\nmax = 0.01\n")
    copter = hop(make("copter", seed=5))
    copter.assert_flies_like("golden/hop.rec", {"base": "alike", **wide})
    with pytest.raises(AssertionError, match=r"10\.0 mm|0\.01 m|allowed"):
        copter.assert_flies_like("golden/hop.rec", tolerance="close.toml")


def test_an_update_leaves_a_golden_that_is_the_same(make: VehicleFactory, store: GoldenStore, golden: Path) -> None:
    before = golden.stat().st_mtime_ns
    store.update = True
    hop(make("copter")).assert_flies_like("golden/hop.rec")
    assert golden.stat().st_mtime_ns == before and not store.written


def test_an_update_writes_another_flight(make: VehicleFactory, store: GoldenStore, golden: Path) -> None:
    store.update = True
    hop(make("copter"), east=6.0).assert_flies_like("golden/hop.rec")
    assert store.written == [golden]
    assert [file.name for file in golden.parent.iterdir()] == ["hop.rec"]


def test_two_flights_do_not_share_a_golden(make: VehicleFactory, store: GoldenStore, golden: Path) -> None:
    store.update = True
    copter = hop(make("copter"))
    copter.assert_flies_like("golden/hop.rec")
    with pytest.raises(AssertionError, match="is already used by another flight of this test"):
        copter.assert_flies_like("golden/hop.rec")


def test_only_recordings_are_written(make: VehicleFactory, store: GoldenStore) -> None:
    store.update = True
    with pytest.raises(AssertionError, match="must be a recording"):
        hop(make("copter")).assert_flies_like("golden/hop.tlog")


def test_a_golden_that_is_damaged_is_named(make: VehicleFactory, golden: Path) -> None:
    golden.write_bytes(golden.read_bytes()[:-200])
    with pytest.raises(AssertionError, match=r"hop\.rec cannot be used: .* ends at byte"):
        hop(make("copter")).assert_flies_like("golden/hop.rec")


def test_a_golden_of_no_use_says_how_it_is_made_anew(make: VehicleFactory, store: GoldenStore, golden: Path) -> None:
    golden.write_text("junk")
    copter = hop(make("copter"))
    with pytest.raises(AssertionError, match=r"(?s)hop\.rec cannot be used: .*begins with.*--sitl-update-golden"):
        copter.assert_flies_like("golden/hop.rec")
    assert golden.read_text() == "junk"
    store.update = True
    copter.assert_flies_like("golden/hop.rec")
    assert store.written == [golden]


def test_a_golden_that_cannot_be_written_is_said(make: VehicleFactory, store: GoldenStore, tmp_path: Path) -> None:
    (tmp_path / "golden" / "hop.rec").mkdir(parents=True)
    store.update = True
    with pytest.raises(AssertionError, match=r"hop\.rec cannot be written: Is a directory"):
        hop(make("copter")).assert_flies_like("golden/hop.rec")
    assert [file.name for file in (tmp_path / "golden").iterdir()] == ["hop.rec"]
    assert not store.written
