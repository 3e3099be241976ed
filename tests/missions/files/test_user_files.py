# SPDX-License-Identifier: BSD-3-Clause
"""Files as users have them: numbered otherwise, old, of fences and rally points; read as by pymavlink."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from pymavlink import mavwp

from sitl.autopilot.mission import item as c
from sitl.core.mavlink import MavCmd, MavFrame
from sitl.missions.files import FencePolygon, MissionFileError, RallyPoint, load, save, wpl
from sitl.missions.files.document import numbers

HEAD = "QGC WPL 110\n"
HOME = "0\t1\t0\t16\t0\t0\t0\t0\t-35.3632610\t149.1652300\t584.0\t1\n"
TAKE_OFF = "1\t0\t3\t22\t0\t0\t0\t0\t0\t0\t15\t1\n"
POINT = "{}\t0\t3\t16\t0\t0\t0\t0\t-35.3630000\t149.1652300\t15\t1\n"
RETURN = "{}\t0\t3\t20\t0\t0\t0\t0\t0\t0\t0\t1\n"
SQUARE = ((-35.3631, 149.1651), (-35.3631, 149.1654), (-35.3634, 149.1654), (-35.3634, 149.1651))

READ = {
    "gap": HEAD + HOME + TAKE_OFF + POINT.format(5) + RETURN.format(9),
    "twice": HEAD + HOME + TAKE_OFF + POINT.format(1) + RETURN.format(1),
    "from_one": HEAD + TAKE_OFF + POINT.format(2) + RETURN.format(3),
    "backwards": HEAD + HOME + POINT.format(3) + POINT.format(2),
    "cmd0home": HEAD + HOME.replace("\t16\t", "\t0\t") + TAKE_OFF + POINT.format(2) + RETURN.format(3),
    "comments": HEAD + "# home\n" + HOME + "\n#\n" + TAKE_OFF,
    "return_with_a_place": HEAD + HOME + "1 0 3 20 0 0 0 0 -35.359586 149.164639 0 1\n",
    "v100": "QGC WPL 100\n0 0 25 3 4 2 1 1 149.165230 -35.363261 584 0 1\n1 3 24 0 0 0 5 0 149.16 -35.36 15 0 1\n",
}


def saved(tmp_path: Path, name: str, text: str) -> Path:
    """A file of a text."""
    (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path / name


def theirs(path: Path) -> list[tuple[Any, ...]]:
    """What pymavlink reads: command, frame, the seven parameters, autocontinue."""
    loader = mavwp.MAVWPLoader()
    loader.load(str(path))
    rows = []
    for k in range(loader.count()):
        w = loader.wp(k)
        values = (w.param1, w.param2, w.param3, w.param4, w.x, w.y, w.z)
        rows.append((w.seq, w.command, w.frame, values, w.autocontinue))
    return rows


@pytest.mark.parametrize("name", READ)
def test_as_pymavlink_reads_it(name: str, tmp_path: Path) -> None:
    """Items in the order of the lines, whatever their numbers; command 0 as the first is home."""
    path = saved(tmp_path, f"{name}.txt", READ[name])
    ours = [(k, i.command, i.frame, numbers(i), i.autocontinue) for k, i in enumerate(load(path).mission.items)]
    assert ours == theirs(path)


def test_without_item_0_it_is_said_what_counts_as_home(tmp_path: Path) -> None:
    assert (
        "numbered from 1 on: the first one counts as home" in load(saved(tmp_path, "m.txt", READ["from_one"])).notes[0]
    )
    assert load(saved(tmp_path, "m.txt", READ["gap"])).notes == ()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            HEAD + HOME + TAKE_OFF + POINT.format(2) + "3 0 3 177 0 1 0 0 0 0 0 1\n",
            r"m\.txt:5: DO_JUMP to item 0 cannot be flown: item 0 is home \(command 177 Jump\)",
        ),
        (
            HEAD + HOME + "1 0 3 177 -2 1 0 0 0 0 0 1\n",
            r"m\.txt:3: DO_JUMP to item -2 cannot be flown: items are numbered",
        ),
        (HEAD + HOME + TAKE_OFF.replace("\t22\t", "\t0\t"), r"m\.txt:3: command 0 is not known"),
        (HEAD + HOME + "1 0 3 20 0 0 0 0 300 0 0 1\n", r"m\.txt:3: parameter 5 is 300.0: it is within \+-214\.7"),
        (HEAD + HOME + "1 0 3 203 0 0 0 0 0.5 0 0 1\n", r"m\.txt:3: parameter 5 is 0.5: a whole number is needed"),
        (" \n", r"m\.txt: there is nothing in it; QGC WPL text"),
        ("QGC WPL 120\n" + HOME, r"m\.txt:1: 'QGC WPL 120' is not read, .*save it as 'QGC WPL 110' or \.plan"),
        ("QGC WPL PB 110\n", r"m\.txt:1: 'QGC WPL PB 110' is not read"),
        ("QGC WPL 100\n0 0 16 0 0 0 0 1 -35.36 149.16 584 0 1\n", r"m\.txt:2: action 16 .*QGC WPL 100.*save it as"),
        ('{"mission": []}', r"m\.txt: fileType is None: .*A mission is a \.plan \(Save in QGroundControl's"),
        ("<gpx></gpx>", r"m\.txt:1: the document is 'gpx', not 'kml'"),
        (HEAD + HOME + TAKE_OFF + "2 0 3 5100 0 0 0 0 1 2 3 1\n", r"m\.txt:4: command 5100 is of a fence or of rally"),
    ],
)
def test_refused_with_what_to_do(text: str, message: str, tmp_path: Path) -> None:
    """Line and value; what to do where the format is another one."""
    with pytest.raises(MissionFileError, match=message):
        load(saved(tmp_path, "m.txt", text))


CORNERS = "".join(f"{lat} {lon}\n" for lat, lon in SQUARE)
FENCE = f"-35.36325 149.16525\n{CORNERS}{SQUARE[0][0]} {SQUARE[0][1]}\n"
RALLY = "RALLY -35.363\t149.165\t20.0\t40.0\t90.0\t0\n"


def test_a_fence_file(tmp_path: Path) -> None:
    """Where to return to, the corners, the first of them once more; as pymavlink, whose places are cut, not rounded."""
    path = saved(tmp_path, "area.fen", FENCE)
    found = load(path)
    assert found.polygons == (FencePolygon(SQUARE, frame=MavFrame.GLOBAL),)
    assert found.breach_return == (-35.36325, 149.16525, 0.0)
    assert not found.mission.items
    loader = mavwp.MAVFenceLoader()
    assert loader.load(str(path)) == 6


@pytest.mark.parametrize("end", ["", f"{SQUARE[0][0]}\t{SQUARE[0][1]}\n"])
def test_a_polygon_file(end: str, tmp_path: Path) -> None:
    """Closed or not, it is the same area to stay in."""
    path = saved(tmp_path, "area.poly", "#saved by Mission Planner 1.3\n" + CORNERS + end)
    assert load(path).polygons == (FencePolygon(SQUARE),)


def test_rally_lines(tmp_path: Path) -> None:
    """Heights are above home; what is for planes is left out, and that is said."""
    found = load(saved(tmp_path, "points.txt", "# mine\n" + RALLY))
    assert found.rally == (RallyPoint((-35.363, 149.165), 20.0),)
    assert "for planes" in found.notes[0]


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.fen", CORNERS + CORNERS[: CORNERS.index("\n")], r"a\.fen:5: the last location is that of line 1.*\.poly"),
        ("a.fen", "1 2\n" + CORNERS, r"a\.fen:5: the last location is that of no other"),
        ("a.fen", "1 2\n3 4\n", r"a\.fen: 2 lines; a fence has"),
        ("a.fen", "1 2\n3\n", r"a\.fen:2: '3' is not a latitude and a longitude"),
        ("a.poly", "1 2\n3 4\n1 2\n", r"a\.poly: 2 corners; a polygon has 3 or more"),
        ("a.poly", "1 2\n91 4\n1 2\n", r"a\.poly:2: latitude 91\.0 is not within"),
        ("a.poly", "1 2\n9 nan\n1 2\n", r"a\.poly:2: 'nan' is not a number"),
        ("a.fen", "area\n", r"a\.fen: 'area' is not a latitude"),
        ("r.txt", "RALLY 1 2 3\n", r"r\.txt:1: 'RALLY 1 2 3' is not RALLY and six numbers"),
        (
            "f.txt",
            HEAD + HOME + "1 0 3 5001 4 0 0 0 1 2 0 1\n",
            r"f\.txt:3: a polygon of 4 corners begins here, and 1 follow",
        ),
    ],
)
def test_lists_refused(name: str, text: str, message: str, tmp_path: Path) -> None:
    """The line, what stands there, what is allowed."""
    with pytest.raises(MissionFileError, match=message):
        load(saved(tmp_path, name, text))


def test_fences_and_rally_points_as_items(tmp_path: Path) -> None:
    """MAVProxy saves them as "QGC WPL 110", Mission Planner with home before them; each is read, and written again."""
    fence = "".join(f"{k} 0 3 5001 4 0 0 0 {lat} {lon} 0 1\n" for k, (lat, lon) in enumerate(SQUARE))
    fence += "4 0 3 5004 30 0 0 0 -35 149 0 1\n5 0 3 5000 0 0 0 0 -35 149 20 1\n"
    found = load(saved(tmp_path, "fence.txt", HEAD + HOME + fence))
    assert found.polygons == (FencePolygon(SQUARE),)
    assert [(a.radius, a.inclusion) for a in found.circles] == [(30.0, False)]
    assert found.breach_return == (-35.0, 149.0, 20.0)
    save(found, tmp_path / "again.waypoints")
    assert load(tmp_path / "again.waypoints").fence_items == found.fence_items
    points = load(saved(tmp_path, "rally.txt", HEAD + "0 0 10 5100 0 0 0 0 -35.1 149 25 1\n"))
    assert points.rally == (RallyPoint((-35.1, 149.0), 25.0, 10),)
    assert points.rally_items[0].frame == 10
    with pytest.raises(MissionFileError, match="rally point of frame 10"):
        save(points, tmp_path / "points.plan")


@pytest.mark.parametrize("suffix", [".plan", ".waypoints"])
@pytest.mark.parametrize(
    "command", sorted(set(c.COMMANDS) - {MavCmd.DO_JUMP, *c.FENCE_COMMANDS, MavCmd.NAV_RALLY_POINT})
)
def test_no_field_loses_a_digit(command: int, suffix: str, tmp_path: Path) -> None:
    """Places too where the command has none: that of RTL was cut to whole degrees."""
    place = "7\t-8" if command in c.NUMBER_COMMANDS else "-35.3595861\t149.1646391"
    row = f"1\t0\t3\t{command}\t0.123456789\t1e-9\t1234567.25\t-0.1\t{place}\t0.000001234\t1\n"
    file = load(saved(tmp_path, "m.txt", HEAD + HOME + row))
    save(file, tmp_path / f"again{suffix}")
    words = row.split()
    found = numbers(load(tmp_path / f"again{suffix}").mission.items[1])
    assert found == tuple(map(float, words[4:11]))
    if suffix == ".waypoints":
        loader = mavwp.MAVWPLoader()
        loader.load(str(tmp_path / "again.waypoints"))
        assert (loader.wp(1).x, loader.wp(1).y) == found[4:6]


def test_a_wrong_name_does_not_matter(tmp_path: Path) -> None:
    """What a file is says its content."""
    save(wpl.parse(READ["gap"]), tmp_path / "m.plan")
    (tmp_path / "m.plan").rename(tmp_path / "m.txt")
    saved(tmp_path, "n.plan", READ["gap"])
    assert load(tmp_path / "m.txt").mission.items[1:] == load(tmp_path / "n.plan").mission.items[1:]
