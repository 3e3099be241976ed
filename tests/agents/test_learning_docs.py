# SPDX-License-Identifier: BSD-3-Clause
"""The page docs/learning.md: its example runs, its commands are understood, its table names every setting."""

from __future__ import annotations

import argparse
import re
import shlex
from dataclasses import fields
from pathlib import Path

import agents.cli
from agents.tabular.settings import Settings

PAGE = (Path(__file__).parents[2] / "docs/learning.md").read_text()


def test_example_runs(capsys):
    (example,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    exec(compile(example, "docs/learning.md", "exec"), {})
    assert "states, last reward" in capsys.readouterr().out


def test_commands_are_understood():
    top = argparse.ArgumentParser()
    agents.cli.add_parser(top.add_subparsers(dest="command", required=True))
    lines = re.findall(r"^sitl (.*)$", PAGE, re.MULTILINE)
    for line in lines:
        assert callable(top.parse_args(shlex.split(line, comments=True)).function)
    assert len(lines) >= 7


def test_every_setting_is_explained():
    for field in fields(Settings):
        row = next(line for line in PAGE.splitlines() if line.startswith("| `") and f"`{field.name}`" in line)
        defaults = str(field.default).lower() if isinstance(field.default, bool) else str(field.default)
        assert defaults in row, field.name
