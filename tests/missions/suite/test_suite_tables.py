# SPDX-License-Identifier: BSD-3-Clause
"""Table, pages and exit code of a suite, of results that nobody flew; where its cases are flown."""

from __future__ import annotations

import argparse
import re
from concurrent.futures.process import BrokenProcessPool
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from xml.etree import ElementTree

import pytest

from sitl.errors import OptionError
from sitl.missions.cli import suite as command
from sitl.missions.suite import cases as suite_cases
from sitl.missions.suite import fly_case
from sitl.missions.suite import run as table
from sitl.missions.suite.cases import Case, SuiteError
from sitl.missions.suite.fly_case import Result

METRICS = dict(zip(fly_case.SHOWN, (1.234, 2.0, 0.5, 0.25, 3.0), strict=True))


def case(name: str, kind: str = "copter", **given: Any) -> Case:
    plain = Case(name, Path("a.plan"), Path("golden") / f"{name}.rec", "erle_copter", kind, None, None, None, 0, {},
                 "native", None, 600.0)  # fmt: skip
    return replace(plain, **given)


# ---------------------------------------------------------------- the table


def test_values_stand_under_their_heads() -> None:
    head = table.head(10)
    line = table.line(Result("square", "ok", simulated=65.43, wall=1.256, metrics=METRICS), 10)
    assert head.startswith("mission   ") and len(head) == len(line)
    shown = {"position [m]": "1.23", "cross-track [m]": "2.00", "altitude [m]": "0.50", "delay [s]": "0.25",
             "energy [%]": "3.00", "time [s]": "65.4", "wall [s]": "1.26"}  # fmt: skip
    for name, text in shown.items():
        end = head.index(name) + len(name)
        assert line[:end].endswith(f" {text}"), name


def test_what_could_not_be_compared_has_no_values_and_words_stand_below() -> None:
    line = table.line(Result("x", "NO GOLDEN", words="there is none", note="not completed", report="r/x.html"), 10)
    first, *below = line.splitlines()
    assert len(first) == len(table.head(10)) and first.split() == ["x", "NO", "GOLDEN", "0.0", "0.00"]
    assert below == ["    there is none", "    not completed", "    report: r/x.html"]
    assert "\n" not in table.line(Result("x", "ok"), 10)


@pytest.mark.parametrize(
    ("status", "ok"),
    [("ok", True), ("kept", True), ("written", True), ("replaced", True), ("DIFFERS", False), ("NO GOLDEN", False),
     ("ERROR", False)],
)  # fmt: skip
def test_what_is_as_expected(status: str, ok: bool) -> None:
    assert Result("x", status).ok == ok


def test_the_last_line_sums_up() -> None:
    results = [Result("a", "ok", simulated=90.0), Result("b", "DIFFERS", simulated=89.0), Result("c", "kept")]
    assert table.summary(results, 12.34) == "2 of 3 passed: 3 simulated minutes in 12.3 s"


# ---------------------------------------------------------------- pages


def test_the_page_begins_with_what_is_wrong_and_links_reports_within_its_folder(tmp_path: Path) -> None:
    (tmp_path / "b < c").mkdir()
    results = [
        Result("z", "ok", metrics=METRICS, note="a note"), Result("a", "ok"),
        Result("b < c", "DIFFERS", "1 m & more", report=str(tmp_path / "b < c" / "report.html")),
    ]  # fmt: skip
    path = table.write(tmp_path, "missions/", results)
    text = path.read_text()
    assert path == tmp_path / "index.html"
    assert '<header class="bad"><h1>2 of 3 missions fly like their golden flights</h1>' in text
    assert "<code>missions/</code>" in text
    rows = re.findall(
        r'<tr class="(\w*)"><td class="mark">(&#\d+;)</td><td>(.*?)</td>(.*?)<td class=where>(.*?)</td>', text
    )
    assert [(state, mark, name, where) for state, mark, name, _, where in rows] == [
        ("bad", "&#10007;", '<a href="b &lt; c/report.html">b &lt; c</a>', "1 m &amp; more"),
        ("", "&#10003;", "a", ""),
        ("", "&#10003;", "z", "a note"),
    ]
    assert [row[3].count("<td") for row in rows] == [text.count("<th class=n>")] * 3 == [5] * 3
    assert re.findall(r'<td class="n">([\d.]+)</td>', rows[2][3]) == ["1.23", "2.00", "0.50", "0.25", "3.00"]
    assert '<header class=""><h1>1 of 1 missions' in table.write(tmp_path, "s", results[:1]).read_text()


def test_junit_tells_differences_from_what_could_not_be_flown(tmp_path: Path) -> None:
    results = [Result("a", "ok", "within", wall=1.5, note="a note"), Result("b", "DIFFERS", "differs"),
               Result("c", "ERROR", "broke"), Result("d", "NO GOLDEN", "none")]  # fmt: skip
    table.write(tmp_path / "deep" / "er", "s", results)
    (suite,) = ElementTree.parse(tmp_path / "deep" / "er" / "junit.xml").getroot()
    assert suite.attrib == {"name": "s", "tests": "4", "failures": "2", "errors": "1", "time": "1.500"}
    assert [[(child.tag, child.text) for child in found] for found in suite] == [
        [("system-out", "a note")], [("failure", "differs")], [("error", "broke")], [("failure", "none")],
    ]  # fmt: skip


# ---------------------------------------------------------------- where they fly


@pytest.fixture
def flown(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """What is loaded and flown."""
    done: list[Any] = []
    monkeypatch.setattr(table, "load_core", lambda kind, progress: done.append(("core", kind.name, progress)))

    def fly(one: Case, update: bool, reports: str | None) -> Result:
        done.append((one.name, update, reports))
        return Result(one.name, "ok")

    monkeypatch.setattr(table, "fly_case", fly)
    return done


def test_cores_are_loaded_before_anything_flies_and_only_where_they_are_needed(flown: list[Any]) -> None:
    cases = [case("a"), case("b", "rover"), case("c"), case("d", "rover", physics="bullet")]
    progress: Any = object()
    results = list(table.run(cases, jobs=1, update=True, reports="r", progress=progress))
    assert [result.name for result in results] == ["a", "b", "c", "d"]
    assert flown == [("core", "copter", progress), ("core", "rover", progress),
                     *((name, True, "r") for name in "abcd")]  # fmt: skip
    flown.clear()
    list(table.run([case("d", "rover", physics="bullet")], jobs=8))
    assert flown == [("d", False, None)], "one flight needs no process of its own"


def test_a_process_that_dies_is_the_result_of_its_case(flown: list[Any], monkeypatch: pytest.MonkeyPatch) -> None:
    class Done:
        def __init__(self, found: Any) -> None:
            self.found = found

        def result(self) -> Any:
            if isinstance(self.found, Exception):
                raise self.found
            return self.found

    class Pool:
        jobs = 0

        def __init__(self, jobs: int, mp_context: Any) -> None:
            Pool.jobs = jobs

        def __enter__(self) -> Pool:
            return self

        def __exit__(self, *_: Any) -> None: ...

        def submit(self, fly: Any, one: Case, update: bool, reports: Any) -> Done:
            return Done(BrokenProcessPool() if one.name == "b" else Result(one.name, "ok"))

    monkeypatch.setattr(table, "ProcessPoolExecutor", Pool)
    monkeypatch.setattr(table, "as_completed", list)
    results = list(table.run([case("a"), case("b"), case("c")], jobs=8))
    assert [(result.name, result.status) for result in results] == [("a", "ok"), ("b", "ERROR"), ("c", "ok")]
    assert results[1].words == "the process that flew it, or one beside it, died" and Pool.jobs == 3
    list(table.run([case("a"), case("b"), case("c")], jobs=2))
    assert Pool.jobs == 2


def test_on_a_cluster_all_paths_are_whole(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, flown: list[Any]) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("mine.toml", "w.world", "t.toml"):
        Path(name).write_text("")
    taken: list[Case] = []

    class Ray:
        def __enter__(self) -> Any:
            def wait(waiting: list[Any]) -> tuple[list[Any], list[Any]]:
                return waiting[:1], waiting[1:]

            def remote(fly: Any) -> Any:
                def send(one: Case, update: bool, reports: str | None) -> Result:
                    taken.append(one)
                    return fly(one, update, reports)  # type: ignore[no-any-return]

                return SimpleNamespace(remote=send)

            return SimpleNamespace(remote=remote, wait=wait, get=lambda done: done)

        def __exit__(self, *_: Any) -> None: ...

    asked: list[Any] = []
    monkeypatch.setattr(table, "cluster", lambda jobs: asked.append(jobs) or Ray())
    cases = [case("a", frame="mine.toml", world="w.world", tolerance="t.toml"),
             case("b", world="maze", tolerance="alike"), case("c", tolerance={"base": "same"})]  # fmt: skip
    results = list(table.run(cases, jobs=5, backend="ray", update=True, reports="r"))
    assert asked == [5] and [result.name for result in results] == ["a", "b", "c"]
    assert flown == [(name, True, str(tmp_path / "r")) for name in "abc"]
    a, b, c = taken
    assert (a.mission, a.golden) == (tmp_path / "a.plan", tmp_path / "golden" / "a.rec")
    assert [a.frame, a.world, a.tolerance] == [str(tmp_path / name) for name in ("mine.toml", "w.world", "t.toml")]
    assert (b.frame, b.world, b.tolerance, c.tolerance) == ("erle_copter", "maze", "alike", {"base": "same"})


# ---------------------------------------------------------------- the command


def run(monkeypatch: pytest.MonkeyPatch, results: list[Result], *words: str) -> tuple[int, dict[str, Any]]:
    asked: dict[str, Any] = {}
    cases = [case(result.name, params={"SIM_WIND_SPD": 5.0} if k else {}, world="maze" if k else None, seed=k)
             for k, result in enumerate(results)]  # fmt: skip
    monkeypatch.setattr(suite_cases, "find", lambda folder: cases)
    by_name = {result.name: result for result in results}

    def fly(given: list[Case], **options: Any) -> Any:
        asked.update(options)
        return (by_name[one.name] for one in given)

    monkeypatch.setattr(table, "run", fly)
    parser = argparse.ArgumentParser()
    command.add_parser(parser.add_subparsers())
    return int((options := parser.parse_args(["suite", "missions", *words])).function(options)), asked


@pytest.mark.parametrize(("status", "code"), [("ok", 0), ("kept", 0), ("DIFFERS", 1), ("NO GOLDEN", 1), ("ERROR", 1)])
def test_the_exit_code_is_1_where_one_is_not_like_its_golden(
    status: str, code: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    results = [Result("a", "ok"), Result("bb", status)]
    found, asked = run(monkeypatch, results)
    assert found == code and asked.pop("progress") is not None
    assert asked == {"jobs": None, "backend": "local", "update": False, "reports": None}
    out = capsys.readouterr().out.splitlines()
    assert out[:3] == [table.head(2), table.line(results[0], 2), table.line(results[1], 2)]
    assert out[3].startswith(f"{2 - code} of 2 passed: 0 simulated minutes in ") and len(out) == 4


def test_flights_are_listed_chosen_and_reported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    results = [Result("a", "ok"), Result("b-wind", "DIFFERS")]
    assert run(monkeypatch, results, "--list") == (0, {})
    assert capsys.readouterr().out == (
        "a       erle_copter  -  seed 0\nb-wind  erle_copter  maze  seed 1  SIM_WIND_SPD=5\n"
    )
    words = ("--only", "a*", "--only", "c", "--jobs", "3", "--update-golden", "--report", str(tmp_path / "r"))
    code, asked = run(monkeypatch, results, *words)
    assert code == 0 and (asked["jobs"], asked["update"], asked["reports"]) == (3, True, str(tmp_path / "r"))
    out = capsys.readouterr().out
    assert "b-wind" not in out and out.endswith(f"report: {tmp_path / 'r' / 'index.html'}\n")
    with pytest.raises(OptionError, match=r"--only c d: no flight of missions has such a name"):
        run(monkeypatch, results, "--only", "c", "--only", "d")


@pytest.mark.parametrize("text", ["0", "-1", "two", "1.5", ""])
def test_a_number_of_jobs_is_from_1_on(text: str) -> None:
    assert command._jobs("1") == 1
    with pytest.raises(argparse.ArgumentTypeError, match=f"'{text}' is not a number from 1 on"):
        command._jobs(text)


# ---------------------------------------------------------------- what a suite may say


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "a.waypoints").write_text(
        "QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t-35.3\t149.1\t584\t1\n1\t0\t3\t22\t0\t0\t0\t0\t0\t0\t5\t1\n"
    )
    return tmp_path


def found(folder: Path, text: str) -> list[Case]:
    (folder / "suite.toml").write_text(text)
    return suite_cases.find(folder)


FRAME = "frame = 'erle_copter'\n"


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("home = [1, 2, 3]", "home"), ("home = [1, 2, 3, 4, 5]", "home"), ("home = [1, 2, 3, true]", "home"),
        ("home = [1, 2, 3, nan]", "home"), ("home = [1, 2, 3, 'x']", "home"), ("time_limit = 0", "time_limit"),
        ("time_limit = inf", "time_limit"), ("time_limit = true", "time_limit"), ("seed = true", "seed"),
        ("seeds = [1, true]", "seeds"), ("seeds = [1, 2.0]", "seeds"), ("params = { A = true }", "params"),
        ("params = { A = inf }", "params"), ("vehicle = 'plane'", "vehicle"),
    ],
)  # fmt: skip
def test_a_value_that_is_none_is_named(folder: Path, text: str, error: str) -> None:
    with pytest.raises(SuiteError, match=rf"suite\.toml: \[defaults\]: {error} = .* is not "):
        found(folder, f"[defaults]\n{text}\n")


@pytest.mark.parametrize("name", ["a b", "a/b", "", "a\n", "ä b"])
def test_a_variant_has_a_name_that_is_one_of_a_file(folder: Path, name: str) -> None:
    with pytest.raises(SuiteError, match=r"name = .* is not"):
        found(folder, f"[[variants]]\nname = {name!r}\n".replace("'", '"'))
    assert [one.name for one in found(folder, "[[variants]]\nname = 'x.1+2=3,4-5_6'\n")] == ["a-x.1+2=3,4-5_6"]


def test_values_are_taken_from_the_variant_then_the_mission_then_the_defaults(folder: Path) -> None:
    text = f"[defaults]\n{FRAME}home = [1, 2, 3, 4]\ntime_limit = 5\nseed = 1\n[[missions]]\nfile = 'a.waypoints'\n"
    (one,) = found(folder, text)
    assert (one.home, one.time_limit, one.seed, one.kind, one.frame) == (
        (1, 2, 3, 4), 5.0, 1, "copter", "erle_copter",
    )  # fmt: skip
    (one,) = found(folder, text + "seed = 2\n")
    assert one.seed == 2
    (one,) = found(folder, text + "seed = 2\n[[variants]]\nseed = 3\ntolerance = 'same'\n")
    assert (one.seed, one.tolerance) == (3, "same")
    names = [(one.name, one.seed) for one in found(folder, text + "seeds = [4, 5]\n")]
    assert names == [("a-seed4", 4), ("a-seed5", 5)]
    (one,) = found(folder, "")
    assert (one.seed, one.home, one.tolerance, one.physics, one.time_limit) == (
        0, None, None, "native", suite_cases.LIMIT_S,
    )  # fmt: skip


def test_variants_are_of_a_vehicle_or_of_missions_by_their_patterns(folder: Path) -> None:
    text = "[[variants]]\nname = 'r'\nvehicle = 'rover'\n[[variants]]\nname = 'c'\nvehicle = 'copter'\n"
    assert [one.name for one in found(folder, text)] == ["a-c"]
    text = "[[variants]]\nname = 'x'\nmissions = ['b*', 'a']\n[[variants]]\nname = 'y'\nmissions = ['b*']\n"
    assert [one.name for one in found(folder, text)] == ["a-x"]


@pytest.mark.parametrize(
    ("begin", "is_one"),
    [(b"QGC WPL 110\n", True), (b"\xef\xbb\xbfQGC WPL 110\n", True), (b"a text\n", False), (b" QGC WPL", False)],
)
def test_a_text_is_a_mission_by_its_first_words(tmp_path: Path, begin: bytes, is_one: bool) -> None:
    for suffix, mission in ((".txt", is_one), (".plan", True), (".WAYPOINTS", True), (".toml", False)):
        path = tmp_path / f"x{suffix}"
        path.write_bytes(begin)
        assert suite_cases._is_mission(path) == mission
    assert not suite_cases._is_mission(tmp_path)
