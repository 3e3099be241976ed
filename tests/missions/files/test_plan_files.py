# SPDX-License-Identifier: BSD-3-Clause
"""QGroundControl plans and QGC WPL 110 text are read, written, and refused with the place of the mistake."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sitl.autopilot.mission import item as c
from sitl.autopilot.mission.item import COMMANDS, MissionItem, home_item
from sitl.autopilot.mission.mission import Mission
from sitl.core.mavlink import MavCmd
from sitl.missions.files import (
    FenceCircle,
    FencePolygon,
    MissionFile,
    MissionFileError,
    RallyPoint,
    load,
    plan,
    save,
    wpl,
)
from sitl.missions.files import plan as writer
from tests import mutations

HOME = home_item(-353632621, 1491652371, 584.0)
SQUARE = Mission.of(
    [
        HOME,
        MissionItem(MavCmd.NAV_TAKEOFF, z=10.0),
        MissionItem(MavCmd.NAV_WAYPOINT, p1=2.0, p4=math.nan, x=-353629926, y=1491652371, z=10.5),
        MissionItem(MavCmd.DO_JUMP, p1=1.0, p2=-1.0),
        MissionItem(MavCmd.DO_SET_ROI_LOCATION, x=-1, y=1799999999, z=-3.25),
        MissionItem(MavCmd.NAV_RETURN_TO_LAUNCH),
    ]
)
WHOLE = MissionFile(
    SQUARE,
    vehicle_type=10,
    firmware_type=12,
    cruise_speed=3.5,
    hover_speed=2.5,
    circles=(FenceCircle((-35.0, 149.0), 50.0, inclusion=False),),
    polygons=(FencePolygon(((-35.0, 149.0), (-35.1, 149.0), (-35.0, 149.1))),),
    breach_return=(-35.0, 149.0, 12.0),
    rally=(RallyPoint((-35.2, 149.2), 20.0),),
)


@pytest.mark.parametrize("name", ["square.waypoints", "square.plan"])
def test_there_and_back(tmp_path: Path, name: str) -> None:
    """What was saved is what is loaded, to the last degE7."""
    save(WHOLE, tmp_path / name)
    found = load(tmp_path / name).mission.items
    read = [tuple(map(float, i._replace(current=0))) for i in found]
    assert repr(read) == repr([tuple(map(float, i)) for i in SQUARE.items])  # a NaN is not itself


def test_a_plan_keeps_everything(tmp_path: Path) -> None:
    """Speeds, fence, rally points."""
    save(WHOLE, tmp_path / "whole.plan")
    found = load(tmp_path / "whole.plan")
    assert replace(found, mission=SQUARE, name=WHOLE.name) == WHOLE
    assert found.kind == "rover"


items = st.builds(
    MissionItem,
    st.sampled_from(sorted(set(COMMANDS) - {MavCmd.DO_JUMP, *c.FENCE_COMMANDS, MavCmd.NAV_RALLY_POINT})),
    st.sampled_from([0, 3, 10]),
    *[st.integers(-1000, 1000).map(lambda k: k / 8)] * 4,
    st.integers(-900000000, 900000000),
    st.integers(-1800000000, 1800000000),
    st.integers(-8000, 8000).map(lambda k: k / 8),
    st.sampled_from([0, 1]),
    st.just(0),
)


@given(st.lists(items, max_size=5))
@settings(max_examples=60)
def test_any_mission_there_and_back(listed: list[MissionItem]) -> None:
    """Both formats keep every item."""
    file = MissionFile(Mission.of([HOME, *listed, MissionItem(MavCmd.DO_JUMP, p1=1.0, p2=2.0), MissionItem(20)]))
    assert wpl.parse(wpl.write(file)).mission.items[1:] == file.mission.items[1:]
    assert plan.parse(writer.write(file)).mission.items == file.mission.items


def entry(**changes: object) -> dict[str, object]:
    """A waypoint as QGroundControl writes it, with changes."""
    params = [0, 0, 0, None, -35.0, 149.0, 10]
    return {"type": "SimpleItem", "command": 16, "frame": 3, "params": params, "autoContinue": True, **changes}


def text(*entries: object, **changes: object) -> str:
    """A plan of items."""
    mission = {"version": 2, "items": list(entries) or [entry()], "plannedHomePosition": [1.0, 2.0, 3.0]}
    return json.dumps({"fileType": "Plan", "version": 1, "mission": mission, **changes})


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ('{\n"mission": [,]}', r"m:2: Expecting value"),
        ("[" * 100000, r"m: lists within lists|m:1: "),
        ("[]", r"m: fileType is None: not a plan"),
        ('{"fileType": "Parameters"}', r"m: fileType is 'Parameters'"),
        ('{"fileType": "Plan", "version": 1}', r"m: no 'mission'"),
        (text(version=3), r"m: version: 3 is not 1"),
        (text(mission=[]), r"m: mission: \[\] is not an object"),
        (text(mission={"version": 1}), r"m: mission.version: 1 is not 2"),
        (text(mission={"version": 2}), r"m: mission: no 'items'; there are 'version'"),
        (text(entry(type="Item")), r"m: mission.items\[0\].type: 'Item' is not 'SimpleItem' or 'ComplexItem'"),
        (text(entry(params=[1, 2])), r"m: mission.items\[0\].params: expected a list of 7"),
        (text(entry(params=[0, 0, 0, 0, "x", 0, 0])), r"mission.items\[0\].params\[4\]: 'x' is not a number"),
        (text(entry(command="16")), r"m: mission.items\[0\].command: '16' is not a whole number"),
        (text(entry(), entry(frame=None)), r"m: mission.items\[1\].frame: None"),
        (text(entry(params=[None, 0, 0, 0, 0, 0, 0])), r"m: mission.items\[0\]: parameter 1 is nan"),
        (text(entry(params=[0, 0, 0, 0, 95.0, 0, 0])), r"m: mission.items\[0\]: latitude 95.0"),
        (text(entry(command=177, params=[7, 1, 0, 0, 0, 0, 0])), r"items\[0\].params: DO_JUMP to 7: no item has"),
        (text(geoFence={"circles": [{"circle": {"center": [1, 2]}}]}), r"geoFence.circles\[0\].circle: no 'radius'"),
        (text(geoFence={"polygons": [{"polygon": [[1, 2]]}]}), r"geoFence.polygons\[0\].polygon: 1 corners; a polygon"),
        (
            text(geoFence={"circles": [{"circle": {"center": [1, 200], "radius": 1}}]}),
            r"center\[1\]: 200 is not within",
        ),
        (text(rallyPoints={"points": [[1, 2]]}), r"rallyPoints.points\[0\]: expected \[latitude, longitude, height\]"),
    ],
)
def test_plan_refused(wrong: str, message: str) -> None:
    """Each mistake is told with file, member, value and what is allowed."""
    with pytest.raises(MissionFileError, match=message):
        plan.parse(wrong, "m")


def test_null_is_keep_the_heading_or_nothing() -> None:
    """In a waypoint's heading it stays NaN, in places and do-commands it is 0."""
    picture = entry(command=2000, params=[0, 0, 1, None, None, None, None])
    found = plan.parse(text(entry(params=[0, 0, 0, None, None, None, 10]), picture)).mission.items
    assert math.isnan(found[1].p4)
    assert found[1].no_location
    assert found[2].p4 == 0.0


def test_a_height_above_terrain_that_was_not_worked_out_is_above_home() -> None:
    """QGroundControl saves null while it does not know the terrain: that is neither sea level nor "as high as now"."""
    late = entry(command=16, frame=0, AltitudeMode=3, Altitude=80, params=[0, 0, 0, None, 1.0, 1.0, None])
    known = {**late, "params": [0, 0, 0, None, 1.0, 1.0, 664.0]}
    found = plan.parse(text(late, known)).mission.items
    assert (found[1].frame, found[1].z) == (3, 80.0)
    assert (found[2].frame, found[2].z) == (0, 664.0)


def test_numbers_beyond_what_can_be_sent_are_refused() -> None:
    """Parameters travel in single precision; Python reads no whole number of thousands of digits."""
    with pytest.raises(MissionFileError, match=r"items\[0\]: parameter 1 is 1e\+39"):
        plan.parse(text(entry(params=[1e39, 0, 0, 0, 0, 0, 0])), "m")
    with pytest.raises(MissionFileError, match=r"items\[0\]: longitude 1e\+308 is not within -180 .. 180 degrees"):
        plan.parse(text(entry(params=[0, 0, 0, 0, 47.0, 1e308, 10.0])), "m")
    with pytest.raises(MissionFileError, match=r"^m: .*4300 digits"):
        plan.parse(text(entry()).replace('"version": 1', '"version": ' + "1" * 5000), "m")


def test_jumps_go_to_the_item_with_that_id() -> None:
    """A ground station numbers items as it likes."""
    jump = entry(command=177, doJumpId=9, params=[5, 3, 0, 0, 0, 0, 0])
    found = plan.parse(text(entry(doJumpId=4), entry(doJumpId=5), jump)).mission.items
    assert found[3].p1 == 2.0


def test_frames_say_what_altitudes_count_from() -> None:
    """AttitudeMode follows the frame when a plan is written."""
    mission = Mission.of([HOME, *[MissionItem(16, frame, x=1, y=1, z=5.0) for frame in (3, 0, 10)]])
    written = json.loads(writer.write(MissionFile(mission)))["mission"]["items"]
    assert [row["AltitudeMode"] for row in written] == [1, 2, 4]
    assert [row["Altitude"] for row in written] == [5.0] * 3


json_values = st.recursive(
    st.none() | st.booleans() | st.integers(-(10**400), 10**400) | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.sampled_from(["type", "items", "x"]), inner),
    max_leaves=8,
)


def same_when_saved(form: ModuleType, text: str, name: str) -> None:
    """What is read of any text is the same again when it has been written; else it is refused by the file's name."""
    found = mutations.read_or_refused(lambda: form.parse(text, name), MissionFileError, name)
    if found is not None:
        again = form.parse(form.write(found), name)
        assert repr(again.mission.items) == repr(found.mission.items)  # a NaN is not itself
        assert (again.circles, again.polygons, again.rally) == (found.circles, found.polygons, found.rally)


@given(json_values, json_values, json_values)
@settings(max_examples=150)
def test_no_document_breaks_it(one: object, two: object, three: object) -> None:
    """Any JSON is a mission or a MissionFileError."""
    for document in (
        {"fileType": "Plan", "version": 1, "mission": one},
        {"fileType": "Plan", "version": 1, "mission": {"version": 2, "items": [one, two]}},
        json.loads(text(entry(params=one))),
        json.loads(text(entry(command=one, frame=two))),
        json.loads(text({"type": "ComplexItem", "complexItemType": "survey", "TransectStyleComplexItem": one})),
        json.loads(text(geoFence=one, rallyPoints=two)),
        json.loads(text(geoFence={"circles": [one], "polygons": [two]}, rallyPoints={"points": [three]})),
    ):
        same_when_saved(plan, json.dumps(document), "m.plan")


ROW0 = "0\t1\t0\t16\t0\t0\t0\t0\t-35.0\t149.0\t584.0\t1\n"


def test_ground_station_text() -> None:
    """A file as ground stations write it: tabs, carriage returns, item 0 current."""
    text = "QGC WPL 110\r\n0\t1\t0\t16\t0\t0\t0\t0\t-35.3632621\t149.1652371\t584.0\t1\r\n"
    text += "1\t0\t3\t22\t0.0\t0\t0\t0\t0\t0\t10\t1\r\n\r\n"
    file = wpl.parse(text)
    assert len(file.mission) == 2
    assert file.mission.items[0].x == -353632621
    assert file.mission.items[1].command == MavCmd.NAV_TAKEOFF
    assert file.home == pytest.approx((-35.3632621, 149.1652371, 584.0))
    assert file.kind == "copter"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", r"m:1: expected 'QGC WPL 110', found ''"),
        ("QGC WPL 120\n", r"m:1: 'QGC WPL 120' is not read, .* are: open it in .* and save it as"),
        ("QGC WPL 110\n1 2 3\n", r"m:2: 3 columns, expected 12 \(index current"),
        ("QGC WPL 110\n" + ROW0.replace("149.0", "east"), r"m:2: y: 'east' is not a number"),
        ("QGC WPL 110\n" + ROW0.replace("\t16\t", "\t16.5\t"), r"m:2: command: '16.5' is not a whole number"),
        ("QGC WPL 110\n" + ROW0.replace("-35.0", "-95.0"), r"m:2: latitude -95.0 is not within -90 .. 90"),
        ("QGC WPL 110\n" + ROW0.replace("149.0", "181"), r"m:2: longitude 181.0 is not within -180 .. 180"),
        ("QGC WPL 110\n" + ROW0.replace("584.0", "nan"), r"m:2: altitude nan is not a number of metres"),
        ("QGC WPL 110\n" + ROW0.replace("-35.0", "nan"), r"m:2: location nan, 149.0 is not a pair"),
        ("QGC WPL 110\n" + ROW0.replace("-35.0", "1e400"), r"m:2: location inf"),
        ("QGC WPL 110\n" + ROW0.replace("\t16\t0\t", "\t16\tinf\t"), r"m:2: parameter 1 is inf: a finite number"),
        ("QGC WPL 110\n" + ROW0.replace("\t16\t", "\t9\t"), r"m:2: command 9 is not known here; known are 16 WP, "),
        ("QGC WPL 110\n" + ROW0.replace("\t0\t16\t", "\t7\t16\t"), r"m:2: frame 7 is not known.*3 relative"),
        ("QGC WPL 110\n" + ROW0 + "1 0 3 177 7 2 0 0 0 0 0 1\n", r"m:3: p1: DO_JUMP to 7; there are items 1 to 1"),
    ],
)
def test_text_refused(text: str, message: str) -> None:
    """Each mistake is told with file, line, value and what is allowed."""
    with pytest.raises(MissionFileError, match=message):
        wpl.parse(text, "m")


def test_files_that_are_none(tmp_path: Path) -> None:
    """Missing, binary, of another suffix."""
    with pytest.raises(MissionFileError, match=r"nothing\.plan: No such file"):
        load(tmp_path / "nothing.plan")
    (tmp_path / "picture.txt").write_bytes(b"QGC \xff\xfe")
    with pytest.raises(MissionFileError, match=r"picture\.txt: byte 4 is no text"):
        load(tmp_path / "picture.txt")
    with pytest.raises(MissionFileError, match=r"suffix '\.kml' is not one of \.plan, \.waypoints, \.txt"):
        save(wpl.parse("QGC WPL 110\n" + ROW0), tmp_path / "m.kml")


def test_a_mark_at_the_begin_is_passed_over(tmp_path: Path) -> None:
    """Editors of some systems put a byte order mark there."""
    (tmp_path / "m.waypoints").write_bytes(b"\xef\xbb\xbfQGC WPL 110\n" + ROW0.encode())
    assert len(load(tmp_path / "m.waypoints").mission) == 1


def test_too_many_items_are_refused() -> None:
    rows = "".join(f"{k}\t0\t3\t20\t0\t0\t0\t0\t0\t0\t0\t1\n" for k in range(725))
    with pytest.raises(MissionFileError, match="too many items"):
        wpl.parse("QGC WPL 110\n" + rows, "m")


@given(st.text(alphabet="QGC WPL110\n\t-.0123456789naif", max_size=200))
def test_no_text_breaks_it(text: str) -> None:
    """Any text is a mission or a MissionFileError."""
    for head in ("", "QGC WPL 110\n"):
        same_when_saved(wpl, head + text, "m.waypoints")


@pytest.mark.parametrize(
    ("given", "cruise", "hover"),
    [
        ({}, 10.0, 5.0),
        ({"cruise_speed": 3.0}, 3.0, 5.0),
        ({"hover_speed": 7.0}, 10.0, 7.0),
        ({"hover_speed": 0.5}, 10.0, 0.5),
    ],
)
def test_a_plan_says_both_speeds(given: dict[str, float], cruise: float, hover: float) -> None:
    mission = Mission((home_item(0, 0, 0.0), MissionItem(MavCmd.NAV_TAKEOFF, 3, z=5.0)))
    written = json.loads(writer.write(MissionFile(mission, **given)))["mission"]  # type: ignore[arg-type]
    assert (written["cruiseSpeed"], written["hoverSpeed"]) == (cruise, hover)
