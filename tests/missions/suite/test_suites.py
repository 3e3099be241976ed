# SPDX-License-Identifier: BSD-3-Clause
"""Suites: which flights there are, and what becomes of goldens."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from sitl.autopilot.params.parm_files import ParameterWarning
from sitl.cli import main
from sitl.errors import MissingExtra
from sitl.missions import library
from sitl.missions.comparison.tolerance import ToleranceError
from sitl.missions.suite.cases import SuiteError, find
from sitl.missions.suite.fly_case import DIFFERS, FAILED, KEPT, NO_GOLDEN, OK, REPLACED, WRITTEN, fly_case
from sitl.missions.suite.run import run
from sitl.simulation import Simulation
from tests.recording.older import without_bits


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a copter's and a rover's square."""
    for kind in ("copter", "rover"):
        shutil.copy(library.find(f"{kind}/square").path, tmp_path / f"{kind}.plan")
    return tmp_path


def toml(folder: Path, text: str) -> Path:
    (folder / "suite.toml").write_text(text)
    return folder


def test_without_a_suite_toml_every_mission_is_flown(folder: Path) -> None:
    cases = find(folder)
    assert [(case.name, case.kind, case.seed) for case in cases] == [("copter", "copter", 0), ("rover", "rover", 0)]
    assert cases[0].golden == folder / "golden" / "copter.rec"


def test_variants_seeds_and_the_library(folder: Path) -> None:
    toml(
        folder,
        """
[defaults]
tolerance = "alike"
params = { WPNAV_RADIUS = 1.0 }
[[missions]]
file = "*.plan"
[[missions]]
library = "copter/office*"
seed = 4
[[variants]]
seed = 1
[[variants]]
name = "wind"
vehicle = "copter"
seeds = [2, 3]
params = { SIM_WIND_SPD = 5.0 }
missions = ["copter"]
""",
    )
    cases = {case.name: case for case in find(folder)}
    assert sorted(cases) == ["copter", "copter-office_route", "copter-wind-seed2", "copter-wind-seed3", "rover"]
    assert cases["copter"].seed == 1
    assert cases["copter-wind-seed3"].seed == 3
    assert cases["copter-wind-seed3"].params == {"WPNAV_RADIUS": 1.0, "SIM_WIND_SPD": 5.0}
    assert cases["copter-office_route"].world == "office_erlecopter"
    assert {case.tolerance for case in cases.values()} == {"alike"}


def test_parameters_of_a_suite_may_be_a_file_in_its_folder(folder: Path) -> None:
    (folder / "mine.params").write_text("1\t1\tWPNAV_SPEED\t300\t9\n1\t1\tACRO_Y_RATE\t600\t9\n")
    text = "[defaults]\nparams = 'mine.params'\n[[variants]]\nparams = { SIM_WIND_SPD = 2.0 }\n"
    params = find(toml(folder, text))[0].params
    assert params == {"WPNAV_SPEED": 300.0, "ACRO_Y_RATE": 600.0, "SIM_WIND_SPD": 2.0}
    with pytest.warns(ParameterWarning, match="out of range"):
        assert Simulation("erle_copter", params=params).parameters["ACRO_Y_RATE"] == 600.0


def test_the_suite_toml_of_the_documentation_is_one(folder: Path) -> None:
    page = (Path(__file__).parents[3] / "docs" / "regression.md").read_text()
    text = page.split("```toml\n")[2].split("```")[0]
    assert "copter-office_route" in {case.name for case in find(toml(folder, text.replace('"square*"', '"copter"')))}
    assert "copter-wind-seed3" in {case.name for case in find(folder)}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[[mission]]\n", "'mission' is not known"),
        ("[defaults]\nseeed = 1\n", r"\[defaults\]: 'seeed' is not known"),
        ("[defaults]\nseed = 1.5\n", "seed = 1.5 is not a whole number"),
        ("[[missions]]\nseed = 1\n", "has either file or library"),
        ("[[missions]]\nlibrary = 'copter/nothing'\n", "no mission of the library is 'copter/nothing'"),
        ("[[variants]]\n[[variants]]\nseed = 2\n", "two flights are called"),
        ("[", "is no TOML"),
        ("missions = 3\n", "missions is a list of tables"),
        ("[defaults]\nvehicle = 'plane'\n", "vehicle = 'plane' is not"),
        ("[defaults]\nhome = [1, 2]\n", r"home = \[1, 2\] is not"),
        ("[defaults]\nseeds = []\n", r"seeds = \[\] is not a list of whole numbers"),
        ("[defaults]\nparams = { A = 'x' }\n", "which are numbers"),
        ("[defaults]\nparams = 'absent.parm'\n", "parameter file '.*absent.parm' cannot be read"),
        ("[defaults]\nparams = '../mine.parm'\n", "params = '../mine.parm' is not in the folder of the suite"),
        ("[defaults]\ntime_limit = -5\n", "above 0"),
        ("[[variants]]\nname = '../x'\n", "name = '../x' is not a name"),
        ("[[variants]]\nmissions = [3]\n", "list of patterns"),
    ],
)
def test_mistakes_are_named(folder: Path, text: str, words: str) -> None:
    with pytest.raises(SuiteError, match=words):
        find(toml(folder, text))


def test_tolerances_are_read_before_anything_flies(folder: Path) -> None:
    with pytest.raises(ToleranceError, match="'nosuch' cannot be read"):
        find(toml(folder, "[defaults]\ntolerance = 'nosuch'\n"))


def test_missions_of_other_folders_are_those(folder: Path) -> None:
    (folder / "more").mkdir()
    (folder / "copter.plan").rename(folder / "more" / "copter.plan")
    for name in ("more/*.plan", "more/copter.plan", str(folder / "more" / "copter.plan")):
        assert [case.mission for case in find(toml(folder, f"[[missions]]\nfile = {name!r}\n"))] == [
            folder / "more" / "copter.plan"
        ]


def test_texts_that_are_no_missions_are_passed_over(folder: Path) -> None:
    names = [case.name for case in find(folder)]
    (folder / "README.txt").write_text("Our missions\n")
    assert [case.name for case in find(folder)] == names


def test_a_golden_that_is_of_no_use_is_replaced_only_when_asked(folder: Path) -> None:
    copter, rover = find(folder)
    fly_case(rover, update=True)
    copter.golden.write_bytes(rover.golden.read_bytes())
    assert fly_case(copter).words == "golden is of a rover, the new flight of a copter"
    copter.golden.write_text("junk")
    assert fly_case(copter).status == FAILED
    assert copter.golden.read_text() == "junk"
    assert fly_case(copter, update=True).status == REPLACED
    assert fly_case(copter).status == OK


def test_a_golden_that_cannot_be_written_is_said(folder: Path) -> None:
    case = find(folder)[0]
    case.golden.parent.write_text("a file")
    result = fly_case(case, update=True)
    assert (result.status, "cannot be written" in result.words) == (FAILED, True)
    case.golden.parent.unlink()
    case.golden.mkdir(parents=True)
    assert "Is a directory" in fly_case(case, update=True).words
    assert list(case.golden.parent.iterdir()) == [case.golden]


def test_an_empty_folder_has_nothing_to_fly(tmp_path: Path) -> None:
    with pytest.raises(SuiteError, match="holds no mission"):
        find(tmp_path)
    with pytest.raises(SuiteError, match="is no folder"):
        find(tmp_path / "nowhere")


def test_goldens_are_written_only_when_asked_and_kept_when_alike(folder: Path) -> None:
    case = find(folder)[0]
    assert fly_case(case).status == NO_GOLDEN
    assert not case.golden.exists()
    assert fly_case(case, update=True).status == WRITTEN
    before = case.golden.read_bytes()
    assert fly_case(case).status == OK
    assert fly_case(case, update=True).status == KEPT
    assert case.golden.read_bytes() == before
    assert list(case.golden.parent.iterdir()) == [case.golden]


def test_a_golden_of_an_older_version_is_held_to_limits_and_says_how_it_is_made_anew(folder: Path) -> None:
    case = find(folder)[0]
    fly_case(case, update=True)
    without_bits(case.golden)
    result = fly_case(case)
    assert result.status == OK
    assert result.words.endswith(f"compared exactly: sitl mission suite {folder} --update-golden --only {case.name}")
    assert fly_case(case, update=True).status == REPLACED
    assert fly_case(case, update=True).status == KEPT
    assert not fly_case(case).words


def test_a_flight_that_differs_is_kept_with_its_report(folder: Path) -> None:
    case = find(folder)[0]
    fly_case(case, update=True)
    golden = case.golden.read_bytes()
    changed = find(toml(folder, "[defaults]\nparams = { WPNAV_SPEED = 300.0 }\n"))[0]
    result = fly_case(changed, reports=str(folder / "reports"))
    assert result.status == DIFFERS
    assert not result.ok
    assert "does not fly like the golden flight" in result.words
    assert Path(result.recording).read_bytes() != golden
    assert "Does not fly like the golden flight" in Path(result.report).read_text()
    assert case.golden.read_bytes() == golden
    assert fly_case(changed, update=True).status == REPLACED
    assert fly_case(changed).status == OK


def test_a_case_that_cannot_be_flown_does_not_stop_the_others(folder: Path) -> None:
    (folder / "copter.plan").write_text("{}")
    toml(folder, '[[missions]]\nfile = "copter.plan"\nframe = "erle_copter"\n[[missions]]\nfile = "rover.plan"\n')
    results = {result.name: result for result in run(find(folder), jobs=1, update=True)}
    assert results["copter"].status == FAILED
    assert "copter.plan" in results["copter"].words
    assert results["rover"].status == WRITTEN


def test_parameters_that_a_vehicle_does_not_have_are_named(folder: Path) -> None:
    case = find(toml(folder, "[defaults]\nparams = { CRUISE_SPEED = 2.0 }\n"))[0]
    result = fly_case(case, update=True)
    assert result.status == FAILED
    assert "the copter has no parameters CRUISE_SPEED" in result.words
    assert not case.golden.exists()


def test_a_damaged_golden_is_an_error_and_stays(folder: Path) -> None:
    case = find(folder)[0]
    fly_case(case, update=True)
    case.golden.write_bytes(case.golden.read_bytes()[:-30])
    broken = case.golden.read_bytes()
    result = fly_case(case)
    assert result.status == FAILED
    assert case.golden.name in result.words
    assert case.golden.read_bytes() == broken


def test_the_command(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    suite = ["mission", "suite", str(folder), "--jobs", "1", "--report", str(folder / "out")]
    assert main(suite) == 1
    assert "NO GOLDEN" in capsys.readouterr().out
    assert main([*suite, "--update-golden"]) == 0
    assert main([*suite, "--only", "rov*"]) == 0
    out = capsys.readouterr().out
    assert "1 of 1 passed" in out
    assert (folder / "out" / "index.html").exists()
    assert '<testsuite name="' in (folder / "out" / "junit.xml").read_text()


def test_ray_is_an_extra(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "ray", None)
    with pytest.raises(MissingExtra, match=r"gym-sitl\[ray\]"):
        list(run(find(folder), backend="ray"))


@pytest.mark.slow
def test_processes_give_what_one_gives(folder: Path) -> None:
    cases = find(folder)
    alone = {result.name: result.status for result in run(cases, jobs=1, update=True)}
    assert set(alone.values()) == {WRITTEN}
    together = list(run(cases, jobs=2))
    assert [result.status for result in together] == [OK, OK]
    assert all(value == 0.0 for result in together for value in result.metrics.values())
