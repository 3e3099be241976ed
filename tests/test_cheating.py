# SPDX-License-Identifier: BSD-3-Clause
"""Nothing pays that should not: the table of ``python -m benchmarks.cheating``, row by row."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.cheating import __main__ as command
from benchmarks.cheating.table import Played, Row, row
from sitl.envs.ids import NEW

FAST = ("sitl/RoverWaypointDiscrete-v1", "sitl/CopterReachGoal-v1")


def episodes(*returns, success=False, early=False):
    count = len(returns)
    flags = np.full(count, success), np.full(count, early)
    return Played(np.array(returns, float), *flags, np.full(count, 10))


def made(**cheats):
    return Row("sitl/X-v1", episodes(20.0, 18.0, success=True), episodes(-5.0, -5.0), cheats)


def test_a_row_tells_what_pays():
    assert made(crash=episodes(-30.0, early=True), out=episodes(-20.0, early=True)).faults == []
    assert made(near=episodes(8.0, 9.0)).faults == ["near: 0.56 of the baseline's score"]
    assert made(crash=episodes(-4.0, -30.0, early=True)).faults == ["an early end: -4.0, the time limit -5.0"]
    assert Row("sitl/X-v1", episodes(4.0), episodes(3.0), {}).faults == ["nothing: 3.0, more than half of 4.0"]
    assert Row("sitl/X-v1", episodes(-6.0), episodes(-5.0), {}).faults == ["nothing: -5.0, the baseline -6.0"]


def test_only_episodes_that_failed_hide_behind_the_estimate():
    both = Played(np.array([30.0, -5.0]), np.array([True, False]), np.zeros(2, np.bool_), np.array([10, 10]))
    assert both.failed().returns.tolist() == [-5.0]


@pytest.mark.parametrize("name", FAST)
def test_nothing_pays_that_should_not(name):
    assert row(name, 4).faults == []


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(set(NEW) - set(FAST)))
def test_nothing_pays_that_should_not_on_any_id(name):
    assert row(name, 6).faults == []


def test_the_command_prints_a_row_and_refuses_other_ids(monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["cheating", "RoverReachGoalDiscrete-v1", "--episodes", "2"])
    assert command.main() == 0
    assert "| `RoverReachGoalDiscrete-v1` |" in capsys.readouterr().out
    monkeypatch.setattr("sys.argv", ["cheating", "CopterHover-v0"])
    with pytest.raises(SystemExit):
        command.main()
    assert "'sitl/CopterHover-v0' is none of the ids -v1" in capsys.readouterr().err
