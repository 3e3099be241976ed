# SPDX-License-Identifier: BSD-3-Clause
"""``sitl mission fly``, ``convert`` and ``library`` as a user types them; subcommands that other packages add."""

from __future__ import annotations

import argparse
import re
from dataclasses import replace
from importlib import metadata
from pathlib import Path

import pytest

from sitl import cli
from sitl.missions import cli as missions_cli
from sitl.missions.files import load, save
from sitl.missions.library.draft import Draft


class Entry:
    """An entry point."""

    def __init__(self, name: str, found: object) -> None:
        self.name, self.value, self._found = name, f"{name}.module", found

    def load(self) -> object:
        if isinstance(self._found, Exception):
            raise self._found
        return self._found


@pytest.fixture(autouse=True)
def added(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """``mission`` is there whether or not the package is installed."""
    found = [Entry("zebra", ImportError("no stripes")), Entry("mission", missions_cli), Entry("run", missions_cli)]
    ours = {"group": cli.GROUP}
    real = metadata.entry_points
    monkeypatch.setattr(metadata, "entry_points", lambda **wanted: found if wanted == ours else real(**wanted))
    monkeypatch.chdir(tmp_path)


def test_a_package_that_cannot_be_loaded_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    """And the others work; one that has the name of ours is passed over."""
    with pytest.raises(SystemExit):
        cli.main(["--help"])
    out, err = capsys.readouterr()
    assert "zebra (zebra.module) cannot be loaded: ImportError('no stripes')" in err
    assert "mission" in out
    assert isinstance(cli.parser(), argparse.ArgumentParser)


def test_fly_a_file(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    save(Draft("copter", "").take_off(4).to((6, 0), z=4.0).land().file(), "hop.plan")
    assert cli.main(["mission", "fly", "hop.plan"]) == 0
    out = capsys.readouterr().out
    assert "item 2 of 3 WP done" in out
    assert "mission completed\n  time " in out
    assert out.endswith("log: logs/hop.tlog\nlog: logs/hop.bin\n")
    assert Path("logs/hop.bin").stat().st_size > 10_000
    assert (tmp_path / "logs" / "hop.tlog").stat().st_size > 1000


LONG_WAIT = """QGC WPL 110
0	1	0	16	0	0	0	0	-35.3632610	149.1652300	584.0	1
1	0	3	22	0	0	0	0	0	0	15	1
2	0	3	19	1200	0	0	0	0	0	15	1
3	0	3	21	0	0	0	0	0	0	0	1
"""


@pytest.mark.slow
def test_a_wait_of_twenty_minutes_is_flown(capsys: pytest.CaptureFixture[str]) -> None:
    Path("long_wait.txt").write_text(LONG_WAIT)
    Path("no_battery.parm").write_text("BATT_MONITOR 0\n")
    assert cli.main(["mission", "fly", "long_wait.txt", "--params", "no_battery.parm", "--quiet"]) == 0
    assert "mission completed" in capsys.readouterr().out


def test_a_mission_with_a_fault(capsys: pytest.CaptureFixture[str]) -> None:
    save(Draft("copter", "").take_off(4).to((6, 0), z=4.0).land().file(), "hop.plan")
    assert (
        cli.main(["mission", "fly", "hop.plan", "--time-limit", "60", "--fail", "motor:1@1", "--fail", "wind=3"]) == 1
    )
    assert "mission NOT COMPLETED" in capsys.readouterr().out
    assert cli.main(["mission", "fly", "hop.plan", "--fail", "motor:9@1"]) == 2
    assert "fault motor: there is no number 9; it has 1 to 8" in capsys.readouterr().err


def test_a_mission_that_is_not_completed_is_code_1(capsys: pytest.CaptureFixture[str]) -> None:
    save(Draft("copter", "").to((6, 0), z=4.0).file(), "flat.waypoints")
    assert cli.main(["mission", "fly", "flat.waypoints", "--quiet"]) == 1
    assert "mission NOT COMPLETED: mode AUTO was refused" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["nothing.plan"], "sitl mission: nothing.plan: No such file"),
        (["copter/nothing"], "(sitl mission library lists all)"),
        (["rover/square", "--vehicle", "copter"], "vehicleType 10 is a rover, not a copter"),
        (["wing.plan"], "wing.plan: vehicleType 1 (MAV_TYPE) is none of copter, rover; --vehicle says"),
        (["lawn.plan"], "mission item 1: a rover does not fly command 22 Takeoff; it flies"),
        (["rover/square", "--speedup", "fast"], "speed-up 'fast' is not a number"),
    ],
)
def test_bad_input_is_code_2(words: list[str], message: str, capsys: pytest.CaptureFixture[str]) -> None:
    lawn = Draft("rover", "").take_off(4).to((6, 0)).file()
    save(lawn, "lawn.plan")
    save(replace(lawn, vehicle_type=1), "wing.plan")
    assert cli.main(["mission", "fly", *words]) == 2
    assert message in capsys.readouterr().err


def test_convert(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["mission", "library", "copter/survey", "copter/fence_and_rally", "--copy", "."]) == 0
    assert cli.main(["mission", "convert", "copter/survey.plan", "survey.waypoints"]) == 0
    plan, text = load("copter/survey.plan"), load("survey.waypoints")
    assert [i[:2] for i in text.mission.items] == [i[:2] for i in plan.mission.items]
    assert cli.main(["mission", "convert", "survey.waypoints", "survey.plan", "--vehicle", "copter"]) == 0
    assert load("survey.plan").kind == "copter"
    assert cli.main(["mission", "convert", "copter/fence_and_rally.plan", "square.txt"]) == 0
    assert "geofence and rally points are left out" in capsys.readouterr().err
    assert cli.main(["mission", "convert", "copter/survey.plan", "survey.plan"]) == 2
    assert "is there already; --force replaces it" in capsys.readouterr().err
    assert cli.main(["mission", "convert", "copter/survey.plan", "survey.plan", "--expand", "--force"]) == 0
    assert not load("survey.plan").complexes


AREA = "-35.3631 149.1651\n-35.3631 149.1654\n-35.3634 149.1654\n"
KML = """<kml><Placemark><LineString><coordinates>149.16523,-35.363261 149.16523,-35.36322</coordinates>
</LineString></Placemark></kml>"""


def test_a_path_is_flown_at_an_altitude(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """With a take-off and a return, inside a fence of another file; without a height it is asked for."""
    (tmp_path / "path.kml").write_text(KML)
    (tmp_path / "area.poly").write_text(AREA)
    assert cli.main(["mission", "fly", "path.kml"]) == 2
    assert "its height is missing (--altitude METRES" in capsys.readouterr().err
    words = ["mission", "fly", "path.kml", "--altitude", "4", "--fence", "area.poly"]
    assert cli.main(words) == 0
    out = capsys.readouterr().out
    assert "path.kml: 4 items" in out
    assert "geofence of 1 areas" in out
    assert cli.main(["mission", "convert", "path.kml", "path.plan", "--altitude", "4", "--vehicle", "rover"]) == 0
    assert [item.command for item in load("path.plan").mission.items[1:]] == [16, 16]
    assert cli.main(["mission", "convert", "area.poly", "area.waypoints"]) == 0
    assert "area.waypoints: no mission; geofence of 1 areas, 0 rally points" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["fly", "area.poly"], r"area.poly: no mission, but a geofence.* \(sitl mission fly MISSION --fence area.poly"),
        (["fly", "copter/square", "--rally", "area.poly"], "--rally area.poly: there is none in it"),
        (["fly", "copter/square", "--altitude", "3"], "altitude 3 is for the path of a KML"),
        (["convert", "area.poly", "b.kml"], "suffix '.kml' is not one of .plan, .waypoints, .txt"),
    ],
)
def test_what_is_read_beside_a_mission(words: list[str], message: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path("area.poly").write_text(AREA)
    assert cli.main(["mission", *words]) == 2
    assert re.search(message, capsys.readouterr().err)


def test_the_library_is_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["mission", "library"]) == 0
    out = capsys.readouterr().out
    assert "rover/maze_route" in out
    assert "world maze_erlerover" in out
