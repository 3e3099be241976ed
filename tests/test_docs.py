# SPDX-License-Identifier: BSD-3-Clause
"""What the documentation shows runs, and what it names exists."""

from __future__ import annotations

import importlib.util
import json
import math
import os
import re
import shlex
import subprocess
import sys
from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest

from sitl import envs
from sitl.agents import recipes
from sitl.agents.rehearsal import plan as plans
from sitl.agents.rehearsal.change import GROUPS, Change
from sitl.agents.runs.training import train_one
from sitl.agents.tabular.settings import Settings
from sitl.autopilot.params import docs
from sitl.bridge.links.faults import OPTIONS
from sitl.cli import parser
from sitl.cli.command_list import COMMANDS
from sitl.core import compile as compiler
from sitl.envs.costs import COSTS
from sitl.envs.observations import OBSERVATIONS
from sitl.envs.tasks import TASKS
from sitl.simulation import Core
from sitl.vehicle.faults import EFFECTS, Failure
from sitl.vehicle.kinds import KINDS
from tests.agents.small_runs import new

ROOT = Path(__file__).parents[1]
BLOCK = re.compile(r"^```python ?(\S*)\n(.*?)^```$", re.M | re.S)
"""A file's name, if there is one, and Python."""
TOP = ("README.md", "CONTRIBUTING.md", "SECURITY.md", "CODE_OF_CONDUCT.md")
PAGES = sorted([*(ROOT / name for name in TOP), *(ROOT / "docs").glob("*.md")])


def blocks(page: Path, language: str) -> list[str]:
    """Those without a file's name."""
    fenced = re.findall(r"^```(\w*) ?(\S*)\n(.*?)^```$", page.read_text(), re.DOTALL | re.MULTILINE)
    return [text for name, file, text in fenced if name == language and not file]


def test_the_python_of_the_readme_runs(core: Core, capsys: pytest.CaptureFixture[str]) -> None:
    flight, learning = blocks(ROOT / "README.md", "python")
    scope: dict[str, Any] = {}
    exec(compile(flight, "README.md", "exec"), scope)
    assert re.search(r"(29|30)\.\d m north", capsys.readouterr().out)
    vehicle = scope["vehicle"]
    assert vehicle.position == pytest.approx((30.0, 10.0, 10.0), abs=1.1)
    exec(compile(learning, "README.md", "exec"), scope)
    assert scope["done"] and scope["env"].observation_space.contains(scope["observation"])


def test_the_test_of_the_readme_passes(core: Core, tmp_path: Path) -> None:
    (name, text), *others = BLOCK.findall((ROOT / "README.md").read_text(encoding="utf-8"))
    assert name == "test_flight.py" and not any(file for file, _ in others)
    (tmp_path / name).write_text(text)
    ran = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", name], cwd=tmp_path, capture_output=True,
        text=True, timeout=600, env=os.environ | {"PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    assert ran.returncode == 0 and "1 passed" in ran.stdout, ran.stdout[-3000:]


def test_the_examples_of_faults_run_and_every_fault_and_option_is_explained(core: Core) -> None:
    page = ROOT / "docs/faults.md"
    on_demand, links = blocks(page, "python")
    scope: dict[str, Any] = {}
    exec(compile(on_demand, str(page), "exec"), scope)
    assert scope["vehicle"].mode == "LAND"
    exec(compile(links, str(page), "exec"), scope)
    assert not scope["vehicle"].armed
    for name in OPTIONS:
        assert f"`--link-{name} " in page.read_text()
    for effect in EFFECTS:
        assert effect.does in page.read_text() and f"`{effect.unit}" in page.read_text()
    for line in "".join(blocks(page, "")[:2]).splitlines():
        words = shlex.split(line.split(" -- ")[0])
        options = parser().parse_args(words[1:] if words[0] == "sitl" else words)
        for fault in getattr(options, "fail", ()):
            Failure.of_text(fault).checked(KINDS["copter"].firmware.table)


def test_the_examples_of_the_page_run(capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("viser", reason="the page needs viser: pip install 'gym-sitl[view]'")
    for example in blocks(ROOT / "docs/view.md", "python"):
        exec(compile(example, "docs/view.md", "exec"), {})
    assert "http://127.0.0.1:" in capsys.readouterr().out


def test_the_example_of_fleets_runs(core: Core) -> None:
    example, moves = blocks(ROOT / "docs/fleets.md", "python")
    scope: dict[str, Any] = {}
    exec(compile(example, "docs/fleets.md", "exec"), scope)
    ways = [math.atan2(*reversed(scope["fleet"].view(k).physics.body.pos[:2])) % math.tau for k in range(16)]
    assert ways[1:] == pytest.approx([math.tau * k / 16 for k in range(1, 16)], abs=0.05)
    exec(compile(moves, "docs/fleets.md", "exec"), scope)
    places = [scope["fleet"].view(k).physics.body.pos.x for k in range(4)]
    assert places == pytest.approx([0.0, 20.0, 40.0, 60.0], abs=0.5)


def test_the_example_of_swarms_runs(core: Core, capsys: pytest.CaptureFixture[str]) -> None:
    example, *_ = blocks(ROOT / "docs/swarm.md", "python")
    exec(compile(example, "docs/swarm.md", "exec"), {})
    found = re.findall(r"vehicle (\d): north (.+) m, east (.+) m, (.+) m high", capsys.readouterr().out)
    assert [int(number) for number, *_ in found] == [1, 2, 3]
    assert [float(height) for *_, height in found] == pytest.approx([4.0, 6.0, 0.0], abs=0.7)
    assert float(found[1][1]) == pytest.approx(20.0, abs=1.5)


def test_the_example_of_precision_landing_runs(core: Core, capsys: pytest.CaptureFixture[str]) -> None:
    (example,) = blocks(ROOT / "docs/precision-landing.md", "python")
    exec(compile(example, "docs/precision-landing.md", "exec"), {})
    landed = re.fullmatch(r"landed (.+) m north, (.+) m east\n", capsys.readouterr().out)
    assert landed is not None and [float(x) for x in landed.groups()] == pytest.approx([3.0, 1.0], abs=0.4)


def test_the_example_of_terrain_runs(core: Core, capsys: pytest.CaptureFixture[str]) -> None:
    (example,) = blocks(ROOT / "docs/terrain.md", "python")
    exec(compile(example, "docs/terrain.md", "exec"), {})
    assert capsys.readouterr().out == "49 m above home\n"


def test_the_example_of_avoidance_stops_before_the_wall(core: Core) -> None:
    (example,) = blocks(ROOT / "docs/avoidance.md", "python")
    scope: dict[str, Any] = {}
    exec(compile(example, "docs/avoidance.md", "exec"), scope)
    pilot = scope["pilot"]
    assert math.hypot(*pilot.position[:2]) > 5.0 and pilot.altitude > 0.5, "it moved, and kept its height"
    assert pilot.simulation.v.physics.obstacles.hit_count == 0


def test_no_page_has_a_place_holder() -> None:
    for page in (ROOT / "README.md", *(ROOT / "docs").rglob("*.md")):
        assert not re.search(r"\| @[A-Z]+ \|", page.read_text(encoding="utf-8")), page


def test_the_commands_of_the_readme_are_understood() -> None:
    text = "\n".join(blocks(ROOT / "README.md", ""))
    lines = [line for line in text.splitlines() if line.startswith("sitl ")]
    assert len(lines) > 4
    for line in lines:
        words = line.split("#")[0].split()[1:]
        parser().parse_args(words)


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.name)
def test_recipes_are_trained_in_their_environments(page: Path) -> None:
    for command in re.findall(r"^(?:\$ )?sitl (train .*--recipe .*)$", page.read_text(), re.MULTILINE):
        told = parser().parse_args(shlex.split(command, comments=True))
        if not told.recipe.endswith(".toml"):
            recipe = recipes.load(told.recipe)
            assert told.env in (None, recipe.env, *recipe.also), command


def test_every_command_is_on_the_page_of_the_command_line() -> None:
    page = (ROOT / "docs" / "command-line.md").read_text()
    table = " ".join(line.split("|")[1] for line in page.splitlines() if line.startswith("| `"))
    assert set(COMMANDS) == set(re.findall(r"`(?:sitl )?([a-z]+)`", table))


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.name)
def test_links_lead_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\(([^)#]+)\)", page.read_text()):
        if "://" not in target:
            assert (page.parent / target).exists(), f"{page.name}: {target}"


@pytest.mark.parametrize("name", KINDS)
def test_the_page_of_parameters_has_each_of_them_once(name: str) -> None:
    table = KINDS[name].firmware.table
    rows = re.findall(r"^\| ([A-Z][A-Z0-9_]*) \|", docs.page(name, table), re.M)
    assert sorted(rows) == sorted(p.name for p in table)


@pytest.mark.parametrize("name", KINDS)
def test_the_units_of_a_core_are_few_and_named_after_their_place(name: str) -> None:
    assert [unit.name for unit in compiler.reached(KINDS[name].advance)] == [
        f"physics.native.{name}.step.step",
        "autopilot.estimation.update.prepare_lanes",
        "autopilot.estimation.update.choose_sensors",
        "autopilot.estimation.update.step_bank",
        "autopilot.estimation.update.step",
        "autopilot.estimation.update.advance_bank",
        "autopilot.estimation.update.run_second",
        "autopilot.estimation.update.update",
        f"autopilot.{name}.modes.decisions.update",
        f"autopilot.{name}.control.control_step.update",
        f"vehicle.{name}.advance",
    ]


EXTENDING = (ROOT / "docs/extending.md").read_text(encoding="utf-8")
EXTENSIONS = {
    title: found
    for title, text in (section.split("\n", 1) for section in EXTENDING.split("\n## ")[1:])
    if (found := BLOCK.findall(text))
}
ONE_CORE = ("A mode", "A fault")
"""They compile a core of their own, which takes minutes: it is one for both."""
TOGETHER = """
import json, sys
scopes = [{}, {}]
for k, text in json.load(sys.stdin):
    exec(compile(text, f"example {k}", "exec"), scopes[k])
"""


def run_in(folder: Path, program: str, given: str = "", **environment: str) -> None:
    """Run a program where an example's files are; fails when it does."""
    own = {k: v for k, v in os.environ.items() if not k.startswith(("SITL_M", "SITL_EVENTS", "SITL_PARAM"))}
    own["PYTHONPATH"] = os.pathsep.join((str(folder), str(ROOT)))
    ran = subprocess.run(
        [sys.executable, "-c", program], cwd=folder, env=own | environment, input=given, capture_output=True,
        text=True, timeout=3600,
    )  # fmt: skip
    assert ran.returncode == 0, ran.stderr[-3000:]


def example(title: str, folder: Path) -> str:
    """The program of an example, whose files are put into a folder."""
    *files, (name, program) = EXTENSIONS[title]
    assert not name, "the last block is the program"
    for file, text in files:
        (folder / file).write_text(text)
    return program


@pytest.mark.parametrize("title", [title for title in EXTENSIONS if title not in ONE_CORE], ids=lambda t: t)
def test_an_example_of_extending_does_what_it_says(title: str, tmp_path: Path) -> None:
    # The one of a parameter flies nothing: that a core with other parameters compiles is seen with the ones below.
    plain = {"NUMBA_DISABLE_JIT": "1"} if title == "A parameter" else {}
    run_in(tmp_path, example(title, tmp_path), **plain)


@pytest.mark.slow
def test_the_examples_that_compile_a_core_do_what_they_say(tmp_path: Path) -> None:
    """Both register their parts, then each runs."""
    parts = [re.split(r"(?<=\))\n\n", example(title, tmp_path), maxsplit=1) for title in ONE_CORE]
    assert all("register_parameters(" in head and "Simulation(" not in head for head, _ in parts)
    order = [(k, parts[k][half]) for half in (0, 1) for k in range(len(parts))]
    run_in(tmp_path, TOGETHER, json.dumps(order))


def test_every_way_in_has_an_example_or_a_test() -> None:
    rows = [line.split("|")[1].strip() for line in EXTENDING.splitlines() if line.startswith("| a ")]
    assert len(rows) == 9
    assert set(EXTENSIONS) == {
        "A mode", "A parameter", "A message that is sent", "A message that is taken", "A fault", "A physics engine",
        "A task of environments",
    }  # fmt: skip
    assert (ROOT / "tests/vehicle/test_kinds.py").exists()


@pytest.mark.parametrize("page", ["CONTRIBUTING.md", "docs/extending.md"])
def test_what_contributors_are_told_to_touch_and_to_run_is_there(page: str) -> None:
    text = (ROOT / page).read_text(encoding="utf-8")
    places = [ROOT / word for word in re.findall(r"`((?:sitl|tests|docs)/[\w/.]*)`", text) if "NAME" not in word]
    assert len(places) > 5
    for place in places:
        assert place.exists(), place
    for module in re.findall(r"python -m ([\w.]+)", text):
        assert importlib.util.find_spec(module), module
    for script in re.findall(r"python (docs/\w+\.py)", text):
        assert (ROOT / script).exists(), script
    targets = re.findall(r"^([\w-]+):", (ROOT / "Makefile").read_text(), re.M)
    assert set(re.findall(r"(?:^|`)make ([\w-]+)", text, re.M)) <= set(targets)


def test_lists_that_a_new_part_joins_are_where_extending_says() -> None:
    lists = re.findall(r"`([A-Z_]{5,})` of `([\w/.]+\.py)`", EXTENDING)
    assert len(lists) >= 5
    for name, place in lists:
        file = ROOT / place if "/" in place else ROOT / "sitl/bridge/telemetry" / place
        assert re.search(rf"^{name}\b.*=", file.read_text(encoding="utf-8"), re.M), (name, place)


DOCS = ROOT / "docs"
LEARNING = (DOCS / "learning.md").read_text()


def test_the_example_of_learning_runs(capsys):
    (example,) = re.findall(r"```python\n(.*?)```", LEARNING, re.DOTALL)
    exec(compile(example, "docs/learning.md", "exec"), {})
    assert "states, last reward" in capsys.readouterr().out


@pytest.mark.parametrize(("page", "least"), [("learning", 7), ("mental-rehearsal", 7), ("results", 3)])
def test_the_commands_of_learning_are_understood(page, least):
    top = parser()
    lines = re.findall(r"^sitl (.*)$|`sitl ([^`]*)`", (DOCS / f"{page}.md").read_text(), re.MULTILINE)
    whole = [line for pair in lines for line in pair if " --" in line]
    for line in whole:
        words = shlex.split(line.replace("--seed K", "--seed 0"), comments=True)
        assert callable(top.parse_args(words).function)
    assert len(whole) >= least


def test_every_setting_of_learning_is_explained():
    for field in fields(Settings):
        row = next(line for line in LEARNING.splitlines() if line.startswith("| `") and f"`{field.name}`" in line)
        defaults = str(field.default).lower() if isinstance(field.default, bool) else str(field.default)
        assert defaults in row, field.name


REHEARSAL = (ROOT / "docs/mental-rehearsal.md").read_text()


def test_the_plan_of_rehearsals_can_be_used(tmp_path):
    (text,) = re.findall(r"```toml\n(.*?)```", REHEARSAL, re.DOTALL)
    (tmp_path / "plan.toml").write_text(text)
    plan = plans.load(tmp_path / "plan.toml")
    assert plan.changes[0].options == {"step_time": 0.2} and plan.randomise["draws"] == 24


def test_every_key_and_group_of_rehearsals_is_explained():
    for name in (*(field.name for field in fields(Change)), *GROUPS, *plans.names()):
        assert f"`{name}`" in REHEARSAL, name


def test_the_example_of_rehearsals_runs(tmp_path, monkeypatch, capsys):
    new(tmp_path / "runs" / "circuit2")
    train_one(tmp_path / "runs" / "circuit2", lambda message: None, lambda: False)
    monkeypatch.chdir(tmp_path)
    (example,) = re.findall(r"```python\n(.*?)```", REHEARSAL, re.DOTALL)
    exec(compile(example, "docs/mental-rehearsal.md", "exec"), {})
    assert "late" in capsys.readouterr().out


ENVIRONMENTS = (ROOT / "docs/environments.md").read_text()
ENVIRONMENT_EXAMPLES = re.findall(r"```python\n(.*?)```", ENVIRONMENTS, re.DOTALL)


@pytest.mark.parametrize("example", ENVIRONMENT_EXAMPLES, ids=range(len(ENVIRONMENT_EXAMPLES)))
def test_the_examples_of_environments_run(example):
    if "stable_baselines3" in example:
        pytest.importorskip("stable_baselines3", reason="this example needs the extra 'rl'")
    exec(compile(example, "docs/environments.md", "exec"), {})


SETUPS = DOCS / "learning-setups.md"


@pytest.mark.parametrize("example", blocks(SETUPS, "python"), ids=lambda text: text.split('"')[1])
def test_the_examples_of_learning_setups_run(example, capsys):
    exec(compile(example, str(SETUPS), "exec"), {})
    if "session.observation.columns" in example:
        assert capsys.readouterr().out == "the last reading arrived [0, 1]\n"


def test_each_cost_is_on_the_page():
    page = SETUPS.read_text(encoding="utf-8")
    for name in COSTS:
        assert f"\n| `{name}` |" in page, name


def test_the_page_of_environments_names_every_one_and_every_piece():
    for name in (*envs.PAPER, *(f'"{n}"' for n in (*OBSERVATIONS, *TASKS))):
        assert name in ENVIRONMENTS, name
