# SPDX-License-Identifier: BSD-3-Clause
"""What changes of code, missions and messages do to flights is seen, and located."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from sitl.autopilot.mission.item import MissionItem
from sitl.missions.comparison.compare import Comparison, compare, default_tolerance
from sitl.missions.comparison.flight import Flight, of_recording, read
from sitl.missions.comparison.report import lines as report_lines
from sitl.recording.entries import EntryKind
from sitl.recording.recording import read as read_recording
from tests.missions.comparison.conftest import fly_square


@pytest.fixture(scope="module")
def golden(squares: Path) -> Flight:
    return read(squares / "copter.rec")


def failed(comparison: Comparison) -> set[str]:
    return {metric.name for metric in comparison.failed}


def test_the_same_flight_is_the_same_to_the_last_digit(golden: Flight, tmp_path: Path) -> None:
    found = compare(golden, fly_square(tmp_path / "again.rec"))
    assert found.ok
    assert found.tolerance.name == "exact"
    assert found.first is None and found.first_trace is None
    assert found.headline == "flies like the golden flight, to the last bit"
    assert found.differences["position"].max == 0.0


def with_header(flight: Flight, **changed: object) -> Flight:
    assert flight.header is not None
    return replace(flight, header={**flight.header, **changed})


def test_one_bit_is_a_difference_and_a_tolerance_must_be_asked_for(golden: Flight) -> None:
    assert len(golden.bits) > 5
    other = replace(golden, bits=(*golden.bits[:3], *(b"another!" for _ in golden.bits[3:])))
    found = compare(golden, other)
    assert failed(found) == {"bits"}
    words = "the last bits differ from some time between 30 and 40 s after power-on; the track that is kept is the same"
    assert found.headline == f"does not fly like the golden flight: {words}"
    assert compare(golden, other, "same").ok and compare(golden, other, "1 mm").ok
    shorter = replace(golden, bits=golden.bits[:-1])
    assert failed(compare(golden, shorter)) == {"bits"}


def test_other_engines_have_their_tolerance(golden: Flight) -> None:
    bullet = with_header(golden, physics="pybullet")
    other = replace(bullet, bits=(b"another!",) * len(bullet.bits))
    found = compare(bullet, other)
    assert found.tolerance.name == "same" and found.ok and not found.advice


def test_a_golden_flight_of_an_older_version_is_held_to_limits_and_says_so(golden: Flight) -> None:
    found = compare(replace(golden, bits=()), golden)
    assert found.tolerance.name == "same" and found.ok and found.is_old
    assert "record it anew to have it compared exactly" in found.advice
    assert found.advice in "\n".join(report_lines(found))
    assert not compare(replace(golden, bits=()), golden, "same").advice


def test_another_version_is_named_when_its_flight_differs(golden: Flight) -> None:
    assert golden.header is not None
    version = golden.header["version"]
    older = {**version, "gym-sitl": "0.1.9", "sources": {**version["sources"], "physics": "0"}}
    then = with_header(golden, version=older)
    assert not compare(then, golden).advice, "the flight is the same: nothing to say"
    found = compare(then, replace(golden, bits=(b"another!",)))
    assert "another version of the simulator recorded the golden flight (sources of physics; gym-sitl 0.1.9 then" in (
        found.advice
    )
    assert not compare(golden, replace(golden, bits=(b"another!",))).advice


def test_one_percent_of_a_gain_is_seen_and_located(golden: Flight, tmp_path: Path) -> None:
    found = compare(golden, fly_square(tmp_path / "gain.rec", params={"ATC_RAT_RLL_P": 0.135 * 1.01}))
    assert not found.ok
    assert "position.max" in failed(found)
    assert found.differences["position"].max < 0.3
    assert found.first is not None
    assert "s after item" in found.first.words
    assert "of the golden" in found.first.words
    assert any("parameter ATC_RAT_RLL_P" in note for note in found.notes)


def test_one_percent_of_a_rovers_gain_is_seen(squares: Path, tmp_path: Path) -> None:
    found = compare(read(squares / "rover.rec"), fly_square(tmp_path / "r.rec", "rover", params={"ATC_SPEED_P": 0.101}))
    assert not found.ok
    assert {"position.max", "delay.max"} <= failed(found)


def test_a_moved_waypoint_is_located(golden: Flight, tmp_path: Path) -> None:
    def move(items: tuple[MissionItem, ...]) -> tuple[MissionItem, ...]:
        east = items[3]._replace(y=items[3].y + 110)  # about 1 m
        return (*items[:3], east, *items[4:])

    found = compare(golden, fly_square(tmp_path / "moved.rec", change=move))
    assert "cross_track.max" in failed(found)
    assert 0.5 < found.differences["cross_track"].max < 1.5
    assert found.first is not None
    t, before = found.first.t, {seq: t for t, seq in found.pair.new.items}
    assert before[1] < t < before[3] + 1.0
    worst = found.differences["cross_track"]
    assert before[2] < worst.t[worst.worst()] < before[4]


def test_a_changed_height_is_told_as_such(golden: Flight, tmp_path: Path) -> None:
    found = compare(
        golden,
        fly_square(
            tmp_path / "high.rec", change=lambda items: (*items[:4], items[4]._replace(z=items[4].z + 1.0), *items[5:])
        ),
    )
    assert found.differences["altitude"].max == pytest.approx(1.0, abs=0.4)
    assert "altitude.max" in failed(found)


def test_a_lost_text_is_named_with_its_place(golden: Flight) -> None:
    lost = [text for text in golden.track.texts if text[2] != "Reached command #3"]
    found = compare(golden, replace(golden, track=replace(golden.track, texts=lost)))
    assert failed(found) == {"texts.order"}
    assert found.first is not None
    assert "'Reached command #3' is missing" in found.first.words
    assert "after item" in found.first.words


def test_a_lost_item_a_new_mode_and_a_late_text_are_named(golden: Flight) -> None:
    track = golden.track
    items = [item for item in track.items if item[1] != 2]
    modes = [*track.modes, (70.0, "LOITER"), (71.0, "AUTO")]
    late = [(t + 0.5 * (text == "Disarming motors"), severity, text) for t, severity, text in track.texts]
    found = compare(golden, replace(golden, track=replace(track, items=items, modes=modes, texts=late)))
    assert failed(found) == {"items.order", "modes.order", "texts.time"}
    words = {metric.name: metric.words for metric in found.metrics}
    assert "item 2 is missing" in words["items.order"]
    assert "mode LOITER is new" in words["modes.order"]
    assert "'Disarming motors' comes 0.50 s later" in words["texts.time"]


def test_a_message_of_the_client_that_is_lost_is_seen_and_located(squares: Path, golden: Flight) -> None:
    recording = read_recording(squares / "copter.rec")
    received = [entry for entry in recording.entries if entry.kind is EntryKind.RECEIVED]
    start = received[-1]  # MISSION_START
    assert start.time_us == pytest.approx(42.6e6, abs=0.5e6)
    entries = [entry for entry in recording.entries if entry is not start]
    lost = of_recording(replace(recording, entries=entries, sections={}))
    found = compare(golden, lost)
    assert not found.ok
    assert found.first is not None
    assert found.first.t < 10.0
    assert any("the replay differs" in note for note in found.notes)


def test_numbers_in_texts_do_not_count_unless_asked(golden: Flight) -> None:
    other = [(t, severity, text.replace("ground at 0.", "ground at 1.")) for t, severity, text in golden.track.texts]
    new = replace(golden, track=replace(golden.track, texts=other))
    assert compare(golden, new, "same").ok
    assert not compare(golden, new, {"texts": {"numbers": True}}).ok
    ignored = {"texts": {"numbers": True, "ignore": ["^SIM "]}}
    assert compare(golden, new, ignored).ok


def test_another_seed_is_alike_and_not_the_same(golden: Flight, tmp_path: Path) -> None:
    other = fly_square(tmp_path / "seed.rec", seed=2)
    assert default_tolerance(golden, other) == "alike"
    assert compare(golden, other).ok
    assert not compare(golden, other, "same").ok
    assert any("seed 1 -> 2" in note for note in compare(golden, other).notes)


def test_logs_of_the_flight_are_compared_alike(squares: Path, golden: Flight) -> None:
    for ending in ("tlog", "bin"):
        found = compare(golden, read(squares / f"copter.{ending}"))
        assert found.tolerance.name == "alike"
        assert found.ok, found.headline
        assert found.differences["position"].max < 0.05


def test_a_tolerance_without_limits_judges_nothing(golden: Flight, tmp_path: Path) -> None:
    other = fly_square(tmp_path / "seed.rec", seed=3)
    names = ("position", "cross_track", "altitude", "speed", "climb", "tilt", "heading")
    nothing = {name: {"max": False, "rms": False} for name in names}
    nothing |= {name: {"max": False} for name in ("delay", "duration", "energy")}
    nothing |= {name: {"time": False} for name in ("items", "modes", "texts")}
    found = compare(golden, other, nothing)
    assert found.ok
    assert not any(metric.is_judged for metric in found.metrics)
