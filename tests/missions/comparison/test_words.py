# SPDX-License-Identifier: BSD-3-Clause
"""What a comparison says, of tracks that are written here: which event or place comes first, how far, how late."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from sitl.logs.track import Track
from sitl.missions.comparison import words
from sitl.missions.comparison.alignment import pair
from sitl.missions.comparison.compare import Comparison, compare, default_tolerance
from sitl.missions.comparison.events import ADDED, MISSING, SHIFTED, Event
from sitl.missions.comparison.flight import Flight, Series
from sitl.physics.engines import NATIVE
from tests.missions.comparison.conftest import straight

OFF = {"max": False, "rms": False}
NAMES = ("position", "cross_track", "altitude", "speed", "climb", "tilt", "heading")


def compared(new: Track, tolerance: Any = "alike", golden: Track | None = None) -> Comparison:
    return compare(Flight("golden.rec", golden or straight()), Flight("new.rec", new), tolerance)


def changed(since: float = 0.0, **by: float) -> Track:
    """The straight flight, other by constants from a time on."""
    track = straight()
    data = track.data.copy()
    columns = ("t", "north", "east", "down", "vn", "ve", "vd", "roll", "pitch", "yaw", "energy")
    for name, value in by.items():
        data[data[:, 0] >= since - 1e-9, columns.index(name)] += value
    return replace(track, data=data)


# ---------------------------------------------------------------- single words


@pytest.mark.parametrize(
    ("gap", "text"),
    [
        ((0.8, 0.0, 0.0), "0.80 m north of it"),
        ((-0.8, 0.1, 0.0), "0.80 m south of it"),
        ((0.0, 0.51, 0.43), "0.51 m east of and 0.43 m below it"),
        ((0.0, -0.51, -0.43), "0.51 m west of and 0.43 m above it"),
        ((1.0, 0.39, 0.0), "1.00 m north of it"),
        ((0.0, 0.0, -0.05), "0.05 m above it"),
        ((1.0, 1.0, 1.0), "1.00 m north and 1.00 m east of and 1.00 m below it"),
    ],
)
def test_the_parts_of_a_gap_that_matter(gap: Any, text: str) -> None:
    assert words.direction(np.array(gap), "it") == text


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (0.05, "m", "0.050 m"),
        (0.1, "m", "0.10 m"),
        (12.345, "s", "12.35 s"),
        (0.0, "m", "0.00 m"),
        (3.14159, "deg", "3.1 deg"),
        (2.0, "", "2"),
        (math.inf, "m", "-"),
        (math.nan, "", "-"),
    ],
)
def test_numbers_with_their_units(value: float, unit: str, text: str) -> None:
    assert words.number(value, unit) == text


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("altitude", 0.5, "0.50 m above the golden path"),
        ("altitude", -0.5, "0.50 m below the golden path"),
        ("delay", 0.25, "0.25 s later than the golden flight at the same point of the path"),
        ("delay", -0.25, "0.25 s earlier than the golden flight at the same point of the path"),
        ("speed", 1.0, "1.00 m/s faster than the golden flight"),
        ("speed", -1.0, "1.00 m/s slower than the golden flight"),
        ("climb", 1.0, "climb rate 1.00 m/s higher than in the golden flight"),
        ("climb", -1.0, "climb rate 1.00 m/s lower than in the golden flight"),
        ("tilt", 3.0, "roll and pitch differ by 3.0 deg"),
        ("heading", 9.0, "heading 9.0 deg right of the golden heading"),
        ("heading", -9.0, "heading 9.0 deg left of the golden heading"),
    ],
)
def test_signs_of_differences_in_words(name: str, value: float, text: str) -> None:
    series = Series(name, "", "", 0.0, np.zeros(2), np.array([0.0, value]))
    assert words.deviation(series, 1) == text


def test_places_are_of_the_position_or_of_the_path() -> None:
    gap = np.array([[0.0, 0.0, 0.0], [0.0, 2.0, 0.0]])
    for name, what in (("position", "position"), ("cross_track", "path")):
        series = Series(name, "", "m", 0.0, np.zeros(2), np.array([0.0, 2.0]), gap)
        assert words.deviation(series, 1) == f"2.00 m east of the golden {what}"


@pytest.mark.parametrize(
    ("t", "text"),
    [
        (0.0, "0.0 s after AUTO began"),
        (3.0, "3.0 s after AUTO began"),
        (10.0, "0.0 s after item 1"),
        (12.5, "2.5 s after item 1"),
        (15.5, "0.5 s after mode RTL"),
        (20.0, "0.0 s after item 2"),
    ],
)
def test_times_count_from_the_last_event(t: float, text: str) -> None:
    track = replace(straight(), modes=[(0.0, "AUTO"), (15.0, "RTL")])
    assert words.when(pair(track, track), t) == text


@pytest.mark.parametrize(
    ("golden", "new", "limit", "difference"),
    [
        (1.0, None, 9.0, MISSING),
        (None, 1.0, 9.0, ADDED),
        (1.0, 1.5, 0.5, ""),
        (1.0, 1.51, 0.5, SHIFTED),
        (1.0, 0.4, 0.5, SHIFTED),
        (0.0, 0.0, 0.0, ""),
    ],
)
def test_events_of_one_flight_or_at_another_time(golden: Any, new: Any, limit: float, difference: str) -> None:
    event = Event("items", "item 3", golden, new)
    assert event.difference(limit) == difference
    assert event.time == (golden if new is None else new) and event.shift == (
        0.0 if None in (golden, new) else new - golden
    )


def test_events_in_words() -> None:
    assert words.event_text(Event("items", "item 3", 4.0, None), MISSING) == "item 3 is missing (golden: at 4.0 s)"
    assert words.event_text(Event("items", "item 3", None, 4.0), ADDED) == "item 3 is new"
    later = "item 3 comes 0.50 s later than in the golden flight"
    assert words.event_text(Event("items", "item 3", 1.0, 1.5), SHIFTED) == later
    assert words.event_text(Event("items", "item 3", 1.5, 1.0), SHIFTED) == later.replace("later", "earlier")


# ---------------------------------------------------------------- metrics


def value(found: Comparison, name: str) -> float:
    return next(metric.value for metric in found.metrics if metric.name == name)


@pytest.mark.parametrize(
    ("by", "name", "size"),
    [
        ({"north": 0.3}, "position.max", 0.3),
        ({"east": 0.4}, "cross_track.max", 0.4),
        ({"down": -0.5}, "altitude.max", 0.5),
        ({"vn": 0.7, "ve": 0.0}, "speed.max", 0.7),
        ({"vd": -0.6}, "climb.max", 0.6),
        ({"yaw": 0.2}, "heading.max", math.degrees(0.2)),
        ({"roll": 0.03, "pitch": 0.04}, "tilt.max", math.degrees(0.05)),
    ],
)
def test_each_difference_has_its_metric(by: dict[str, float], name: str, size: float) -> None:
    assert value(compared(changed(**by)), name) == pytest.approx(size, rel=0.02)


def test_what_is_not_judged_does_not_fail() -> None:
    limits = {"base": "alike", **dict.fromkeys(NAMES, OFF), "delay": {"max": False}}
    assert compared(changed(north=0.4, down=-3.0), limits).ok
    found = compared(changed(north=0.4, down=-3.0), {**limits, "altitude": {"max": 2.9, "rms": False}})
    assert [metric.name for metric in found.failed] == ["altitude.max"]


def test_the_first_difference_beyond_its_limit_is_told_with_its_greatest() -> None:
    track = changed(since=5.0, down=-1.0)
    track.data[100:, 3] -= 1.0
    limits = {"base": "alike", **dict.fromkeys(NAMES, OFF), "delay": {"max": False}, "altitude": {"max": 0.5}}
    found = compared(track, limits)
    assert found.first is not None and found.first.t == pytest.approx(5.0)
    assert found.first.words == (
        "5.0 s after AUTO began: 1.00 m above the golden path; at most 2.00 m, 0.0 s after item 1"
    )
    assert found.headline == f"does not fly like the golden flight: {found.first.words}"


@pytest.mark.parametrize(("longer", "ok"), [(0.0, True), (1.0, True), (1.1, False)])
def test_durations(longer: float, ok: bool) -> None:
    found = compared(
        straight(20.0 + longer),
        {
            "base": "alike",
            **dict.fromkeys(NAMES, OFF),
            "delay": {"max": False},
            "duration": {"max": 1.0},
            "items": {"time": False},
            "texts": {"time": False},
        },
    )
    assert value(found, "duration.max") == pytest.approx(longer, abs=0.01)
    assert ("duration.max" in [metric.name for metric in found.failed]) != ok


@pytest.mark.parametrize(("wh", "change"), [(2.0, 0.0), (2.01, 0.0), (2.1, 5.0), (1.9, 5.0)])
def test_energies_in_per_cent(wh: float, change: float) -> None:
    """A hundredth of a watt-hour is rounding."""
    tracks = []
    for energy in (2.0, wh):
        track = straight()
        track.data[:, 10] = energy * track.t / track.t[-1]
        tracks.append(track)
    assert value(compared(tracks[1], "alike", tracks[0]), "energy.max") == pytest.approx(change, abs=0.01)
    assert not any(metric.name == "energy.max" for metric in compared(tracks[1]).metrics), "golden kept none"


@pytest.mark.parametrize(
    ("items", "wrong", "late"),
    [
        ([(10.0, 1), (20.0, 2)], 0, 0.0),
        ([(10.0, 1)], 1, 0.0),
        ([(10.0, 1), (15.0, 9), (20.0, 2)], 1, 0.0),
        ([(10.4, 1), (19.7, 2)], 0, 0.4),
        ([(10.0, 2), (20.0, 1)], 2, 10.0),
    ],
)
def test_items_that_are_missing_added_or_late(items: Any, wrong: int, late: float) -> None:
    found = compared(replace(straight(), items=items))
    assert value(found, "items.order") == wrong and value(found, "items.time") == pytest.approx(late, abs=0.002)


def test_of_many_wrong_texts_five_are_named() -> None:
    texts = [(float(k), 6, f"word {chr(97 + k)}") for k in range(8)]
    found = compared(replace(straight(), texts=texts), {"base": "same", **dict.fromkeys(NAMES, OFF)})
    told = next(metric.words for metric in found.metrics if metric.name == "texts.order")
    assert told.count("is new") + told.count("is missing") == 5 and told.endswith("; and 5 more")


# ---------------------------------------------------------------- which tolerance


def header(**given: Any) -> dict[str, Any]:
    from sitl.missions.comparison.compare import _DECIDED

    return {
        **dict.fromkeys(_DECIDED, 1),
        "world": None,
        "airframe": {"name": "x"},
        "params": {"SIM_WIND_SPD": 3.0, "RTL_ALT": 1.0},
        "physics": NATIVE,
        **given,
    }


@pytest.mark.parametrize(
    ("given", "preset"),
    [
        ({}, "exact"),
        ({"world": "maze"}, "alike"),
        ({"airframe": {"name": "y"}}, "alike"),
        ({"params": {"SIM_WIND_SPD": 4.0, "RTL_ALT": 1.0}}, "alike"),
        ({"params": {"RTL_ALT": 1.0}}, "alike"),
        ({"params": {"SIM_WIND_SPD": 3.0, "RTL_ALT": 9.0}}, "exact"),
    ],
)
def test_flights_of_the_same_run_are_compared_exactly(given: Any, preset: str) -> None:
    """Parameters of the autopilot may differ: that is what is compared."""
    golden = Flight("a", straight(), header(), bits=(b"1",))
    assert default_tolerance(golden, Flight("b", straight(), header(**given), bits=(b"1",))) == preset


def test_without_digests_or_on_another_engine_they_are_the_same() -> None:
    golden, new = Flight("a", straight(), header(), bits=(b"1",)), Flight("b", straight(), header(), bits=(b"1",))
    assert (
        default_tolerance(replace(golden, bits=()), new) == "same" == default_tolerance(golden, replace(new, bits=()))
    )
    other = header(physics="bullet")
    assert default_tolerance(replace(golden, header=other), replace(new, header=other)) in ("same", "alike")
    assert default_tolerance(golden, replace(new, header=None)) == "alike"


@pytest.mark.parametrize(
    ("bits", "count"), [((b"a", b"b"), 0), ((b"a", b"c"), 1), ((b"a",), 1), ((b"x", b"y", b"z"), 3)]
)
def test_digests_that_differ_are_counted(bits: tuple[bytes, ...], count: int) -> None:
    golden, new = (Flight("a", straight(), bits=found) for found in ((b"a", b"b"), bits))
    found = compare(golden, new, "exact")
    assert value(found, "bits") == count and found.ok == (count == 0)
