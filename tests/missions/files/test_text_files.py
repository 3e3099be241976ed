# SPDX-License-Identifier: BSD-3-Clause
"""QGC WPL 110 text is read, written, and refused with the place of the mistake."""

from __future__ import annotations

import contextlib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.mission import item as c
from sitl.missions.files import MissionFileError, load, save, store

ROW0 = "0\t1\t0\t16\t0\t0\t0\t0\t-35.0\t149.0\t584.0\t1\n"


def test_ground_station_text() -> None:
    """A file as ground stations write it: tabs, carriage returns, item 0 current."""
    text = "QGC WPL 110\r\n0\t1\t0\t16\t0\t0\t0\t0\t-35.3632621\t149.1652371\t584.0\t1\r\n"
    text += "1\t0\t3\t22\t0.0\t0\t0\t0\t0\t0\t10\t1\r\n\r\n"
    file = store.parse(text)
    assert len(file.mission) == 2
    assert file.mission.items[0].x == -353632621
    assert file.mission.items[1].command == c.NAV_TAKEOFF
    assert file.home == pytest.approx((-35.3632621, 149.1652371, 584.0))
    assert file.kind == "copter"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", r"m:1: expected 'QGC WPL 110', found ''"),
        ("QGC WPL 120\n", r"m:1: expected 'QGC WPL 110', found 'QGC WPL 120'"),
        ("QGC WPL 110\n1 2 3\n", r"m:2: 3 columns, expected 12 \(index current"),
        ("QGC WPL 110\n" + ROW0.replace("149.0", "east"), r"m:2: y: 'east' is not a number"),
        ("QGC WPL 110\n" + ROW0.replace("\t16\t", "\t16.5\t"), r"m:2: command: '16.5' is not a whole number"),
        ("QGC WPL 110\n" + ROW0 + "\n" + ROW0, r"m:4: index 0, expected 1"),
        ("QGC WPL 110\n" + ROW0.replace("-35.0", "-95.0"), r"m:2: latitude -95.0 is not within -90 .. 90"),
        ("QGC WPL 110\n" + ROW0.replace("149.0", "181"), r"m:2: longitude 181.0 is not within -180 .. 180"),
        ("QGC WPL 110\n" + ROW0.replace("584.0", "nan"), r"m:2: altitude nan is not a number of metres"),
        ("QGC WPL 110\n" + ROW0.replace("-35.0", "nan"), r"m:2: place nan, 149.0 is not a pair"),
        ("QGC WPL 110\n" + ROW0.replace("-35.0", "1e400"), r"m:2: place inf"),
        ("QGC WPL 110\n" + ROW0.replace("\t16\t0\t", "\t16\tinf\t"), r"m:2: parameter 1 is inf: a finite number"),
        ("QGC WPL 110\n" + ROW0.replace("\t16\t", "\t9\t"), r"m:2: command 9 is not known here; known are 16 WP, "),
        ("QGC WPL 110\n" + ROW0.replace("\t0\t16\t", "\t7\t16\t"), r"m:2: frame 7 is not known.*3 relative"),
        ("QGC WPL 110\n" + ROW0 + "1 0 3 177 7 2 0 0 0 0 0 1\n", r"m:3: p1: DO_JUMP to 7; there are items 1 to 1"),
    ],
)
def test_text_refused(text: str, message: str) -> None:
    """Each mistake is told with file, line, value and what is allowed."""
    with pytest.raises(MissionFileError, match=message):
        store.parse(text, "m")


def test_files_that_are_none(tmp_path: Path) -> None:
    """Missing, binary, of another suffix."""
    with pytest.raises(MissionFileError, match=r"nothing\.plan: No such file"):
        load(tmp_path / "nothing.plan")
    (tmp_path / "picture.txt").write_bytes(b"QGC \xff\xfe")
    with pytest.raises(MissionFileError, match=r"picture\.txt: byte 4 is no text"):
        load(tmp_path / "picture.txt")
    with pytest.raises(MissionFileError, match=r"suffix '\.kml' is not one of \.plan, \.waypoints, \.txt"):
        save(store.parse("QGC WPL 110\n" + ROW0), tmp_path / "m.kml")


def test_a_mark_at_the_begin_is_passed_over(tmp_path: Path) -> None:
    """Editors of some systems put a byte order mark there."""
    (tmp_path / "m.waypoints").write_bytes(b"\xef\xbb\xbfQGC WPL 110\n" + ROW0.encode())
    assert len(load(tmp_path / "m.waypoints").mission) == 1


def test_too_many_items_are_refused() -> None:
    rows = "".join(f"{k}\t0\t3\t20\t0\t0\t0\t0\t0\t0\t0\t1\n" for k in range(725))
    with pytest.raises(MissionFileError, match="too many items"):
        store.parse("QGC WPL 110\n" + rows, "m")


@given(st.text(alphabet="QGC WPL110\n\t-.0123456789naif", max_size=200))
def test_no_text_breaks_it(text: str) -> None:
    """Any text is a mission or a MissionFileError."""
    for head in ("", "QGC WPL 110\n"):
        with contextlib.suppress(MissionFileError):
            store.parse(head + text)
