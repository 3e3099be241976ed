# SPDX-License-Identifier: BSD-3-Clause
"""The page docs/mental-rehearsal.md: its plan can be used, its example runs."""

from __future__ import annotations

import re
from dataclasses import fields
from pathlib import Path

from sitl.agents.rehearsal import plan as plans
from sitl.agents.rehearsal.change import GROUPS, Change
from sitl.agents.runs.training import train_one
from tests.agents.small_runs import new

PAGE = (Path(__file__).parents[2] / "docs/mental-rehearsal.md").read_text()


def test_the_plan_can_be_used(tmp_path):
    (text,) = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    (tmp_path / "plan.toml").write_text(text)
    plan = plans.load(tmp_path / "plan.toml")
    assert plan.changes[0].options == {"step_time": 0.2} and plan.randomise["draws"] == 24


def test_every_key_and_group_is_explained():
    for name in (*(field.name for field in fields(Change)), *GROUPS, *plans.names()):
        assert f"`{name}`" in PAGE, name


def test_the_example_runs(tmp_path, monkeypatch, capsys):
    new(tmp_path / "runs" / "circuit2")
    train_one(tmp_path / "runs" / "circuit2", lambda message: None, lambda: False)
    monkeypatch.chdir(tmp_path)
    (example,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    exec(compile(example, "docs/mental-rehearsal.md", "exec"), {})
    assert "late" in capsys.readouterr().out
