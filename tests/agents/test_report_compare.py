# SPDX-License-Identifier: BSD-3-Clause
"""``sitl compare`` on runs whose rewards are known: what it says, leaves out, and refuses."""

from __future__ import annotations

import csv

import numpy as np
import pytest

from sitl.agents.errors import AgentError
from sitl.agents.report.compare import compare
from sitl.agents.report.group import Group
from tests.agents.written_runs import group, write

pytest.importorskip("matplotlib")


def report(tmp_path, *groups, **options):
    return compare(groups, tmp_path / "out", **options).read_text()


def test_figures_are_those_of_the_rewards(tmp_path):
    low = group(tmp_path, "low", [[0] * 8 + [k] * 2 for k in range(8)])
    high = group(tmp_path, "high", [[50] * 8 + [k + 4] * 2 for k in range(8)])
    text = report(tmp_path, low, high, block=4)
    assert "| 8 to 10 | 4 ± 2 | 8 ± 2 |" in text and "| low | 8 | 2 (" in text  # 4 to 8 are half zeros
    rows = list(csv.DictReader((tmp_path / "out" / "aggregates.csv").open()))
    found = {(row["of"], row["figure"], row["over"]): float(row["value"]) for row in rows}
    assert found["low", "interquartile mean", "episodes 6 to 10"] == 1.75
    assert found["low > high", "probability of improvement", "episodes 6 to 10"] == 0.0


def test_a_single_seed_is_not_given_certainty(tmp_path):
    one, other = (group(tmp_path, name, [[level] * 10]) for name, level in (("one", 1), ("other", 2)))
    text = report(tmp_path, one, other)
    figures = text.partition("a single seed has no interval.")[2]
    assert figures and "(1 .. 1)" not in figures and "above other" not in figures and "±" not in figures
    assert "single seed: nothing here says" in text
    many = group(tmp_path, "many", [[k] * 10 for k in range(3)])
    text = report(tmp_path, one, many)
    assert "narrower than the truth" in text and "| one above many | 0.50 |" in text


def test_other_tasks_and_missing_episodes_are_told(tmp_path):
    plain = group(tmp_path, "plain", [range(20), range(12)])
    maze = group(tmp_path, "maze", [range(20)] * 2, env_options={"world": "maze"})
    text = report(tmp_path, plain, maze, block=8)
    assert "differ in world" in text and "Seeds of plain have from 12 to 20 episodes" in text
    assert "| 8 to 16 | 10 ± 0 (to 12) |" in text and "| 16 to 20 |  | 18 ± 0 |" in text
    assert "first 12 episodes, which all have" in text
    same = report(tmp_path, plain, group(tmp_path, "long", [range(20)] * 2, settings={"alpha": 0.1}))
    assert "same task" not in report(
        tmp_path, plain, group(tmp_path, "x", [range(9)], env_options={"observation": "scan"})
    )
    assert "did not learn the same task" not in same and "| alpha = 0.1 |" in same


def test_a_run_counts_once(tmp_path):
    plain = group(tmp_path, "plain", [range(5)])
    with pytest.raises(AgentError, match="given twice"):
        report(tmp_path, plain, Group("again", plain.runs))
    (tmp_path / "file").write_text("")
    with pytest.raises(AgentError, match="cannot be made"):
        compare([plain], tmp_path / "file")
    with pytest.raises(AgentError, match="both have seed 0"):
        Group("two", [*plain.runs, write(tmp_path / "copy", range(5))])


@pytest.mark.parametrize("reward", [np.nan, np.inf])
def test_rewards_that_are_no_numbers_are_refused(tmp_path, reward):
    with pytest.raises(AgentError, match="reward of episode 2 is"):
        report(tmp_path, group(tmp_path, "bad", [[1, 2, reward, 4]]))
    with pytest.raises(AgentError, match="no episodes yet"):
        report(tmp_path, group(tmp_path, "none", [[]]))


def test_many_groups_have_curves_that_differ(tmp_path):
    from matplotlib.figure import Figure

    from sitl.agents.report.curves import draw_means, draw_raw

    axes = Figure().subplots()
    draw_means(axes, {str(k): np.full((2, 30), float(k)) for k in range(20)}, 10)
    assert len({(line.get_color(), line.get_linestyle()) for line in axes.lines}) == 20
    assert all(line.get_xdata()[0] == 10 and len(line.get_xdata()) == 21 for line in axes.lines)
    assert axes.get_ylim()[0] < 0.0 and axes.get_ylim()[1] > 19.0
    spread = Figure().subplots()
    draw_means(spread, {"wide": np.array([[0.0] * 30, [1000.0] * 15 + [1010.0] * 15])}, 10)
    assert spread.get_ylim()[0] > 490.0  # not the thousands of an interval of two seeds
    raw = Figure().subplots()
    draw_raw(raw, np.arange(25.0), "raw", 10)
    assert raw.lines[1].get_xdata().tolist() == [5.0, 15.0, 24.0] and raw.lines[1].get_ydata()[2] == 22.0
    assert raw.get_xlabel() and raw.get_ylabel() and len(raw.get_legend().get_texts()) == 2
