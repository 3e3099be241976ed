# SPDX-License-Identifier: BSD-3-Clause
"""The examples that train run in a short form, and say what they found."""

from __future__ import annotations

import importlib
import math
import re
import sys

import numpy as np
import pytest

pytestmark = pytest.mark.slow


def said(name, steps, monkeypatch, capsys):
    """What an example prints."""
    example = importlib.import_module(f"sitl.examples.{name}")
    monkeypatch.setattr(sys, "argv", [name, "--steps", str(steps)])
    example.main()
    return capsys.readouterr().out


def test_both_critics_learn(monkeypatch, capsys):
    pytest.importorskip("torch", reason="needs torch")
    text = said("privileged_critic", 20_000, monkeypatch, capsys)
    found = re.findall(r"^critic (.+): return (\S+), explains (\S+) of the variance$", text, re.M)
    assert [name for name, *_ in found] == ["sees what the actor sees", "sees the truth"]
    for _, total, explained in found:
        assert -15.0 < float(total) < 20.0 and 0.1 < float(explained) <= 1.0


def test_the_part_of_the_example_is_the_true_way_to_the_goal():
    pytest.importorskip("torch", reason="needs torch")
    import gymnasium as gym

    from sitl.examples.privileged_critic import TrueGoal

    env = gym.make("sitl/CopterHover-v1", observation=[TrueGoal(), "goal"])
    env.reset(seed=1)
    row, *_, info = env.step(np.zeros(4, np.float32))
    session = env.unwrapped.session
    way = session.task.targets[0] - session.robot.true_state()[0, :3]
    assert np.linalg.norm(row[:3]) == pytest.approx(math.hypot(*way), abs=1e-3)
    assert np.linalg.norm(row[:3] - row[3:]) == pytest.approx(np.linalg.norm(info["estimate_error"][:3]), abs=0.05)
    env.close()


def test_sticks_of_loiter_are_learnt(monkeypatch, capsys):
    pytest.importorskip("stable_baselines3", reason="needs the extra 'rl'")
    text = said("loiter_sticks", 8192, monkeypatch, capsys)
    found = dict(re.findall(r"^(.+): reaches (\d+) of 32, in .+, return \S+$", text, re.M))
    assert int(found["centred sticks"]) == 0, "the position is held"
    assert int(found["by rule"]) > 24, "sticks move it to the goal"
    assert 0 <= int(found["learnt"]) <= 32


def test_the_residual_begins_as_the_controller(monkeypatch, capsys):
    pytest.importorskip("stable_baselines3", reason="needs the extra 'rl'")
    text = said("residual_rates", 8192, monkeypatch, capsys)
    alone, learnt = re.findall(r"return (\S+), (\S+) m from the goal, (\S+) m by the estimate", text)
    assert 0.3 < float(alone[1]) < 2.0, "the controller flies, and stays beside the goal"
    assert float(learnt[0]) > 0.8 * float(alone[0])
