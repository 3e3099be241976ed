# SPDX-License-Identifier: BSD-3-Clause
"""--view of the commands that have it: each says where its page is, and does what it does without."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from sitl.cli import main
from sitl.cli.view_options import open_browser
from tests.platforms import on_linux

pytest.importorskip("viser", reason="the page needs viser: pip install 'gym-sitl[view]'")
QUIET = ("--out", "none", "--tcp", "0", "--quiet")


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize(
    "words",
    [
        ["run", "copter", "--view", "--duration", "1", "--speedup", "max", *QUIET],
        ["run", "copter", "--view-only", "--duration", "1", "--speedup", "max", *QUIET],
        ["run", "rover", "--count", "2", "--view", "--duration", "1", "--speedup", "max", *QUIET],
        pytest.param(["exec", "--view", "--duration", "5", *QUIET, "--", sys.executable, "-c", "pass"], marks=on_linux),
        ["mission", "fly", "copter/square", "--view", "--speedup", "max", "--quiet"],
    ],
    ids=["run", "view-only", "count", "exec", "mission"],
)
def test_a_page_is_said(capsys: pytest.CaptureFixture[str], words: list[str]) -> None:
    assert main(words) == 0
    assert "page: http://127.0.0.1:" in capsys.readouterr().out


@pytest.mark.parametrize("words", [["demo", "copter"], ["mission", "fly", "copter/survey"], ["physics", "copter"]])
def test_options_that_cannot_be_are_refused_first(capsys: pytest.CaptureFixture[str], words: list[str]) -> None:
    assert main([*words, "--view", "--view-token", "a-token-of-some-length"]) == 2
    assert "go together" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("system", "display", "opened"),
    [("linux", "", []), ("linux", ":0", ["http://127.0.0.1:9"]), ("darwin", "", ["http://127.0.0.1:9"])],
)
def test_the_page_opens_in_a_browser_where_one_can_be_seen(
    monkeypatch: pytest.MonkeyPatch, system: str, display: str, opened: list[str]
) -> None:
    found: list[str] = []
    monkeypatch.setattr("sys.platform", system)
    monkeypatch.setenv("DISPLAY", display)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.setattr("webbrowser.open", found.append)
    open_browser("http://127.0.0.1:9")
    assert found == opened
