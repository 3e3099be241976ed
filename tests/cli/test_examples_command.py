# SPDX-License-Identifier: BSD-3-Clause
"""``sitl examples``: what is listed is there, and is copied where its command finds it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from sitl.cli import main, parser
from sitl.cli.example_programs import EXAMPLES, FOLDER, source, title


def test_each_example_is_listed_and_each_that_is_listed_is_there() -> None:
    files = {file.stem for file in FOLDER.glob("*.py")} - {"__init__"}
    folders = {file.parent.name for file in FOLDER.glob("*/test_*.py")}
    assert files | folders == set(EXAMPLES)


@pytest.mark.parametrize("name", EXAMPLES)
def test_an_example_says_what_it_shows_and_how_it_runs(name: str) -> None:
    assert title(name).endswith(".") and len(title(name)) < 120
    words = EXAMPLES[name].command.split()
    assert f"examples/{source(name).name}" in words
    if words[0] == "sitl":
        assert parser(words[1:]).parse_args(words[1:])


def test_they_are_listed_and_described(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["examples"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == list(EXAMPLES)
    assert main(["examples", "mavsdk_mission"]) == 0
    shown = capsys.readouterr().out
    assert title("mavsdk_mission") in shown and EXAMPLES["mavsdk_mission"].command in shown
    assert "pip install mavsdk" in shown
    assert main(["examples", "--json"]) == 0
    assert [row["name"] for row in json.loads(capsys.readouterr().out)] == list(EXAMPLES)


def test_copies_are_whole_and_a_changed_one_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    for _ in range(2):  # a copy that is there already is no mistake
        assert main(["examples", "--copy"]) == 0
    for name in EXAMPLES:
        there = tmp_path / "examples" / source(name).name
        assert there.is_dir() if source(name).is_dir() else there.read_bytes() == source(name).read_bytes()
    assert (tmp_path / "examples/regression/golden/square.rec").exists()
    changed = tmp_path / "examples/pymavlink_guided.py"
    changed.write_text("mine")
    assert main(["examples", "pymavlink_guided", "--copy"]) == 2
    assert "examples/pymavlink_guided.py is there and differs" in capsys.readouterr().err
    assert changed.read_text() == "mine"


def test_a_name_that_is_not_known(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["examples", "mavsdk_misson"]) == 2
    assert "did you mean 'mavsdk_mission'?" in capsys.readouterr().err
