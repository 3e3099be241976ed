# SPDX-License-Identifier: BSD-3-Clause
"""``sitl train``, ``sitl evaluate``, ``sitl compare`` and ``sitl benchmark paper`` as a user calls them."""

from __future__ import annotations

import csv
import json

import pytest

from sitl.agents.evaluate import rounded
from sitl.agents.report.paper_tables import MEAN_REWARDS
from sitl.agents.runs import folder as folders
from tests.agents.small_runs import CHECKS, CIRCUIT2, result

pytest.importorskip("matplotlib")
SHORT = ["--episodes", "20", "--max-steps", "60", *(w for k, v in CHECKS.items() for w in ("--set", f"{k}={v}"))]


def test_train_writes_a_run_folder(sitl, tmp_path):
    code, out, err = sitl("train", CIRCUIT2, "--algo", "sarsa", "--seed", 3, "--set", "alpha=0.1", *SHORT)
    assert (code, out) == (0, f"runs/{CIRCUIT2}-sarsa\n") and "times" not in out and "x real time" in err
    folder = tmp_path / out.strip()
    found = {path.name for path in folder.iterdir()}
    assert found == {"config.json", "episodes.csv", "model.npz", "best.npz", "curve.png"}
    config = folders.find(folder)[0].config
    assert (config.algorithm, config.seed, config.settings["alpha"], config.max_steps) == ("sarsa", 3, 0.1, 60)


@pytest.mark.slow
def test_seeds_in_processes_and_longer_by_resume(sitl):
    assert sitl("train", CIRCUIT2, "--seeds", 3, "--out", "one", *SHORT)[0] == 0
    assert sitl("train", CIRCUIT2, "--seeds", 3, "--jobs", 2, "--out", "two", *SHORT)[0] == 0
    one, two = folders.find("one"), folders.find("two")
    assert [run.config.seed for run in one] == [0, 1, 2]
    assert [result(run) for run in one] == [result(run) for run in two]
    assert "is done" in sitl("train", "--resume", "two")[1]
    assert sitl("train", "--resume", "two", "--episodes", 30)[0] == 0
    assert [len(run.episodes.rows()) for run in folders.find("two")] == [30, 30, 30]
    assert sitl("train", CIRCUIT2, "--seeds", 4, "--out", "one", "--resume", *SHORT)[0] == 0
    assert len(folders.find("one")) == 4


def test_mistakes_are_told(sitl):
    assert sitl("train", CIRCUIT2, "--out", "run", *SHORT)[0] == 0
    for words, message in (
        (("train", CIRCUIT2, "--out", "run", *SHORT), "is a run already"),
        (("train", CIRCUIT2, "--out", "run", "--resume", "--set", "alpha=0.1"), "other settings"),
        (("train", CIRCUIT2, "--out", "x", "--set", "alhpa=0.1"), "did you mean 'alpha'"),
        (("train", CIRCUIT2, "--out", "y", "--option", "world=nowhere"), "nowhere"),
        (("train", CIRCUIT2, "--out", "z", "--option", "observation=scan"), "observation = digits"),
        (("train", "Nothing-v0", "--out", "n"), "Nothing"),
        (("train",), "ENV is missing"),
        (("train", "--resume", "run", "--algo", "sarsa"), "continues a run with its own settings"),
        (("train", "--resume", "nothing"), "neither a run"),
        (("compare", "run", "nothing"), "neither a run"),
        (("evaluate", "run", "--option", "world=nowhere"), "nowhere"),
    ):
        code, _, error = sitl(*words)
        assert code == 2 and message in error, (words, error)


def test_what_cannot_be_trained_or_played_leaves_no_folder(sitl, tmp_path):
    assert "did you mean 'world'" in sitl("train", CIRCUIT2, "--option", "wrld=maze", "--out", "one", *SHORT)[2]
    (tmp_path / "far.toml").write_text(
        f'env = "{CIRCUIT2}"\nalgorithm = "qlearn"\n[evaluation]\noptions = {{ world = "moon" }}\n'
    )
    assert "world 'moon' is not known" in sitl("train", "--recipe", "far.toml", "--out", "two", *SHORT)[2]
    words = ("--option", "observation=scan", "--out", "three", *SHORT)
    assert "a table needs observations of digits" in sitl("train", CIRCUIT2, *words)[2]
    assert not any((tmp_path / name).exists() for name in ("one", "two", "three"))


def test_a_start_in_a_wall_is_a_users_mistake(sitl):
    sitl("train", CIRCUIT2, "--out", "one", *SHORT)
    code, _, error = sitl("evaluate", "one", "--jitter", 1, "--episodes", 20)
    assert code == 2 and "in world 'circuit2' is inside of" in error


def test_evaluate_plays(sitl):
    assert sitl("train", CIRCUIT2, "--out", "run", *SHORT)[0] == 0
    code, out, _ = sitl("evaluate", "run", "--episodes", 3, "--jitter", 0.1)
    assert code == 0 and out.startswith("run: 3 episodes: mean reward") and "laps per episode" in out
    (told,) = json.loads(sitl("evaluate", "run", "--episodes", 3, "--jitter", 0.1, "--json")[1])
    rewards = [played["reward"] for played in told["episodes"]]
    assert told["run"] == "run" and f"mean reward {rounded(sum(rewards) / 3)}," in out
    assert "laps" not in sitl("evaluate", "run", "--episodes", 1, "--option", "world=maze")[1]


def test_compare_writes_a_report(sitl, tmp_path):
    assert sitl("train", CIRCUIT2, "--out", "one", "--seeds", 2, *SHORT)[0] == 0
    assert sitl("train", CIRCUIT2, "--out", "two", "--set", "gamma=0.5", *SHORT)[0] == 0
    code, out, _ = sitl("compare", "one", "two", "--play", 1, "--block", 5)
    assert code == 0
    folder = (tmp_path / out.strip()).parent
    text = (folder / "report.md").read_text()
    assert "gamma = 0.5" in text and "| 15 to 20 |" in text and "one above two" in text and "without a crash" in text
    assert "<table>" in (folder / "report.html").read_text()
    files = {"blocks.csv", "aggregates.csv", "greedy.csv", "curves.png", "profile.png", "report.md", "report.html"}
    assert {path.name for path in folder.iterdir()} == files
    rows = list(csv.DictReader((folder / "blocks.csv").open()))
    assert len(rows) == 3 * 4 and {row["group"] for row in rows} == {"one", "two"}
    first = folders.find("one")[0].episodes.column("reward")
    assert float(rows[0]["mean_reward"]) == pytest.approx(first[:5].mean())
    assert [row["seed"] for row in csv.DictReader((folder / "greedy.csv").open())] == ["0", "1", "0"]
    assert "not evaluated alike" not in text


def test_compare_plays_runs_as_they_are_evaluated(sitl, tmp_path):
    (tmp_path / "moved.toml").write_text(
        f'env = "{CIRCUIT2}"\nalgorithm = "qlearn"\n[evaluation]\njitter = 0.1\nmax_steps = 30\n'
    )
    assert sitl("train", "--recipe", "moved.toml", "--seed", 3, *SHORT)[0] == 0
    assert sitl("train", CIRCUIT2, "--out", "still", *SHORT)[0] == 0
    assert sitl("compare", "runs/moved", "still", "--play", 2, "--out", "report")[0] == 0
    text = (tmp_path / "report" / "report.md").read_text()
    assert (
        "not evaluated alike" in text and "moved: jitter = 0.1, max_steps = 30; still: jitter = 0.0, max_steps" in text
    )
    row = next(csv.DictReader((tmp_path / "report" / "greedy.csv").open()))
    _, played, _ = sitl("evaluate", "runs/moved", "--episodes", 2)
    assert row["seed"] == "3" and f"mean reward {rounded(float(row['mean_reward']))}," in played


@pytest.mark.slow
def test_benchmark_writes_the_papers_table_and_goes_on(sitl, tmp_path):
    words = ("benchmark", "paper", "--seeds", 2, "--play", 1, "--out", "paper", "--jobs", 2)
    code, out, _ = sitl(*words, "--episodes", 40)
    assert (code, out) == (0, "paper/report.md\n")
    text = (tmp_path / out.strip()).read_text()
    for means in MEAN_REWARDS.values():
        assert f"| {means[0]} (to 200) |" in text
    assert "Sarsa, as coded" in text and "at or above the paper's mean in" not in text  # no block is whole
    rows = list(csv.DictReader((tmp_path / "paper" / "paper.csv").open()))
    assert [row["episodes"] for row in rows] == ["0 to 40", "best episode"]
    assert sitl(*words, "--episodes", 50)[0] == 0
    runs = sorted((tmp_path / "paper" / "runs").iterdir())
    assert len(runs) == 4 and all(len(run.episodes.rows()) == 50 for group in runs for run in folders.find(group))
    assert sitl("benchmark", "paper", "--seeds", 1, "--play", 1, "--out", "paper", "--episodes", 50)[0] == 0
