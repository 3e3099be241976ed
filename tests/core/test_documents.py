# SPDX-License-Identifier: BSD-3-Clause
"""A text that is no document is one error, whatever the standard library makes of it."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from sitl import cli
from sitl.core import documents

DEEP = "a = " + "[" * 5_000 + "]" * 5_000
LONG = "a = " + "9" * 5_000
OBJECTS = '{"a":' * 100_000


@pytest.mark.parametrize("text", [DEEP, LONG, "a = [", "a = 1\na = 2"])
def test_no_toml(text: str) -> None:
    with pytest.raises(tomllib.TOMLDecodeError):
        documents.toml(text)


@pytest.mark.parametrize("text", ["[" * 100_000, OBJECTS, "9" * 5_000, "{", b"\xff"])
def test_no_json(text: str | bytes) -> None:
    with pytest.raises(ValueError):
        documents.of_json(text)


def test_documents() -> None:
    assert documents.toml("a = [1, 2]") == {"a": [1, 2]} and documents.of_json(b'{"a": [1, null]}') == {"a": [1, None]}


@pytest.mark.parametrize("words", [["world", "show", "{}"], ["train", "--recipe", "{}"], ["mission", "suite", "{dir}"]])
@pytest.mark.parametrize("text", [DEEP, LONG])
def test_a_command_says_it_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], words: list[str], text: str
) -> None:
    file = tmp_path / "suite.toml"
    file.write_text(text)
    assert cli.main([word.format(file, dir=tmp_path) for word in words]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1 and str(tmp_path) in said


def test_a_run_folder_of_lists_without_end(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "config.json").write_text(OBJECTS)
    assert cli.main(["evaluate", str(tmp_path)]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1 and "config.json cannot be read" in said


def test_a_name_that_no_file_can_have(capsys: pytest.CaptureFixture[str]) -> None:
    for words in (["view"], ["mission", "fly"], ["evaluate"], ["mission", "compare", "x.tlog"]):
        assert cli.main([*words, "x" * 300 + ".tlog"]) == 2
        assert capsys.readouterr().err.count("\n") == 1
