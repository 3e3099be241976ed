# SPDX-License-Identifier: BSD-3-Clause
"""What the documentation shows runs, and what it names exists."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from sitl.autopilot.params import docs
from sitl.cli import parser
from sitl.core import compile as compiler
from sitl.simulation import Core
from sitl.vehicle.kinds import KINDS

ROOT = Path(__file__).parents[1]
PAGES = sorted([ROOT / "README.md", *(ROOT / "docs").glob("*.md")])


def blocks(page: Path, language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", page.read_text(), re.DOTALL)


def test_the_python_of_the_readme_runs(core: Core, capsys: pytest.CaptureFixture[str]) -> None:
    flight, learning = blocks(ROOT / "README.md", "python")
    exec(compile(learning, "README.md", "exec"), {})
    rewards = [float(line.split()[-1]) for line in capsys.readouterr().out.splitlines()]
    assert len(rewards) == 500 and sum(rewards[-100:]) > sum(rewards[:100]) + 100 * 100.0
    scope: dict[str, object] = {}
    exec(compile(flight, "README.md", "exec"), scope)
    printed = capsys.readouterr().out
    assert printed.startswith(("30.", "29."))
    vehicle = scope["vehicle"]
    assert vehicle.position == pytest.approx((30.0, 10.0, 10.0), abs=1.1)  # type: ignore[attr-defined]


def test_the_commands_of_the_readme_are_understood() -> None:
    text = "\n".join(blocks(ROOT / "README.md", ""))
    lines = [line for line in text.splitlines() if line.startswith("sitl ")]
    assert len(lines) > 4
    for line in lines:
        words = line.split("#")[0].split()[1:]
        parser().parse_args(words)


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.name)
def test_links_lead_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\(([^)#]+)\)", page.read_text()):
        if "://" not in target:
            assert (page.parent / target).exists(), f"{page.name}: {target}"


@pytest.mark.parametrize("name", KINDS)
def test_the_parameter_pages_are_up_to_date(name: str) -> None:
    page = docs.page(name, KINDS[name].firmware.table)
    assert (ROOT / "docs" / f"parameters-{name}.md").read_text() == page, "run: python docs/make_pages.py"


@pytest.mark.parametrize("name", KINDS)
def test_the_units_of_a_core_are_few_and_named_after_their_place(name: str) -> None:
    assert [unit.name for unit in compiler.reached(KINDS[name].advance)] == [
        f"physics.native.{name}.step.step",
        "autopilot.estimation.update.step",
        "autopilot.estimation.update.update",
        f"autopilot.{name}.modes.update.update",
        f"autopilot.{name}.control.update.update",
        f"vehicle.{name}.advance",
    ]
