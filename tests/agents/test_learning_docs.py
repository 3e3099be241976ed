# SPDX-License-Identifier: BSD-3-Clause
"""The pages of learning: commands are understood; the example of docs/learning.md runs, its table has every setting."""

from __future__ import annotations

import argparse
import re
import shlex
from dataclasses import fields
from pathlib import Path

import pytest

from sitl.agents import cli as agents_cli
from sitl.agents.tabular.settings import Settings

DOCS = Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "learning.md").read_text()


def test_example_runs(capsys):
    (example,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    exec(compile(example, "docs/learning.md", "exec"), {})
    assert "states, last reward" in capsys.readouterr().out


@pytest.mark.parametrize(("page", "least"), [("learning", 7), ("mental-rehearsal", 7), ("results", 3)])
def test_commands_are_understood(page, least):
    top = argparse.ArgumentParser()
    agents_cli.add_parser(top.add_subparsers(dest="command", required=True))
    lines = re.findall(r"^sitl (.*)$|`sitl ([^`]*)`", (DOCS / f"{page}.md").read_text(), re.MULTILINE)
    whole = [line for pair in lines for line in pair if " --" in line]
    for line in whole:
        words = shlex.split(line.replace("--seed K", "--seed 0"), comments=True)
        assert callable(top.parse_args(words).function)
    assert len(whole) >= least


def test_every_setting_is_explained():
    for field in fields(Settings):
        row = next(line for line in PAGE.splitlines() if line.startswith("| `") and f"`{field.name}`" in line)
        defaults = str(field.default).lower() if isinstance(field.default, bool) else str(field.default)
        assert defaults in row, field.name
