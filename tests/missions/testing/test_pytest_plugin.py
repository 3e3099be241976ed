# SPDX-License-Identifier: BSD-3-Clause
"""The plugin in pytest: fixtures, options, logs of failing tests, workers, and that it costs nothing unused."""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path

import pytest

import sitl

FAILING = """
def test_high(copter):
    copter.takeoff(5)
    copter.wait_altitude(50, timeout=5)
"""
GOLDEN = """
import pytest

@pytest.mark.parametrize("north", [5, 10])
def test_hop(copter, assert_flies_like, north):
    copter.takeoff(5)
    copter.fly_to(north, 0)
    copter.land()
    assert_flies_like(f"golden/hop-{north}.rec")
"""


def test_fixtures_and_markers(project: pytest.Pytester) -> None:
    project.makeini("[pytest]\nsitl_seed = 4\nsitl_params = base.parm\naddopts = --strict-markers")
    project.makefile(".parm", base="SIM_WIND_TC 4\nRTL_ALT 1200\n")
    project.makepyfile(
        """
        import pytest

        pytestmark = pytest.mark.sitl(wind=(5, 90), seed=9)

        @pytest.mark.sitl(frame="ardupilot_quad", params={"RTL_ALT": 1300})
        def test_copter(copter):
            assert copter.simulation.airframe.name == "ardupilot_quad"
            assert copter.simulation.seed == 9
            values = [copter.parameter(name) for name in ("SIM_WIND_SPD", "SIM_WIND_DIR", "SIM_WIND_TC", "RTL_ALT")]
            assert values == [5, 90, 4, 1300]

        def test_factory(vehicle_factory, copter):
            rover = vehicle_factory("rover", world="maze_erlerover", params={})
            assert rover.kind == "rover" and rover.simulation.world.name == "maze_erlerover"
            assert rover.simulation.seed == 4 and rover.parameter("SIM_WIND_SPD") == 0
            assert [v.name for v in vehicle_factory.vehicles] == ["copter", "rover"]
            assert vehicle_factory(mission="rover/maze_route").simulation.world is not None

        def test_errors(vehicle_factory):
            with pytest.raises(ValueError, match="airframe erle_rover is a rover; those of a copter are erle_copter"):
                vehicle_factory("copter", frame="erle_rover")
            with pytest.raises(ValueError, match="'boat' is none of copter, rover"):
                vehicle_factory("boat")
            with pytest.raises(ValueError, match="no parameters NO_SUCH"):
                vehicle_factory("copter", params={"NO_SUCH": 1})
            with pytest.raises(ValueError, match="wind"):
                vehicle_factory("copter", wind=(1, 2, 3, 4))
            with pytest.raises(ValueError, match="'hight' is none of frame, home, .*, mission, ready, "):
                vehicle_factory("copter", hight=3)
        """
    )
    result = project.runpytest_inprocess()
    result.assert_outcomes(passed=3)  # a rover has no RTL_ALT, and does without


def test_files_of_parameters_are_taken_as_a_vehicle_takes_them(project: pytest.Pytester) -> None:
    project.makeini("[pytest]\nsitl_params = base.params")
    project.makefile(".params", base="# Onboard parameters\n1\t1\tRTL_ALT\t1200\t4\n1\t1\tLAND_SPEED\t40\t4\n")
    project.makefile(".param", mine="ACRO_Y_RATE,600\nRTL_ALT,1300\nQ_ENABLE,1\n")
    project.makepyfile(
        """
        import pytest

        @pytest.mark.sitl(params="mine.param")
        def test_copter(copter):
            assert [copter.parameter(name) for name in ("ACRO_Y_RATE", "RTL_ALT", "LAND_SPEED")] == [600, 1300, 40]

        def test_its_own_values_are_checked(vehicle_factory):
            with pytest.raises(ValueError, match="the copter has no parameters NO_SUCH"):
                vehicle_factory("copter", params={"NO_SUCH": 1})
            with pytest.raises(ValueError, match="ACRO_Y_RATE: 600 is outside"):
                vehicle_factory("copter", params={"ACRO_Y_RATE": 600})
        """
    )
    result = project.runpytest_inprocess()
    result.assert_outcomes(passed=2, warnings=2)
    result.stdout.fnmatch_lines_random(["*not in this firmware: Q_ENABLE*", "*ACRO_Y_RATE 600 (360)*"])


def test_an_option_that_there_is_not_is_named(project: pytest.Pytester) -> None:
    project.makepyfile(
        """
        import pytest

        @pytest.mark.sitl(wrld="maze_erlerover")
        def test_copter(copter): pass
        """
    )
    result = project.runpytest_inprocess()
    result.assert_outcomes(errors=1)
    result.stdout.fnmatch_lines(["E *OptionError: option 'wrld' is none of frame, home, *; did you mean 'world'?"])


@pytest.fixture
def copters(project: pytest.Pytester) -> pytest.Pytester:
    project.makepyfile(FAILING)
    return project


def test_a_failing_test_keeps_its_logs(copters: pytest.Pytester) -> None:
    result = copters.runpytest_inprocess("--sitl-log-dir", "kept", "--sitl-seed=3")
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines([
        ">*wait_altitude(50, timeout=5)", "E *waited 5 s for an altitude of at least 50 m", "E *last seen: *",
        "*- sitl: copter -*", "erle_copter, seed 3, * s simulated", "kept *copter.rec",
    ])  # fmt: skip
    result.stdout.no_fnmatch_line("*session.py*")  # no inner life in the traceback
    (folder,) = (copters.path / "kept").iterdir()
    assert {file.name for file in folder.iterdir()} == {"copter.tlog", "copter.bin", "copter.rec"}


def test_without_a_folder_logs_go_to_the_cache(copters: pytest.Pytester) -> None:
    copters.runpytest_inprocess().assert_outcomes(failed=1)
    assert len(list((copters.path / ".pytest_cache/d/sitl-logs").rglob("copter.*"))) == 3


def test_a_passing_test_keeps_nothing(project: pytest.Pytester) -> None:
    project.makepyfile("def test_arm(copter): copter.arm()")
    project.runpytest_inprocess("--sitl-log-dir", "kept").assert_outcomes(passed=1)
    assert not (project.path / "kept").exists()


def test_goldens(project: pytest.Pytester) -> None:
    project.makepyfile(GOLDEN)
    result = project.runpytest_inprocess()
    result.assert_outcomes(failed=2)
    result.stdout.fnmatch_lines(["*no golden flight *hop-5.rec; *pytest 'test_goldens.py::test_hop?5?' --sitl-update*"])
    result = project.runpytest_inprocess("--sitl-update-golden")
    result.assert_outcomes(passed=2)
    result.stdout.fnmatch_lines(["golden flight written: *hop-5.rec", "golden flight written: *hop-10.rec"])
    project.runpytest_inprocess().assert_outcomes(passed=2)
    source = Path(project.path / "test_goldens.py")
    source.write_text(source.read_text().replace("fly_to(north, 0)", "fly_to(north, 0.5)"))
    result = project.runpytest_inprocess("--sitl-log-dir=logs", "-k", "10")
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["E *does not fly like the golden flight: *", "E *report: *report.html"])


@pytest.mark.slow
def test_workers(project: pytest.Pytester) -> None:
    pytest.importorskip("xdist")
    project.makepyfile(test_one=GOLDEN.replace("hop-", "one-"), test_two=GOLDEN + FAILING)
    result = project.runpytest_subprocess("-p", "xdist", "-n2", "--sitl-update-golden", "--sitl-log-dir=logs")
    result.assert_outcomes(passed=4, failed=1)
    result.stdout.fnmatch_lines(["golden flight written: *hop-5.rec"])
    result.stdout.fnmatch_lines(["kept *logs/test_two.py-test_high/copter.rec"])
    assert len(list((project.path / "golden").glob("*.rec"))) == 4


def test_it_costs_nothing_where_it_is_not_used(project: pytest.Pytester) -> None:
    project.makepyfile(
        """
        import sys

        def test_nothing():
            assert not {"numpy", "numba", "pymavlink"} & set(sys.modules)
            assert sorted(m for m in sys.modules if m.split(".")[0] == "sitl") == [
                "sitl", "sitl.missions", "sitl.missions.testing", "sitl.missions.testing.plugin", "sitl.version"
            ]
        """
    )
    project.runpytest_subprocess("-p", "no:cacheprovider").assert_outcomes(passed=1)


def test_options_are_checked(project: pytest.Pytester) -> None:
    project.makepyfile("def test_arm(copter): pass")
    result = project.runpytest_inprocess("--sitl-seed=abc")
    result.stdout.fnmatch_lines(["*--sitl-seed 'abc' is not a whole number"])
    assert "abc" in project.runpytest_inprocess("--sitl-physics=abc").stdout.str()


def test_the_example(project: pytest.Pytester) -> None:
    """A user's project flies in our CI, too."""
    folder = Path(__file__).parents[3] / "examples" / "regression"
    shutil.copytree(folder, project.path / "regression", ignore=shutil.ignore_patterns(".pytest_cache", "__pycache__"))
    result = project.run(sys.executable, "-m", "pytest", str(project.path / "regression"))
    result.assert_outcomes(passed=4)
    assert not list((project.path / "regression").rglob("*.tlog"))


def test_the_package_is_imported_as_it_is_compiled(project: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where pytest knows it as the distribution of a plugin, as it does when it was installed from a wheel."""
    about = project.mkdir("installed") / "gym_sitl-0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: gym-sitl\nVersion: 0\n")
    (about / "RECORD").write_text("sitl/__init__.py,,\nother/__init__.py,,\n")
    (about.parent / "sitl").symlink_to(
        Path(sitl.__file__).parent
    )  # from Python 3.12 on what is not there does not count
    (about.parent / "other").mkdir()
    (about.parent / "other" / "__init__.py").touch()
    (about / "entry_points.txt").write_text("[pytest11]\nsitl = sitl.missions.testing.plugin\n")
    monkeypatch.setenv("PYTHONPATH", str(about.parent), prepend=os.pathsep)
    monkeypatch.delenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD")
    monkeypatch.delenv("PYTEST_ADDOPTS")
    path = project.makepyfile(
        """
        def test_how_it_was_imported(copter, pytestconfig):
            import sitl.simulation

            hook = pytestconfig.pluginmanager.rewrite_hook
            assert sitl.simulation.__loader__ is not hook
            assert "other" in hook._must_rewrite, "what this test makes is seen"
        """
    )
    project.runpytest_subprocess(path).assert_outcomes(passed=1)
