# SPDX-License-Identifier: BSD-3-Clause
"""``--params FILE`` of every command: the same reader, and what the user is told."""

from __future__ import annotations

from pathlib import Path

import pytest

from sitl.cli import foreign, options, parser
from sitl.foreign import ardupilot
from sitl.foreign.choice import ARDUPILOT, PX4, Choice

FILES = Path(__file__).parents[1] / "autopilot" / "params" / "files"
COMMANDS = (
    ("run", "copter"),
    ("exec", "--vehicle", "copter"),
    ("mission", "fly", "copter/square", "--vehicle", "copter"),
)


@pytest.fixture(params=COMMANDS, ids=lambda words: words[0])
def command(request: pytest.FixtureRequest) -> tuple[str, ...]:
    return request.param


def parsed(command: tuple[str, ...], *paths: Path, more: tuple[str, ...] = ()):
    words = [word for path in paths for word in ("--params", str(path))]
    tail = ("--", "true") if command[0] == "exec" else ()
    return parser().parse_args([*command, *words, *more, *tail])


def test_files_of_ground_stations_are_applied_without_a_word(command: tuple[str, ...], capsys) -> None:
    simulation = options.build_simulation(parsed(command, FILES / "mp.param", FILES / "qgc.params"))
    assert simulation.parameters["FENCE_ALT_MAX"] == 77.0 and simulation.parameters["FENCE_RADIUS"] == 700.0
    assert capsys.readouterr().err == ""


def test_a_real_vehicles_file_is_taken_and_the_user_is_told_once(tmp_path: Path, capsys, recwarn) -> None:
    mine = tmp_path / "mine.param"
    mine.write_text(
        "@include none.param\nACRO_Y_RATE,600\nRPM1_TYPE,10\nSYSID_THISMAV,4\nFRSKY_OPTIONS,1\nRTL_ALT,2000\n"
    )
    simulation = options.build_simulation(parsed(COMMANDS[0], mine), {"RTL_ALT": 1000.0, "LAND_SPEED": 40.0})
    wanted = {"ACRO_Y_RATE": 600.0, "RPM1_TYPE": 10.0, "RTL_ALT": 2000.0, "LAND_SPEED": 40.0}
    assert {name: simulation.parameters[name] for name in wanted} == wanted
    assert capsys.readouterr().err.splitlines() == [
        f"sitl: {mine}, line 1: @include 'none.param' is not there; it is passed over",
        "sitl: 1 parameter of the files is not in this firmware: SYSID_THISMAV; not set, but "
        "the same here: MAV_SYSID 4 for SYSID_THISMAV 4",
        "sitl: 1 parameter of the files has no effect here: FRSKY_OPTIONS",
        "sitl: 2 parameters of the files are out of range (used instead): ACRO_Y_RATE 600 (360), RPM1_TYPE 10 (5)",
    ]
    assert not recwarn.list


def test_a_file_with_which_nothing_was_set_says_so(tmp_path: Path, capsys) -> None:
    (tmp_path / "plane.parm").write_text("Q_ENABLE 1\n")
    (tmp_path / "empty.parm").write_text("# nothing yet\n")
    options.build_simulation(parsed(COMMANDS[0], tmp_path / "plane.parm", tmp_path / "empty.parm"))
    said = capsys.readouterr().err
    assert f"{tmp_path / 'plane.parm'}: nothing was set: none of its parameters is in this firmware" in said
    assert f"{tmp_path / 'empty.parm'}: nothing was set: it has no parameters" in said


def test_a_foreign_ardupilot_gets_what_was_read(tmp_path: Path, monkeypatch, capsys) -> None:
    """Its own reader would pass over QGroundControl's columns in silence."""
    (tmp_path / "wind.parm").write_text("SIM_WIND_SPD = 3\nNO_SUCH 7 @READONLY\n@include absent.parm\n")
    given = parsed(COMMANDS[0], FILES / "qgc.params", tmp_path / "wind.parm")
    choice, texts = Choice(ARDUPILOT, Path("/bin/true")), {}

    class Process:
        def __init__(self, words, files, environment, folder, grace_s) -> None:
            texts.update(files)
            raise InterruptedError

    monkeypatch.setattr(ardupilot, "AutopilotProcess", Process)
    plant = foreign.build_plant(given, choice)
    assert plant.vehicle.v.autopilot.params.SIM.WIND_SPD == 3.0
    assert capsys.readouterr().err.count("absent.parm") == 1
    with pytest.raises(InterruptedError):
        foreign.build_session(given, choice, plant, [], 1.0, None, print)
    plant.close()
    lines = texts["overrides.parm"].splitlines()
    assert lines[:3] == ["FENCE_ALT_MAX 77", "FENCE_RADIUS 700", "FENCE_ENABLE 0"]
    assert "NO_SUCH 7 @READONLY" in lines and lines[-1] == "SYSID_THISMAV 1"


def test_the_wind_of_a_file_may_be_out_of_range_for_a_foreign_autopilot(tmp_path: Path) -> None:
    (tmp_path / "wind.parm").write_text("SIM_WIND_SPD 3\nSIM_WIND_DIR 1e6\n")
    given = parsed(COMMANDS[0], tmp_path / "wind.parm")
    plant = foreign.build_plant(given, Choice(PX4, Path("/bin/true")))
    assert plant.vehicle.v.autopilot.params.SIM.WIND_SPD == 3.0
    plant.close()
