# SPDX-License-Identifier: BSD-3-Clause
"""``sitl world``."""

from __future__ import annotations

from pathlib import Path

import pytest

from sitl import worlds
from sitl.cli import main


def test_list(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["world", "list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == list(worlds.names())


def test_show_writes_a_picture_and_says_what_there_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["world", "show", "maze"]) == 0
    said = capsys.readouterr().out
    assert "12 boxes, 4 cylinders" in said and "original: x 0, y 0, z 0 m" in said and said.endswith("plan: maze.png\n")
    assert (tmp_path / "maze.png").read_bytes().startswith(b"\x89PNG")
    (tmp_path / "mine.toml").write_text("[[cylinder]]\ncentre = [2, 0, 1]\nradius = 0.5\nheight = 2\n")
    assert main(["world", "show", "mine.toml", "--png", "plan.svg", "--height", "3"]) == 0
    assert "cut at z = 3 m" in (tmp_path / "plan.svg").read_text() or (tmp_path / "plan.svg").stat().st_size > 1000


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("show", "mars"), "world 'mars' is not known; it is one of circuit"),
        (("show", "absent.toml"), "world file 'absent.toml' cannot be read"),
        (("show", "circle", "--png", "no/such/folder.png"), "--png 'no/such/folder.png' cannot be written"),
        (("show", "circle", "--png", "plan.doc"), "--png 'plan.doc' cannot be written"),
    ],
)
def test_mistakes(arguments: tuple[str, ...], says: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["world", *arguments]) == 2
    error = capsys.readouterr().err
    assert says in error and len(error.splitlines()) == 1
