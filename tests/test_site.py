# SPDX-License-Identifier: BSD-3-Clause
"""The documentation site: each tutorial runs as it stands and prints what it says; the site builds without warnings.

In a tutorial, a block of a language and a file's name is that file; a block ``sh`` is typed in a shell; ``text``
is all that the block before printed, where a line "..." stands for any lines. Other blocks are not run.
"""

from __future__ import annotations

import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
TUTORIALS = sorted(page for page in (ROOT / "docs/tutorials").glob("*.md") if page.stem != "index")
BLOCK = re.compile(r"^```(\w+) ?(\S*)\n(.*?)^```$", re.M | re.S)
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
WALL = re.compile(r" in \d+\.\d+s\b.*")
"""How long pytest says that it took."""


def shell(folder: Path) -> dict[str, str]:
    """What a reader's shell has: this interpreter and its ``sitl`` first on the path."""
    commands = folder / "bin"
    commands.mkdir()
    for name, module in (("python", ""), ("sitl", " -m sitl")):
        (commands / name).write_text(f'#!/bin/sh\nexec "{sys.executable}"{module} "$@"\n')
        (commands / name).chmod(0o755)
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    return environment | {
        "PATH": os.pathsep.join((str(commands), os.environ["PATH"])),
        "PYTHONPATH": os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH", "")))),
        "ARDUPILOT": os.environ.get("SITL_ARDUPILOT", ""),
    }


def agree(line: str, printed: str) -> bool:
    """The same words, and numbers that are near: processors differ in last bits, and flights with them."""
    line, printed = WALL.sub("", line), WALL.sub("", printed)
    if NUMBER.sub("#", line.strip()) != NUMBER.sub("#", printed.strip()):
        return False
    return [float(n) for n in NUMBER.findall(printed)] == pytest.approx(
        [float(n) for n in NUMBER.findall(line)], rel=0.1, abs=0.3
    )


def matches(said: list[str], printed: list[str]) -> bool:
    """Whether all of ``printed`` is what the page says."""
    if not said:
        return not printed
    if said[0].strip() == "...":
        return any(matches(said[1:], printed[k:]) for k in range(len(printed) + 1))
    return bool(printed) and agree(said[0], printed[0]) and matches(said[1:], printed[1:])


@pytest.mark.slow
@pytest.mark.parametrize("page", TUTORIALS, ids=lambda page: page.stem)
def test_a_tutorial_runs_as_it_stands(page: Path, tmp_path: Path) -> None:
    environment, desk = shell(tmp_path), tmp_path / "desk"
    desk.mkdir()
    if page.stem == "real-ardupilot" and not environment["ARDUPILOT"]:
        pytest.skip("needs SITL_ARDUPILOT=FOLDER, with a real arducopter")
    printed: list[str] = []
    typed = 0
    for language, name, text in BLOCK.findall(page.read_text(encoding="utf-8")):
        if name:
            (desk / name).write_text(text)
        elif language == "sh":
            ran = subprocess.run(
                ["sh", "-e", "-c", text], cwd=desk, env=environment, capture_output=True, text=True, timeout=1800
            )
            assert ran.returncode == 0, f"{text}\n{ran.stdout[-2000:]}\n{ran.stderr[-3000:]}"
            printed = ran.stdout.rstrip().splitlines()
            typed += 1
        elif language == "text":
            assert matches(text.rstrip().splitlines(), printed), "\n".join(["printed:", *printed, "the page:", text])
    assert typed >= 1


def test_outputs_are_compared_by_their_words_and_numbers() -> None:
    assert matches(["10.0 m high", "...", "end"], ["10.2 m high", "a", "b", "end"])
    assert not matches(["10.0 m high"], ["12.0 m high"])
    assert not matches(["10.0 m high"], ["10.0 m low"])
    assert not matches(["10.0 m high"], ["10.0 m high", "more"])


@pytest.mark.slow
@pytest.mark.skipif(importlib.util.find_spec("pydata_sphinx_theme") is None, reason="needs the extra 'docs'")
def test_the_site_builds_without_warnings(tmp_path: Path) -> None:
    """Dead links, pages that no table of contents has and docstrings that cannot be read are warnings.

    SITL_SITE names the folder of a site that ``make docs`` has just built so.
    """
    site = Path(os.environ.get("SITL_SITE") or tmp_path / "site")
    pages_before = {*(ROOT / "docs").rglob("*.md")}
    if not os.environ.get("SITL_SITE"):
        ran = subprocess.run(
            [sys.executable, "-m", "sphinx", "-b", "html", "-d", tmp_path / "trees", "-n", "-W", "--keep-going", "-q",
             ROOT / "docs", site],
            capture_output=True, text=True, timeout=900, env=os.environ | {"PYTHONPATH": str(ROOT)},
        )  # fmt: skip
        assert ran.returncode == 0, ran.stderr[-3000:]
    assert {*(ROOT / "docs").rglob("*.md")} == pages_before, "a page beside the repository's: it would go into a wheel"
    assert "<td>WPNAV_SPEED" in re.sub(r"<p>|</p>", "", (site / "parameters-copter.html").read_text(encoding="utf-8"))
    pages = ("index", "tutorials/first-flight", "guides/index", "reference/python", "parameters-copter")
    for page in (*pages, "explanation/index", "search"):
        assert (site / f"{page}.html").exists(), page
    for page, scene in (("view", "calm-and-wind"), ("tutorials/first-flight", "first-flight")):
        shown = re.search(r'<iframe src="([^"]+)"', (site / f"{page}.html").read_text(encoding="utf-8"))
        assert shown is not None and Path(shown[1]).stem == scene
        file = (site / page).parent / shown[1]
        assert "__VISER_EMBED_DATA__" in file.read_text(encoding="utf-8"), "a scene that the page itself plays"
