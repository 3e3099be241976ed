# SPDX-License-Identifier: BSD-3-Clause
"""Reports: one file that needs nothing else, JUnit, lines; and the command's exit codes."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from xml.etree import ElementTree as xml

import pytest

from sitl.cli import main
from sitl.missions.comparison import report
from sitl.missions.comparison.compare import Comparison, compare
from sitl.missions.comparison.flight import read
from tests.missions.comparison.conftest import fly_square


@pytest.fixture(scope="module")
def differing(squares: Path, tmp_path_factory: pytest.TempPathFactory) -> Comparison:
    path = tmp_path_factory.mktemp("slow") / "slow.rec"
    fly_square(path, params={"ATC_RAT_RLL_P": 0.1})
    return compare(read(squares / "copter.rec"), read(path))


def test_the_page_needs_nothing_else(differing: Comparison, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    text = report.report_write(differing, tmp_path).read_text()
    assert "Does not fly like the golden flight" in text
    assert text.count("data:image/png;base64,") == 3
    assert not re.search(r'(src|href)="(?!data:|flights\.html)', text)
    assert "Disarming motors" in text
    assert len(text) < 2_000_000


def test_flights_that_differ_leave_a_scene_in_one_file(differing: Comparison, tmp_path: Path) -> None:
    pytest.importorskip("viser", reason="the page needs viser: pip install 'gym-sitl[view]'")
    text = report.report_write(differing, tmp_path).read_text()
    assert '<a href="flights.html">' in text
    scene = (tmp_path / "flights.html").read_text()
    assert "__VISER_EMBED_DATA__" in scene and 'src="http' not in scene and len(scene) < 10_000_000
    alike = compare(differing.golden, differing.golden)
    assert "flights.html" not in report.report_write(alike, tmp_path / "alike").read_text()
    assert not (tmp_path / "alike" / "flights.html").exists()


def test_without_matplotlib_it_says_what_is_missing(
    differing: Comparison, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    for name in [name for name in sys.modules if name.partition(".")[0] == "matplotlib"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    text = report.report_write(differing, tmp_path).read_text()
    assert "gym-sitl[viz]" in text
    assert "<img" not in text


@pytest.mark.parametrize("given, shown", [("", "slow.rec"), ("Square <1>", "Square &lt;1&gt;")])
def test_a_page_without_a_title_has_the_name_of_the_flights_file(differing: Comparison, given: str, shown: str) -> None:
    assert f"<title>{shown}: does not fly like the golden flight</title>" in report.html(differing, given)


def test_junit_has_a_case_for_each_metric(differing: Comparison, tmp_path: Path) -> None:
    report.report_write(differing, tmp_path)
    suite = xml.parse(tmp_path / report.JUNIT).getroot().find("testsuite")
    assert suite is not None
    cases = suite.findall("testcase")
    assert len(cases) == sum(metric.is_judged for metric in differing.metrics)
    bad = {case.get("name") for case in cases if case.find("failure") is not None}
    assert bad == {metric.name for metric in differing.failed}
    assert suite.get("failures") == str(len(bad))


def test_junit_takes_any_text(tmp_path: Path) -> None:
    report.junit_write(tmp_path / "j.xml", [report.Case("s", "n", failure="a\0b <&> \x1b[1m", output="é")])
    case = xml.parse(tmp_path / "j.xml").getroot().find("testsuite/testcase")
    assert case is not None
    failure = case.find("failure")
    assert failure is not None and failure.text == "a?b <&> ?[1m"


def test_lines_tell_what_is_wrong_or_all(differing: Comparison) -> None:
    some, everything = report.lines(differing), report.lines(differing, True)
    assert some[0].startswith("DIFFERS: does not fly like the golden flight: ")
    assert len(everything) > len(some)
    assert sum(line.startswith("  !") for line in some) == len(differing.failed)


def test_the_command_tells_by_its_exit_code(
    squares: Path, differing: Comparison, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    golden = str(squares / "copter.rec")
    assert main(["mission", "compare", golden, str(squares / "copter.tlog")]) == 0
    assert "OK: flies like the golden flight" in capsys.readouterr().out
    folder = tmp_path / "report"
    assert main(["mission", "compare", golden, differing.new.name, "--report", str(folder)]) == 1
    out = capsys.readouterr().out
    assert "DIFFERS" in out and str(folder / report.HTML) in out
    assert (folder / report.JUNIT).exists()


@pytest.mark.parametrize("bad", ["missing.rec", "foreign.rec", "cut.rec"])
def test_the_command_says_what_is_wrong_with_a_file(
    squares: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], bad: str
) -> None:
    golden, path = squares / "copter.rec", tmp_path / bad
    if bad == "foreign.rec":
        path.write_bytes(b"PNG" * 50)
    elif bad == "cut.rec":
        path.write_bytes(golden.read_bytes()[:-40])
    try:
        code: object = main(["mission", "compare", str(golden), str(path)])
    except SystemExit as stop:
        code = stop.code
    assert code == 2
    assert bad in capsys.readouterr().err
