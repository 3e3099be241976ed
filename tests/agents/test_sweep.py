# SPDX-License-Identifier: BSD-3-Clause
"""Sweeps: each combination of values as a folder of runs, refused before anything is trained, told as a table."""

from __future__ import annotations

import csv
from functools import partial

import pytest

from sitl.agents.errors import AgentError
from sitl.agents.runs import folder as folders
from sitl.agents.runs import sweep as sweeps
from sitl.agents.runs.sweep import Sweep
from tests.agents.small_runs import CHECKS, CIRCUIT2, result

SHORT = ["--episodes", "20", "--max-steps", "60", *(w for k, v in CHECKS.items() for w in ("--set", f"{k}={v}"))]


@pytest.fixture
def train(sitl):
    """Runs ``sitl train``, see ``sitl``."""
    return partial(sitl, "train")


def test_axes_and_their_combinations():
    assert sweeps.axis("alpha=0.1,0.2") == ("alpha", [0.1, 0.2])
    assert sweeps.axis("exploration=uniform,noise") == ("exploration", ["uniform", "noise"])
    assert sweeps.axis("option.pose=[0,1],[2,3]") == ("option.pose", [[0, 1], [2, 3]])
    assert sweeps.axis("first_visit=true,false") == ("first_visit", [True, False])
    for text in ("alpha", "alpha=", "=1", "option.=1", "alpha=0.1,0.10"):
        with pytest.raises(ValueError, match=r"must be NAME|twice"):
            sweeps.axis(text)
    found = sweeps.combinations([("alpha", [0.1, 0.2]), ("option.world", ["maze", "round"])])
    assert [sweeps.folder_name(values) for values in found] == [
        "alpha-0.1,world-maze", "alpha-0.1,world-round", "alpha-0.2,world-maze", "alpha-0.2,world-round",
    ]  # fmt: skip
    with pytest.raises(AgentError, match="alpha is given twice"):
        sweeps.combinations([("alpha", [1]), ("alpha", [2])])
    with pytest.raises(AgentError, match="differ in signs only"):
        sweeps.combinations([("option.world", ["a/b", "a b"])])


def test_a_sweep_trains_each_combination_and_tells_the_best_first(train, tmp_path):
    words = (CIRCUIT2, "--sweep", "alpha=0.1,0.5", "--sweep", "option.world=circuit2,maze", "--seeds", 2, *SHORT)
    code, out, _ = train(*words)
    assert code == 0 and out.endswith(f"runs/{CIRCUIT2}-qlearn-sweep\n")
    folder = tmp_path / out.splitlines()[-1]
    rows = list(csv.DictReader((folder / "sweep.csv").open()))
    assert len(rows) == 4 and [row["alpha"] for row in rows].count("0.5") == 2
    means = [float(row["mean_reward"]) for row in rows]
    assert means == sorted(means, reverse=True) and all(row["seeds"] == "2" and row["block"] == "4" for row in rows)
    shown = out.splitlines()
    assert (
        shown[0].split()[:4] == ["alpha", "option.world", "seeds", "last"] and shown[1].split()[0] == rows[0]["alpha"]
    )
    for row in rows:
        runs = folders.find(folder / row["folder"])
        assert [run.config.seed for run in runs] == [0, 1]
        assert runs[0].config.settings["alpha"] == float(row["alpha"])
        assert runs[0].config.env_options == {"world": row["option.world"]}
        last = [run.episodes.column("reward")[-4:].mean() for run in runs]
        assert float(row["mean_reward"]) == pytest.approx(sum(last) / 2)
    alone = train(CIRCUIT2, "--set", "alpha=0.5", "--option", "world=maze", "--out", "alone", *SHORT)
    assert alone[0] == 0
    assert result(folders.find("alone")[0]) == result(folders.find(folder / "alpha-0.5,world-maze")[0])


def test_a_sweep_goes_on_and_grows(train, tmp_path):
    words = (CIRCUIT2, "--out", "s", *SHORT)
    assert train(*words, "--sweep", "gamma=0.5,0.9")[0] == 0
    assert "is a run already" in train(*words, "--sweep", "gamma=0.5,0.9")[2]
    code, out, _ = train(*words, "--sweep", "gamma=0.5,0.9", "--resume")
    assert code == 0 and "s is done" in out and "gamma  seeds" in out
    assert train(*words, "--sweep", "gamma=0.8", "--resume")[0] == 0
    assert train("--resume", "s", "--episodes", 25)[0] == 0
    found = Sweep.load(tmp_path / "s").groups()
    assert {name: len(runs[0].episodes.rows()) for name, runs in found.items()} == {
        "gamma-0.5": 25, "gamma-0.9": 25, "gamma-0.8": 25,
    }  # fmt: skip
    assert "sweep over gamma" in train(*words, "--sweep", "alpha=0.5", "--resume")[2]


def test_bad_sweeps_are_refused_before_anything_is_made(train, tmp_path):
    for words, message in (
        (("--sweep", "alhpa=0.1,0.2"), "did you mean 'alpha'"),
        (("--sweep", "alpha=0.1,2"), "alpha = 2"),
        (("--sweep", "option.world=circuit2,nowhere"), "nowhere"),
        (("--sweep", "option.nothing=1"), "nothing"),
        (("--sweep", "alpha=0.1", "--set", "alpha=0.2"), "alpha is given twice"),
        (("--sweep", "alpha=0.1", "--sweep", "alpha=0.2"), "alpha is given twice"),
        (("--sweep", "alpha"), "NAME=V1,V2"),
    ):
        code, _, error = train(CIRCUIT2, "--out", "s", *SHORT, *words)
        assert code == 2 and message in error, (words, error)
    assert not (tmp_path / "s").exists()
    assert "continues a run with its own settings" in train("--resume", "s", "--sweep", "alpha=0.1")[2]


def test_a_sweep_does_not_mix_with_other_runs(train, tmp_path):
    train(CIRCUIT2, "--out", "group", "--seeds", 2, *SHORT)
    assert "group is a folder of runs" in train(CIRCUIT2, "--out", "group", *SHORT, "--sweep", "gamma=0.5,0.9")[2]
    train(CIRCUIT2, "--out", "s", *SHORT, "--sweep", "gamma=0.5,0.9", "--seeds", 2)
    assert "s is a folder of runs" in train(CIRCUIT2, "--out", "s", *SHORT)[2]
    assert {path.name for path in (tmp_path / "group").iterdir()} == {"seed-0", "seed-1", "curve.png"}
