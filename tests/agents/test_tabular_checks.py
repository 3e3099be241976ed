# SPDX-License-Identifier: BSD-3-Clause
"""Which table of a run is kept as the best one."""

from __future__ import annotations

import pytest

from sitl.agents.errors import AgentError
from sitl.agents.runs.files import read_arrays
from sitl.agents.tabular.learner import Outcome
from sitl.agents.tabular.settings import Settings
from sitl.agents.tabular.training import Checks
from tests.agents.small_runs import learner_for, make


def checks_by(check_by, path):
    env = make()
    return Checks(env, learner_for(env, settings=Settings(check_every=1, check_episodes=2, check_by=check_by)), path)


TABLES = {"slow": [(60.0, False), (80.0, False)], "fast": [(300.0, False), (200.0, True)], "safe": [(90.0, False)] * 2}
"""Rewards of what a table drives, and whether it crashed."""


@pytest.mark.parametrize(("check_by", "best"), [("reward", "fast"), ("crashes", "safe")])
def test_the_best_table_is_by_reward_or_by_crashes(tmp_path, check_by, best):
    checks = checks_by(check_by, tmp_path / "best.npz")
    for episodes, driven in enumerate(TABLES.values(), 1):
        outcomes = iter(driven)
        checks._play = lambda seed, options: Outcome(60, *next(outcomes))  # noqa: B023
        checks.after(episodes)
    found = read_arrays(tmp_path / "best.npz")
    assert list(TABLES)[int(found["episodes"]) - 1] == best
    again = checks_by(check_by, tmp_path / "best.npz")
    again._play = lambda seed, options: Outcome(60, 70.0, False)
    again.after(4)
    assert int(read_arrays(tmp_path / "best.npz")["episodes"]) == int(found["episodes"])


def test_no_other_way_to_choose():
    with pytest.raises(AgentError, match="check_by = 'laps'; it must be one of reward, crashes"):
        Settings(check_by="laps")
