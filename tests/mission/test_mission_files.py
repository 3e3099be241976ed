# SPDX-License-Identifier: BSD-3-Clause
"""Mission files are read, written, and refused with the place of the mistake."""

from __future__ import annotations

import contextlib
import json
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sitl.autopilot.mission import item as c
from sitl.autopilot.mission.files import (
    MissionFileError,
    format_plan,
    format_wpl,
    load,
    parse_plan,
    parse_wpl,
    save,
)
from sitl.autopilot.mission.item import COMMANDS, MissionItem, home_item
from sitl.autopilot.mission.mission import Mission

HOME = home_item(-353632621, 1491652371, 584.0)
SQUARE = Mission.of(
    [
        HOME,
        MissionItem(c.NAV_TAKEOFF, z=10.0),
        MissionItem(c.NAV_WAYPOINT, p1=2.0, x=-353629926, y=1491652371, z=10.5),
        MissionItem(c.DO_JUMP, p1=1.0, p2=-1.0),
        MissionItem(c.DO_SET_ROI_LOCATION, x=-1, y=1799999999, z=-3.25),
        MissionItem(c.NAV_RETURN_TO_LAUNCH),
    ]
)


@pytest.mark.parametrize("name", ["square.waypoints", "square.plan"])
def test_there_and_back(tmp_path: Path, name: str) -> None:
    """What was saved is what is loaded, to the last degE7."""
    save(SQUARE, tmp_path / name)
    assert [i._replace(current=0) for i in load(tmp_path / name).items] == list(SQUARE.items)


places = st.integers(-1800000000, 1800000000)
items = st.builds(
    MissionItem,
    st.sampled_from(sorted(COMMANDS)),
    st.sampled_from([0, 3, 10]),
    *[st.integers(-1000, 1000).map(lambda k: k / 8)] * 4,
    places.map(lambda k: k // 2),
    places,
    st.integers(-8000, 8000).map(lambda k: k / 8),
    st.sampled_from([0, 1]),
    st.just(0),
)


@given(st.lists(items, max_size=5))
@settings(max_examples=60)
def test_any_mission_there_and_back(listed: list[MissionItem]) -> None:
    """Both formats keep every item."""
    mission = Mission.of([HOME, *listed])
    assert parse_wpl(format_wpl(mission)).items[1:] == mission.items[1:]
    assert parse_plan(format_plan(mission)).items == mission.items


def test_ground_station_text() -> None:
    """A file as ground stations write it: tabs, carriage returns, item 0 current."""
    text = "QGC WPL 110\r\n0\t1\t0\t16\t0\t0\t0\t0\t-35.3632621\t149.1652371\t584.0\t1\r\n"
    text += "1\t0\t3\t22\t0.0\t0\t0\t0\t0\t0\t10\t1\r\n\r\n"
    mission = parse_wpl(text)
    assert len(mission) == 2
    assert mission.items[0].x == -353632621
    assert mission.items[1].command == c.NAV_TAKEOFF


ROW0 = "0\t1\t0\t16\t0\t0\t0\t0\t-35.0\t149.0\t584.0\t1\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", r"m:1: expected 'QGC WPL 110', found ''"),
        ("QGC WPL 120\n", r"m:1: expected 'QGC WPL 110', found 'QGC WPL 120'"),
        ("QGC WPL 110\n1 2 3\n", r"m:2: 3 columns, expected 12"),
        ("QGC WPL 110\n" + ROW0.replace("149.0", "east"), r"m:2: y: 'east' is not a number"),
        ("QGC WPL 110\n" + ROW0.replace("\t16\t", "\t16.5\t"), r"m:2: command: '16.5' is not a whole number"),
        ("QGC WPL 110\n" + ROW0 + "\n" + ROW0, r"m:4: index 0, expected 1"),
        ("QGC WPL 110\n" + ROW0.replace("-35.0", "-95.0"), r"m:2: invalid latitude \(command 16, frame 0\)"),
        ("QGC WPL 110\n" + ROW0.replace("-35.0", "nan"), r"m:2: place nan, 149.0 is not a pair"),
        ("QGC WPL 110\n" + ROW0.replace("-35.0", "1e400"), r"m:2: place inf"),
        ("QGC WPL 110\n" + ROW0.replace("\t16\t", "\t9\t"), r"m:2: unsupported command"),
    ],
)
def test_text_refused(text: str, message: str) -> None:
    """Each mistake is told with file and line."""
    with pytest.raises(MissionFileError, match=message):
        parse_wpl(text, "m")


def plan(**changes: object) -> str:
    """A plan of one item with changes."""
    entry = {
        "type": "SimpleItem",
        "command": 16,
        "frame": 3,
        "params": [0, 0, 0, None, -35.0, 149.0, 10],
        **changes,
    }
    return json.dumps({"fileType": "Plan", "mission": {"items": [entry], "plannedHomePosition": [1.0, 2.0, 3.0]}})


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('{\n"mission": [,]}', r"m:2: "),
        ("[]", r"m: no 'mission'"),
        ("{}", r"m: no 'mission'"),
        (plan(type="ComplexItem"), r"m: mission.items\[0\]: type 'ComplexItem'"),
        (plan(params=[1, 2]), r"m: mission.items\[0\].params: expected a list of 7"),
        (plan(params=[0, 0, 0, 0, "x", 0, 0]), r"m: mission.items\[0\].params: 'x' is not a number"),
        (plan(command="16"), r"m: mission.items\[0\].command: '16' is not a whole number"),
        (plan(frame=None), r"m: mission.items\[0\].frame: None"),
        (plan(params=[None, 0, 0, 0, 0, 0, 0]), r"m: mission.items\[0\]: invalid parameter 1"),
    ],
)
def test_plan_refused(text: str, message: str) -> None:
    """Each mistake is told with file and item."""
    with pytest.raises(MissionFileError, match=message):
        parse_plan(text, "m")


def test_no_file(tmp_path: Path) -> None:
    """A missing file is named."""
    with pytest.raises(MissionFileError, match=r"nothing\.plan"):
        load(tmp_path / "nothing.plan")


@given(st.text(alphabet="QGC WPL110\n\t-.0123456789naif", max_size=200))
def test_no_text_breaks_it(text: str) -> None:
    """Any text is a mission or a MissionFileError."""
    for head in ("", "QGC WPL 110\n"):
        with contextlib.suppress(MissionFileError):
            parse_wpl(head + text)
