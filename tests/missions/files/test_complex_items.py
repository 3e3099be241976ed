# SPDX-License-Identifier: BSD-3-Clause
"""Surveys, corridors, structures and splines become the waypoints that they stand for."""

from __future__ import annotations

import json
import math
from typing import Any

import pytest

from sitl.core.mavlink import MavCmd
from sitl.missions.files import MissionFileError, plan, straightened
from sitl.missions.files import plan as writer
from sitl.missions.files.complex_items import FROM_END, FROM_RIGHT, across_polygon, count_of, there_and_back
from sitl.missions.files.plane import Plane, area, shifted
from sitl.missions.library.draft import LAT, LON, Draft, degrees, survey, transects

PLANE = Plane((LAT, LON))
FIELD = [(0.0, 0.0), (30.0, 0.0), (30.0, 20.0), (0.0, 20.0)]


def text(*entries: dict[str, Any]) -> str:
    """A plan of complex items."""
    items = [{"type": "ComplexItem", **entry} for entry in entries]
    mission = {"version": 2, "items": items, "plannedHomePosition": [LAT, LON, 584.0]}
    return json.dumps({"fileType": "Plan", "version": 1, "mission": mission})


def flown(*entries: dict[str, Any]) -> list[tuple[float, float, float]]:
    """North, east, height [m] of the waypoints."""
    items = plan.parse(text(*entries)).mission.items[1:]
    return [(*PLANE.point((item.x * 1e-7, item.y * 1e-7)), item.z) for item in items]


def test_a_survey_without_items_covers_the_field() -> None:
    """Four lines 5 m apart, 2.5 m from the edges, 2 m beyond them, one there and the next back."""
    path = flown(survey(FIELD, 0.0, transects(5.0, 12.0, 2.0), 2))
    want = [(-2, 2.5), (32, 2.5), (32, 7.5), (-2, 7.5), (-2, 12.5), (32, 12.5), (32, 17.5), (-2, 17.5)]
    assert [p[:2] for p in path] == [pytest.approx(p, abs=0.02) for p in want]
    assert {p[2] for p in path} == {12.0}


@pytest.mark.parametrize(("entry", "corner"), [(0, (30, 2.5)), (1, (30, 17.5)), (2, (0, 2.5)), (3, (0, 17.5))])
def test_entries(entry: int, corner: tuple[float, float]) -> None:
    assert flown(survey(FIELD, 0.0, transects(5.0, 12.0), entry))[0][:2] == pytest.approx(corner, abs=0.02)


def test_lines_follow_the_angle() -> None:
    """At 90 degrees they run east."""
    path = flown(survey(FIELD, 90.0, transects(10.0, 12.0), 2))
    assert len(path) == 6
    assert [p[0] for p in path] == pytest.approx([25, 25, 15, 15, 5, 5], abs=0.02)


def test_refly_and_alternate() -> None:
    """Once more across; every other line first."""
    again = {**transects(10.0, 12.0), "Refly90Degrees": True}
    assert len(flown(survey(FIELD, 0.0, again, 2))) == 4 + 6
    skipped = {**survey(FIELD, 90.0, transects(10.0, 12.0), 2), "flyAlternateTransects": True}
    assert [p[0] for p in flown(skipped)] == pytest.approx([25, 25, 5, 5, 15, 15], abs=0.02)


def test_stored_items_are_flown_as_they_are() -> None:
    """And jumps count them."""
    stored = {"type": "SimpleItem", "command": 16, "frame": 3, "doJumpId": 1, "autoContinue": True}
    style = {
        **transects(5.0, 12.0),
        "Items": [{**stored, "params": [0, 0, 0, None, *degrees(k, 1), 9]} for k in (1, 2)],
    }
    path = flown(survey(FIELD, 0.0, style))
    assert path == [pytest.approx((k, 1, 9), abs=0.02) for k in (1, 2)]


def test_a_survey_stays_one_when_written() -> None:
    """With its items stored; written again it is the same file."""
    first = plan.parse(text(survey(FIELD, 10.0, transects(5.0, 12.0, 2.0))))
    once = writer.write(first)
    found = plan.parse(once)
    assert [c.kind for c in found.complexes] == ["survey"]
    assert found.complexes[0].stored
    read, made = ([tuple(map(float, item)) for item in one.mission.items] for one in (found, first))
    assert repr(read) == repr(made)  # a NaN is not itself
    assert writer.write(found) == once
    assert '"ComplexItem"' not in writer.write(found.simple())


def test_a_corridor() -> None:
    """Two lines 4 m apart beside a line that turns right by 90 degrees: the corner is mitred."""
    entry = {
        "complexItemType": "CorridorScan",
        "CorridorWidth": 8.0,
        "EntryPoint": 0,
        "TransectStyleComplexItem": transects(4.0, 7.0, 1.0),
        "polyline": [list(degrees(*p)) for p in ((0, 0), (20, 0), (20, 20))],
        "version": 2,
    }
    want = [(-1, -2), (22, -2), (22, 21), (18, 21), (18, 2), (-1, 2)]
    assert [p[:2] for p in flown(entry)] == [pytest.approx(p, abs=0.02) for p in want]


@pytest.mark.parametrize("corners", [FIELD, FIELD[::-1]])
def test_a_structure(corners: list[tuple[float, float]]) -> None:
    """Five metres outside, whichever way its corners go; two layers, from above."""
    entry = {
        "complexItemType": "StructureScan",
        "CameraCalc": {"AdjustedFootprintFrontal": 4.0, "DistanceToSurface": 5.0},
        "EntranceAltitude": 20.0,
        "Layers": 2,
        "ScanBottomAlt": 2.0,
        "StartFromTop": True,
        "StructureHeight": 10.0,
        "polygon": [list(degrees(*p)) for p in corners],
        "version": 3,
    }
    path = flown(entry)
    assert len(path) == 1 + 5 + 5 + 1
    assert [p[2] for p in path] == [20.0, *[8.0] * 5, *[4.0] * 5, 20.0]
    assert {(round(p[0]), round(p[1])) for p in path} == {(-5, -5), (35, -5), (35, 25), (-5, 25)}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"complexItemType": "fwLandingPattern"},
            r"'fwLandingPattern' is a landing of fixed-wing aircraft; copters and",
        ),
        ({"complexItemType": "vtolLandingPattern"}, r"'vtolLandingPattern' is a landing of VTOL aircraft"),
        ({"complexItemType": "spiral"}, r"items\[0\].complexItemType: 'spiral' is not one of survey, CorridorScan"),
        ({"polygon": [[1, 2], [3, 4]]}, r"polygon: 2 corners; a polygon has three or more"),
        ({"polygon": [[1, 2], [1.0001, 2], [1.0002, 2]]}, r"polygon: no line crosses it"),
        ({"angle": "north"}, r"items\[0\].angle: 'north' is not a number"),
        ({"entryLocation": 7}, r"items\[0\].entryLocation: 7 is not 0 or 1 or 2 or 3"),
        ({"TransectStyleComplexItem": {}}, r"TransectStyleComplexItem: no 'CameraCalc'"),
        (
            {"TransectStyleComplexItem": transects(0.0, 12.0)},
            r"AdjustedFootprintSide: 0.0 is not within 0.01 .. 100000",
        ),
        ({"TransectStyleComplexItem": transects(0.01, 12.0)}, r"lines or corners; a mission holds 724 items"),
    ],
)
def test_refused(change: dict[str, Any], message: str) -> None:
    """The member, the value, and what is allowed."""
    with pytest.raises(MissionFileError, match=message):
        plan.parse(text({**survey(FIELD, 0.0, transects(5.0, 12.0)), **change}), "m")


def test_lines_of_any_polygon_end_on_its_edges() -> None:
    """Whatever the heading, no line is longer than the polygon, and they cover its area."""
    corners = [(0.0, 0.0), (25.0, 6.0), (31.0, 22.0), (8.0, 30.0)]
    for turn in range(0, 360, 15):
        lines = across_polygon(corners, 0.5, math.radians(turn))
        covered = sum(math.dist(*line) for line in lines) * 0.5
        assert covered == pytest.approx(abs(area(corners)), rel=0.03)


def test_there_and_back_by_bits() -> None:
    lines = [[(0.0, 0.0), (1.0, 0.0)], [(0.0, 1.0), (1.0, 1.0)]]
    assert there_and_back(lines, 0, 0.0) == [(0, 0), (1, 0), (1, 1), (0, 1)]
    assert there_and_back(lines, FROM_RIGHT, 0.0) == [(0, 1), (1, 1), (1, 0), (0, 0)]
    assert there_and_back(lines, FROM_END, 0.0) == [(1, 0), (0, 0), (0, 1), (1, 1)]
    assert [count_of(w, 4.0) for w in (0.0, 4.0, 4.1, 8.0)] == [1, 1, 2, 2]


def test_sharp_corners_do_not_run_away() -> None:
    """A mitre of a spike is cut at three times the distance."""
    corner = shifted([(0.0, 0.0), (10.0, 0.0), (0.0, 0.1)], 1.0)[1]
    assert math.dist(corner, (10.0, 0.0)) <= 3.0 + 1e-9


def places(draft: Draft) -> list[tuple[float, float]]:
    """Of the straightened mission [m]."""
    items = straightened(draft.file()).mission.items
    assert all(item.command != MavCmd.NAV_SPLINE_WAYPOINT for item in items)
    return [
        PLANE.point((i.x * 1e-7, i.y * 1e-7)) for i in items if i.command == MavCmd.NAV_WAYPOINT and not i.no_location
    ][1:]


def test_a_circle_of_splines_is_round() -> None:
    """Eight places on a circle of 20 m: the curve through them stays within a third of a metre of it."""
    corners = [(20 * math.cos(k * math.pi / 4), 20 * math.sin(k * math.pi / 4)) for k in range(9)]
    path = places(Draft("copter", "").take_off(5).curve(*corners, z=5.0))
    inner = [p for p in path if math.dist(p, corners[0]) > 16.0]  # away from its ends, which are straight
    assert len(inner) > 20
    assert [math.hypot(*p) for p in inner] == pytest.approx([20.0] * len(inner), abs=0.35)


def test_it_leaves_along_the_straight_leg_that_came_before() -> None:
    path = places(Draft("copter", "").take_off(5).to((0, 0), (20, 0), z=5.0).curve((30, 30), z=5.0))
    out = path[2]
    assert abs(out[1]) < 0.35 * (out[0] - 20.0)


def test_it_arrives_along_the_straight_leg_that_follows() -> None:
    path = places(Draft("copter", "").take_off(5).to((0, 0), z=5.0).curve((20, 0), z=5.0).to((20, 30), z=5.0))
    north, east = 20.0 - path[-3][0], 0.0 - path[-3][1]
    assert 0.0 < north < 0.7 * east


def test_heights_and_jumps_follow() -> None:
    draft = Draft("copter", "").take_off(5).to((0, 0), z=5.0).curve((20, 0), z=15.0).to((20, 30), z=15.0).jump(4, 1)
    items = straightened(draft.file()).mission.items
    assert items[int(items[-1].p1)].y == draft.file().mission.items[4].y
    assert [i.z for i in items[2:-1]] == sorted(i.z for i in items[2:-1])


def test_without_splines_it_is_the_same_file() -> None:
    file = Draft("copter", "").take_off(5).file()
    assert straightened(file) is file


def test_a_spline_needs_a_place() -> None:
    with pytest.raises(MissionFileError, match="item 2: a spline waypoint needs a latitude"):
        straightened(Draft("copter", "").take_off(5).add(MavCmd.NAV_SPLINE_WAYPOINT, z=3.0).file())
