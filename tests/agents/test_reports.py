# SPDX-License-Identifier: BSD-3-Clause
"""Reports on runs whose rewards are known: ``sitl compare``, and what is said of the paper's benchmark."""

from __future__ import annotations

import csv

import numpy as np
import pytest

from sitl.agents.errors import AgentError
from sitl.agents.report.comparison import compare
from sitl.agents.report.document import BLOCK, Document
from sitl.agents.report.group import Group
from sitl.agents.report.paper import SINGLE_CHANGES, STEP_TIMES, VARIANTS
from sitl.agents.report.paper_reasons import reasons
from sitl.agents.report.paper_tables import MEAN_REWARDS, TITLES, beside_paper, shortfalls
from tests.agents.small_runs import group, write


def report(tmp_path, *groups, **options):
    pytest.importorskip("matplotlib")
    return compare(groups, tmp_path / "out", **options).read_text()


def test_statistics_are_those_of_the_rewards(tmp_path):
    low = group(tmp_path, "low", [[0] * 8 + [k] * 2 for k in range(8)])
    high = group(tmp_path, "high", [[50] * 8 + [k + 4] * 2 for k in range(8)])
    text = report(tmp_path, low, high, block=4)
    assert "| 8 to 10 | 4 ± 2 | 8 ± 2 |" in text and "| low | 8 | 2 (" in text  # 4 to 8 are half zeros
    rows = list(csv.DictReader((tmp_path / "out" / "aggregates.csv").open()))
    found = {(row["of"], row["statistic"], row["over"]): float(row["value"]) for row in rows}
    assert found["low", "interquartile mean", "episodes 6 to 10"] == 1.75
    assert found["low > high", "probability of improvement", "episodes 6 to 10"] == 0.0


def test_a_single_seed_is_not_given_certainty(tmp_path):
    one, other = (group(tmp_path, name, [[level] * 10]) for name, level in (("one", 1), ("other", 2)))
    text = report(tmp_path, one, other)
    shown = text.partition("a single seed has no interval.")[2]
    assert shown and "(1 .. 1)" not in shown and "above other" not in shown and "±" not in shown
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
    pytest.importorskip("matplotlib")
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


def runs(path, levels=None, seeds=4, episodes=2 * BLOCK):
    """All groups of the benchmark, each with one level of rewards, seeds 2 apart."""
    names = [f"{title}, {variant.name}" for title in TITLES.values() for variant in (*VARIANTS, *SINGLE_CHANGES)]
    names += [f"{title}, steps of {seconds:g} s" for title in TITLES.values() for seconds in STEP_TIMES]
    levels = levels or {}
    return {
        name: group(path, name, [[levels.get(name, 0.0) + 2.0 * seed] * episodes for seed in range(seeds)])
        for name in names
    }


def test_reasons_follow_the_runs(tmp_path):
    early = MEAN_REWARDS["qlearn"][0]
    levels = {
        "Q-learning, textbook": early, "Q-learning, noise": early + 500.0, "Q-learning, steps of 0.3 s": early - 1.0,
        "Sarsa, redraw": -40.0,
    }  # fmt: skip
    exploration, discount, others, step, sarsa = reasons(runs(tmp_path / "one", levels))
    assert "+500 ± 4)" in exploration and exploration.count("the textbook is nearer") == 2
    assert "+0 ± 4, which may be chance" in discount
    assert "Sarsa, redraw -40 ± 4" in others and "Sarsa, first visit +0 ± 4, which may be chance" in others
    assert "to which 0.3 s is the nearest. Sarsa" in step
    assert "Every seed of these is above the paper's" in sarsa
    levels = {"Q-learning, noise": early, "Sarsa, textbook": -500.0, "Sarsa, as coded": -98.0}
    exploration, *_, sarsa = reasons(runs(tmp_path / "two", levels))
    assert exploration.count("noise is nearer") == 2 and "Every seed" not in sarsa


def test_reasons_say_when_there_is_too_little(tmp_path):
    assert "may be chance" not in (texts := " ".join(reasons(runs(tmp_path / "one", seeds=1))))
    assert "too few seeds to tell it from chance" in texts and "nan" not in texts
    (text,) = reasons(runs(tmp_path / "short", episodes=2 * BLOCK - 1))
    assert "too short" in text


def test_blocks_are_compared_with_the_papers_when_they_are_whole(tmp_path):
    paper = MEAN_REWARDS["qlearn"]
    rows = [[paper[0] + 1.0] * BLOCK + [paper[1] + spread] * BLOCK + [9999.0] * 10 for spread in (-30.0, 10.0)]
    groups = {("qlearn", "textbook"): group(tmp_path, "plain", rows)}
    (text,) = shortfalls(groups)
    assert (
        "in 1 of 2 intervals, below it but within a standard deviation of the seeds in 1, further below in 0." in text
    )
    far = [[paper[0] - 50.0] * BLOCK] * 2
    (text,) = shortfalls({("qlearn", "textbook"): group(tmp_path, "far", far)})
    assert "further below in 1 (0 to 200)" in text
    (text,) = shortfalls({("qlearn", "textbook"): group(tmp_path, "one", far[:1])})
    assert "below it in 1 (0 to 200)" in text and "deviation" not in text


@pytest.mark.parametrize("episodes", [BLOCK + 10, 16 * BLOCK])
def test_the_papers_table_beside_ours(tmp_path, episodes):
    groups = {
        (algorithm, variant.name): group(tmp_path, f"{algorithm}-{variant.name}", [[1.0] * episodes, [3.0] * episodes])
        for algorithm in TITLES
        for variant in VARIANTS
    }
    document = Document("paper")
    beside_paper(document, groups, tmp_path)
    text = document.write(tmp_path).read_text()
    assert "| 0 to 200 | -114 | 2 ± 13 | 2 ± 13 | -124 | 2 ± 13 | 2 ± 13 |" in text
    rows = list(csv.DictReader((tmp_path / "paper.csv").open()))
    assert float(rows[0]["Sarsa, as coded"]) == 2.0 and float(rows[-1]["Q-learning, textbook"]) == 3.0
    if episodes < 2 * BLOCK:
        assert "| 200 to 210 | -79 (to 400) | 2 ± 13 |" in text and rows[1]["Sarsa, paper"] == ""
    else:
        assert len(rows) == 17 and "| 3000 to 3200 |  | 2 ± 13 |" in text
