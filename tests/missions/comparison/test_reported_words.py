# SPDX-License-Identifier: BSD-3-Clause
"""Lines, pages and JUnit of comparisons, of tracks that are written here; exit codes of ``sitl mission compare``."""

from __future__ import annotations

import argparse
import math
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from sitl.logs.track import Track
from sitl.missions.cli import compare as command
from sitl.missions.comparison import compare as comparing
from sitl.missions.comparison import flight, report, scene
from sitl.missions.comparison.compare import Comparison, Metric, compare
from sitl.missions.comparison.flight import Flight
from sitl.missions.comparison.report import Case
from tests.missions.comparison.conftest import straight
from tests.missions.comparison.test_words import NAMES, OFF, changed, compared, header

LOOSE = {"base": "alike", **dict.fromkeys(NAMES, OFF), "delay": {"max": False}}


@pytest.fixture(autouse=True)
def no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """They have tests of their own."""
    monkeypatch.setattr(report, "_pictures", lambda comparison: "<!-- pictures -->")
    monkeypatch.setattr(scene, "write", lambda comparison, folder: Path(folder) / "flights.html")


def metric(value: float, limit: float, unit: str = "m") -> Metric:
    return Metric("altitude.max", "altitude <up>", value, unit, limit, 1.0, "somewhere & so")


# ---------------------------------------------------------------- metrics


@pytest.mark.parametrize(
    ("value", "limit", "ok", "judged"),
    [(0.5, 0.5, True, True), (0.5001, 0.5, False, True), (9.0, math.inf, True, False), (0.0, 0.0, True, True)],
)
def test_a_metric_is_kept_up_to_its_limit(value: float, limit: float, ok: bool, judged: bool) -> None:
    found = metric(value, limit)
    assert (found.ok, found.is_judged) == (ok, judged)


@pytest.mark.parametrize(
    ("value", "limit", "state", "mark", "bar"),
    [
        (0.25, 0.5, "", "&#10003;", "50%"),
        (0.5, 0.5, "", "&#10003;", "100%"),
        (5.0, 0.5, "bad", "&#10007;", "100%"),
        (0.0, 0.0, "", "&#10003;", "0%"),
        (0.1, 0.0, "bad", "&#10007;", "100%"),
        (5.0, math.inf, "idle", "&middot;", None),
    ],
)
def test_a_row_has_its_mark_and_a_bar_up_to_its_limit(
    value: float, limit: float, state: str, mark: str, bar: str | None
) -> None:
    row = report._row(metric(value, limit))
    assert row.startswith(f'<tr class="{state}"><td class="mark">{mark}</td><td>altitude &lt;up&gt;</td>')
    assert re.findall(r"width:(\d+%)", row) == ([bar] if bar is not None else [])
    assert row.endswith('<td class="where">somewhere &amp; so</td></tr>')


def test_what_differs_is_told_in_lines_or_all_of_it() -> None:
    found = compared(changed(since=5.0, down=-3.0), {**LOOSE, "altitude": {"max": 0.5, "rms": False}})
    first, *rest = report.lines(found)
    assert first == (
        "DIFFERS: does not fly like the golden flight: 5.0 s after AUTO began: 3.00 m above the golden path"
    )
    (line,) = [line for line in rest if not line.startswith("  note")]
    assert line == (
        f"  ! {'altitude':28} {'3.00 m':>10}  allowed {'0.50 m':>9}  5.0 s after AUTO began: 3.00 m above the golden "
        "path"
    )
    everything = report.lines(found, True)
    assert everything[0] == first and line in everything
    assert sum(text.startswith(("    ", "  ! ")) for text in everything) == len(found.metrics)


def test_what_differs_within_its_limits_is_told_after_the_verdict() -> None:
    found = compared(changed(since=5.0, down=-0.05))
    verdict, first = report.lines(found)[:2]
    assert verdict == "OK: flies like the golden flight"
    assert first.startswith("  first difference at all: 5.0 s after AUTO began: 0.05 m above ")
    assert report.lines(compared(straight()))[0] == ("OK: flies like the golden flight, to the last digit of its track")


# ---------------------------------------------------------------- the page


def head(found: Comparison, **given: Any) -> str:
    return report.html(found, **given).split("</header>")[0]


def test_the_head_of_a_page() -> None:
    good = head(compared(straight()))
    assert '<header class=""><h1>Flies like the golden flight</h1>' in good
    assert "<p>No difference beyond rounding.</p>" in good and "<title>new.rec: flies like" in good
    judged = sum(one.is_judged for one in compared(straight()).metrics)
    assert f"{judged} of {judged} metrics within tolerance <b>alike</b>; copter, 20.0 s" in good
    assert "one scene" not in good
    near = head(compared(changed(since=5.0, down=-0.05)), title="A < B")
    assert "<b>First difference at all, within tolerance:</b> 5.0 s after AUTO began: 0.05 m above" in near
    assert "<title>A &lt; B: flies like" in near
    bad = head(compared(changed(since=5.0, down=-9.0)), shown="flights.html")
    assert '<header class="bad"><h1>Does not fly like the golden flight</h1>' in bad
    assert "<b>First divergence:</b> 5.0 s after AUTO began: 9.00 m above" in bad
    assert '<a href="flights.html">Both flights in one scene</a>' in bad
    failed = re.search(r"(\d+) of (\d+) metrics", bad)
    assert failed is not None and int(failed[2]) == judged and int(failed[1]) == judged - 4, "of two, each also RMS"


def test_notes_of_both_flights_are_listed_where_there_are_some() -> None:
    assert "What is known of the two" not in report.html(compared(straight()))
    noted = compare(Flight("a", straight(), notes=("x & y",)), Flight("b", straight(), notes=("z",)), "alike")
    assert noted.notes == ["golden: x & y", "new: z"]
    assert "<ul><li>golden: x &amp; y</li><li>new: z</li></ul>" in report.html(noted)
    assert report.lines(noted)[-2:] == ["  note: golden: x & y", "  note: new: z"]


@pytest.mark.parametrize(
    ("items", "limit", "rows"),
    [
        ([(10.0, 1), (20.0, 2)], 0.5, [("", "10.00 s", "10.00 s", "+0.00 s", "item 1"),
                                      ("", "20.00 s", "20.00 s", "+0.00 s", "item 2")]),
        ([(10.25, 1), (19.0, 2)], 0.5, [("", "10.00 s", "10.25 s", "+0.25 s", "item 1"),
                                        ("bad", "20.00 s", "19.00 s", "-1.00 s", "item 2 (at another time)")]),
        ([(20.0, 2), (20.0, 3)], 0.5, [("bad", "10.00 s", "-", "missing", "item 1 (missing)"),
                                       ("", "20.00 s", "20.00 s", "+0.00 s", "item 2"),
                                       ("bad", "-", "20.00 s", "added", "item 3 (added)")]),
        ([(20.0, 2)], False, [("", "10.00 s", "-", "missing", "item 1 (missing)"),
                              ("", "20.00 s", "20.00 s", "+0.00 s", "item 2")]),
    ],
)  # fmt: skip
def test_each_event_has_a_row_with_both_times(items: Any, limit: Any, rows: list[Any]) -> None:
    found = compared(replace(straight(), items=items), {**LOOSE, "items": {"time": limit}})
    cells = re.findall(
        r'<tr class="(\w*)"><td class="mark">(&#\d+;)</td><td class="n">([^<]*)</td><td class="n">([^<]*)</td>'
        r'<td class="n value">([^<]*)</td><td>(item[^<]*)</td></tr>',
        report.html(found),
    )
    assert [(state, *rest) for state, _, *rest in cells] == rows
    assert all((mark == "&#10007;") == (state == "bad") for state, mark, *_ in cells)


def test_a_folder_holds_the_page_and_junit_and_a_scene_of_what_differs(tmp_path: Path) -> None:
    good, bad = compared(straight()), compared(changed(down=-9.0))
    page = report.report_write(bad, tmp_path / "new" / "bad", "T")
    assert page == tmp_path / "new" / "bad" / "report.html" and 'href="flights.html"' in page.read_text()
    assert sorted(path.name for path in page.parent.iterdir()) == ["junit.xml", "report.html"]
    assert "flights.html" not in report.report_write(good, tmp_path / "good").read_text()


def test_junit_counts_what_failed_and_what_could_not_be_run(tmp_path: Path) -> None:
    cases = [
        Case("one", "a", 1.25), Case("one", "b", 0.5, failure="first line\nsecond", output="out"),
        Case("one", "c", error="broke"), Case("two", "d", 2.0),
    ]  # fmt: skip
    report.junit_write(tmp_path / "j.xml", cases)
    root = ElementTree.parse(tmp_path / "j.xml").getroot()
    assert [suite.attrib for suite in root] == [
        {"name": "one", "tests": "3", "failures": "1", "errors": "1", "time": "1.750"},
        {"name": "two", "tests": "1", "failures": "0", "errors": "0", "time": "2.000"},
    ]
    a, b, c = root[0]
    assert a.attrib == {"classname": "one", "name": "a", "time": "1.250"} and len(a) == 0
    assert [(child.tag, child.get("message"), child.text) for child in b] == [
        ("failure", "first line", "first line\nsecond"), ("system-out", None, "out"),
    ]  # fmt: skip
    assert [(child.tag, child.text) for child in c] == [("error", "broke")]
    found = report.cases_of(compared(changed(down=-9.0), {**LOOSE, "altitude": {"max": 0.5, "rms": False}}))
    failed = [case for case in found if case.failure]
    assert [case.name for case in failed] == ["altitude.max"] and failed[0].suite == "new.rec"
    assert failed[0].failure == (
        "altitude: 9.00 m, 0.50 m allowed. 0.0 s after AUTO began: 9.00 m above the golden path"
    )
    assert all(case.output for case in found) and not any(case.name == "position.max" for case in found)


# ---------------------------------------------------------------- the verdict


def test_a_part_of_golden_that_is_left_out_is_told_by_its_point() -> None:
    golden = straight(20.0)
    short = golden.between(0.0, 12.0)
    found = compared(short, {**LOOSE, "cross_track": {"max": 1.0}, "duration": {"max": False},
                             "items": {"time": False}, "texts": {"time": False}}, golden)  # fmt: skip
    (failed,) = found.failed
    assert failed.name == "cross_track.max" and failed.value == pytest.approx(16.0, abs=0.3)
    assert re.fullmatch(
        r"the point 20\.0 m north, 20\.0 m east of home \(golden at 20\.0 s\) is missed by this much", failed.words
    )
    assert found.first is not None
    assert found.first.words.startswith(f"cross-track {failed.value:.2f} m, 1.00 m allowed (the point 20.0 m north")


def test_what_has_no_moment_is_told_with_what_is_allowed() -> None:
    limits = {**LOOSE, "duration": {"max": 1.0}, "items": {"time": False}, "texts": {"time": False}}
    found = compared(straight(25.0), limits)
    assert found.first is not None and found.first.t == 0.0
    assert found.first.words == "duration 5.00 s, 1.00 s allowed (25.0 s, golden 20.0 s)"
    assert compared(straight(20.5), limits).first is None


def test_of_the_last_bits_alone_the_seconds_are_told() -> None:
    golden, new = (Flight("a", straight(), bits=found) for found in ((b"a", b"b", b"c"), (b"a", b"x", b"y")))
    found = compare(golden, new, "exact")
    assert found.first is not None
    assert re.fullmatch(
        r"the last bits differ from some time between \d+ and \d+ s after power-on; the track that is kept is the same",
        found.first.words,
    )
    assert found.headline.endswith(found.first.words)
    same = compare(golden, golden, "exact")
    assert same.headline == "flies like the golden flight, to the last bit" and same.first is None


def test_an_event_that_comes_first_is_told_with_how_far_the_flight_is_at_most() -> None:
    track = replace(changed(since=8.0, east=3.0), items=[(5.0, 1), (20.0, 2)])
    track.data[120, 2] += 1.0
    found = compared(track, {**LOOSE, "position": {"max": 1.0, "rms": False}, "items": {"time": 0.5}})
    assert found.first is not None and found.first.t == 5.0
    assert found.first.words == (
        "5.0 s after AUTO began: item 1 comes 5.00 s earlier than in the golden flight; farthest 4.00 m east of the "
        "golden position, 7.0 s after item 1"
    )


@pytest.mark.parametrize(("by", "traced"), [(0.01, False), (0.02, True), (-0.02, True)])
def test_a_hundredth_of_a_metre_of_height_is_rounding(by: float, traced: bool) -> None:
    assert (compared(changed(down=by)).first_trace is not None) == traced


@pytest.mark.parametrize(("by", "traced"), [(0.001, False), (0.002, True), (-0.002, True)])
def test_a_millisecond_of_an_event_is_rounding(by: float, traced: bool) -> None:
    found = compared(replace(straight(), items=[(10.0 + by, 1), (20.0, 2)]))
    assert (found.first_trace is not None) == traced
    if found.first_trace is not None:
        assert found.first_trace.words.startswith("10.0 s after AUTO began: item 1 comes 0.00 s ")


def test_another_version_is_advice_only_where_flights_differ(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(comparing.identity, "differences", lambda old, now: ["seed 1, now 2"])
    monkeypatch.setattr(comparing.identity, "code_differences", lambda old, now: ["physics"] if old != now else [])
    golden = Flight("a", straight(), header(version="1"))

    def found(version: str, **by: float) -> Comparison:
        return compare(golden, Flight("b", changed(**by), header(version=version)), "alike")

    assert found("1", down=-9.0).advice == "" == found("2").advice
    assert found("2").other_version == "another version of the simulator recorded the golden flight (physics)"
    advice = found("2", down=-9.0).advice
    assert advice.startswith("another version of the simulator recorded the golden flight (physics): versions may fly")
    assert f"  {advice}" in report.lines(found("2", down=-9.0))
    assert found("1").notes == ["differs: seed 1, now 2"]
    assert compare(golden, Flight("b", straight()), "alike").other_version == ""


@pytest.mark.parametrize(("state", "text"), [(b"1", "the same state, bit for bit"), (b"2", "another state, bit for")])
def test_the_end_of_both_is_noted(state: bytes, text: str) -> None:
    golden, new = (Flight("a", straight(), digests={"state": one}) for one in (b"1", state))
    (note,) = compare(golden, new, "alike").notes
    assert note.startswith(f"the vehicle ends in {text}")


# ---------------------------------------------------------------- the command


@pytest.fixture
def flights(monkeypatch: pytest.MonkeyPatch) -> Callable[..., Any]:
    """Runs the command on tracks by their names."""

    def run(tracks: dict[str, Track], *words: str) -> int:
        monkeypatch.setattr(flight, "read", lambda path, system, progress: Flight(str(path), tracks[str(path)]))
        parser = argparse.ArgumentParser()
        command.add_parser(parser.add_subparsers())
        options = parser.parse_args(["compare", "a.tlog", "b.tlog", *words])
        return int(options.function(options))

    return run


@pytest.mark.parametrize(("down", "words", "code"), [(0.0, (), 0), (-9.0, (), 1), (-0.3, (), 0),
                                                     (-0.3, ("--tolerance", "same"), 1)])  # fmt: skip
def test_the_exit_code_is_1_where_a_limit_is_exceeded(
    flights: Any, down: float, words: tuple[str, ...], code: int, capsys: pytest.CaptureFixture[str]
) -> None:
    tracks = {"a.tlog": straight(), "b.tlog": changed(down=down)}
    assert flights(tracks, *words) == code
    some = capsys.readouterr().out.splitlines()
    assert some[0].startswith("DIFFERS: " if code else "OK: ")
    assert flights(tracks, *words, "--all") == code
    assert len(capsys.readouterr().out.splitlines()) > len(some) + 10


def test_the_report_is_named_last(flights: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    tracks = {"a.tlog": straight(), "b.tlog": changed(down=-9.0)}
    assert flights(tracks, "--report", str(tmp_path / "r")) == 1
    assert capsys.readouterr().out.splitlines()[-1] == f"report: {tmp_path / 'r' / 'report.html'}"
    assert (tmp_path / "r" / "junit.xml").is_file()
