# SPDX-License-Identifier: BSD-3-Clause
"""The report on the paper's benchmark says what its runs say, whatever that is."""

from __future__ import annotations

import csv

import pytest

from sitl.agents.report.document import BLOCK, Document
from sitl.agents.report.paper import SINGLE_CHANGES, STEP_TIMES, VARIANTS
from sitl.agents.report.paper_reasons import reasons
from sitl.agents.report.paper_tables import MEAN_REWARDS, TITLES, beside_paper, shortfalls
from tests.agents.written_runs import group


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
