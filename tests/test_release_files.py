# SPDX-License-Identifier: BSD-3-Clause
"""What installs the package elsewhere: the release script, the image, the action, the recipe for conda."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import tomllib
from pathlib import Path
from typing import Any

import pytest

from sitl.cli import parser

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
SCRIPTS = (".ci/run", ".ci/release")
WORKPLACE = (
    *sorted(str(p.relative_to(ROOT)) for p in (ROOT / ".github").rglob("*.yml")),
    ".pre-commit-config.yaml",
    "CITATION.cff",
)
"""What a host of repositories reads."""


def read_yaml(path: str) -> Any:
    return pytest.importorskip("yaml").safe_load((ROOT / path).read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", SCRIPTS)
def test_the_scripts_are_whole_and_can_be_run(name: str) -> None:
    assert os.access(ROOT / name, os.X_OK)
    subprocess.run(["bash", "-n", name], cwd=ROOT, check=True)


SITE = "tests/test_site.py::test_the_site_builds_without_warnings"
STUB = '#!/bin/sh\nname=${0##*/}\n[ "$name" = pip ] || { printf "%s|" "$name" "$@"; echo; } >> "$WORDS"\n'


@pytest.mark.parametrize(
    ("part", "words"),
    [
        ((), ["make|lint|", "sitl|cache|ship|--here|--folder|build/core|", "make|test|WORKERS=4|TESTS=|"]),
        (("lint",), ["make|lint|", f"python|-m|pytest|{SITE}|"]),
        (("fast",), ["sitl|cache|ship|--here|--folder|build/core|", 'make|test|WORKERS=4|TESTS=-m "not slow"|']),
        (("slow",), ["sitl|cache|ship|--here|--folder|build/core|",
                     f"make|test|WORKERS=4|TESTS=-m slow --deselect {SITE}|"]),
    ],
)  # fmt: skip
def test_parts_of_continuous_integration_do_together_what_it_does(
    part: tuple[str, ...], words: list[str], tmp_path: Path
) -> None:
    for name in ("make", "chromium", ".venv/bin/python", ".venv/bin/pip", ".venv/bin/sitl"):
        program = tmp_path / name
        program.parent.mkdir(parents=True, exist_ok=True)
        program.write_text(STUB)
        program.chmod(0o755)
    (tmp_path / ".ci").mkdir()
    shutil.copy(ROOT / ".ci/run", tmp_path / ".ci/run")
    environment = {**os.environ, "PATH": f"{tmp_path}:{os.environ['PATH']}", "WORDS": str(tmp_path / "words")}
    subprocess.run(["bash", ".ci/run", *part], cwd=tmp_path, env=environment, check=True)
    assert (tmp_path / "words").read_text().splitlines() == ["make|.venv/docs.stamp|", *words]


def test_a_part_that_continuous_integration_does_not_have_is_refused() -> None:
    done = subprocess.run(["bash", ".ci/run", "quick"], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 2 and "quick: a part is lint, fast or slow" in done.stderr


def test_the_workflow_runs_every_part() -> None:
    matrix = read_yaml(".github/workflows/ci.yml")["jobs"]["checks"]["strategy"]["matrix"]
    assert (
        matrix["part"] == ["lint", "fast", "slow"] and SITE.split("::")[1] in (ROOT / "tests/test_site.py").read_text()
    )


def test_the_commands_of_the_release_are_understood() -> None:
    lines = re.findall(r"^clean sitl (.+)$", (ROOT / ".ci/release").read_text(), re.M)
    assert len(lines) >= 6
    for line in lines:
        if line != "--version":
            assert callable(parser().parse_args(line.split()).function), line


def test_the_recipe_for_conda_needs_what_the_package_needs() -> None:
    recipe = (ROOT / "conda/meta.yaml").read_text()
    run = recipe.split("  run:\n")[1].split("test:")[0]
    assert set(re.findall(r"- (\S+ >=\S+)", run)) - {"python >=3.11"} == {
        re.sub(r"\s*>=", " >=", need) for need in PROJECT["dependencies"]
    }
    assert set(re.findall(r"- (\w+ = \S+)", recipe)) == {f"{k} = {v}" for k, v in PROJECT["scripts"].items()}


def test_the_image_is_small_and_has_no_root() -> None:
    text = (ROOT / "Dockerfile").read_text()
    last = text.rindex("FROM ")
    assert "-slim" in text[last:] and text.index("\nUSER pilot") > last
    extra = re.search(r"ARG EXTRAS=(\S+)", text)
    assert extra is not None and extra[1] in PROJECT["optional-dependencies"]
    for source in re.findall(r"^COPY (.+) \S+$", text, re.M):
        assert all((ROOT / name).exists() for name in source.split() if not name.startswith("--")), source


def test_the_release_workflow_runs_the_release_script_and_publishes_nothing() -> None:
    job = read_yaml(".github/workflows/release.yml")["jobs"]["check"]
    steps = job["steps"]
    assert any(step.get("run") == "bash .ci/release" for step in steps)
    assert not any("publish" in str(step) for step in steps)


def fly(folder: Path, **variables: str) -> subprocess.CompletedProcess[str]:
    """The action's step Fly, with a ``sitl`` that notes its words."""
    (step,) = (one for one in read_yaml("action.yml")["runs"]["steps"] if one.get("name") == "Fly")
    (folder / "sitl").write_text('#!/bin/sh\nprintf "%s|" "$@" >> words; echo >> words\n')
    (folder / "sitl").chmod(0o755)
    inputs = dict.fromkeys(("COMMAND", "OPTIONS", "MISSIONS"), "")
    given = inputs | {"VEHICLE": "copter", "SPEEDUP": "20", "REPORTS": "out"} | variables
    assert set(given) | {"SITL_CACHE_DIR"} == set(step["env"])
    environment = given | {"PATH": f"{folder}:{os.environ['PATH']}"}
    return subprocess.run(
        ["bash", "-e", "-o", "pipefail", "-c", step["run"]], cwd=folder, env=environment, capture_output=True, text=True
    )


def test_the_action_flies_a_script_and_missions(tmp_path: Path) -> None:
    done = fly(tmp_path, COMMAND="python fly.py tcp:127.0.0.1:{tcp}", OPTIONS="--seed 3", MISSIONS="flights")
    assert done.returncode == 0, done.stderr
    script, suite = (line.rstrip("|").split("|") for line in (tmp_path / "words").read_text().splitlines())
    options = parser().parse_args(script)
    assert options.script == ["--", "python", "fly.py", "tcp:127.0.0.1:{tcp}"] and options.seed == 3
    assert str(parser().parse_args(suite).report) == "out/missions"


def test_the_action_without_work_is_a_mistake(tmp_path: Path) -> None:
    done = fly(tmp_path)
    assert done.returncode == 2 and "::error::" in done.stdout


def test_the_action_uses_inputs_that_it_has_and_extras_that_there_are() -> None:
    action = read_yaml("action.yml")
    used = set(re.findall(r"inputs\.([\w-]+)", (ROOT / "action.yml").read_text()))
    assert used == set(action["inputs"])
    assert set(action["inputs"]["extras"]["default"].split(",")) <= set(PROJECT["optional-dependencies"])


@pytest.mark.parametrize("path", WORKPLACE)
def test_the_files_of_the_workplace_can_be_read(path: str) -> None:
    assert read_yaml(path)


def test_the_hooks_of_a_commit_are_what_lint_runs() -> None:
    (lint,) = re.findall(r"^lint:.*\n((?:\t.+\n)+)", (ROOT / "Makefile").read_text(), re.M)
    (local,) = read_yaml(".pre-commit-config.yaml")["repos"]
    hooks = [hook["entry"].removeprefix(".venv/bin/").removesuffix(" --force-exclude") for hook in local["hooks"]]
    assert hooks == [line.strip().removeprefix("$(BIN)/").removesuffix(" .") for line in lint.splitlines()]
