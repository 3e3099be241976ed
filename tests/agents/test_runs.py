# SPDX-License-Identifier: BSD-3-Clause
"""Run folders: what is in them, interrupted and resumed to the same bits, damaged ones."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

from sitl.agents import environments
from sitl.agents.errors import AgentError, ResumeError
from sitl.agents.runs import folder as folders
from sitl.agents.runs import local
from sitl.agents.runs.episodes import Episode, EpisodeLog
from sitl.agents.runs.files import read_arrays
from sitl.agents.runs.folder import RunFolder
from sitl.agents.runs.training import is_done, train_all, train_one
from sitl.agents.runs.watch import Watch
from sitl.agents.tabular import training
from sitl.agents.tabular.learner import Learner
from sitl.agents.tabular.settings import Settings
from sitl.agents.tabular.table import Table
from sitl.agents.tabular.training import Checks
from tests.agents import ray_works
from tests.agents.small_runs import config, new, result


def train(run, episodes=None):
    """Train to the end, or until so many episodes were told of."""
    seen = []
    watch = Watch(seen.extend, lambda: episodes is not None and len(run.episodes.rows()) + len(seen) >= episodes)
    training.train(run, watch)
    return seen


def test_a_run_is_a_folder_that_says_all(tmp_path):
    run = new(tmp_path / "run", seed=7)
    reported = train(run)
    rows = run.episodes.rows()
    assert [row.episode for row in rows] == list(range(30)) == [row.episode for row in reported]
    assert rows[0].epsilon == 0.9 and all(row.simulated_s == pytest.approx(0.6 * row.steps) for row in rows)
    assert all(row.steps == 60 or (row.steps < 60 and row.terminated) for row in rows)
    stored = json.loads((run.path / "config.json").read_text())
    assert stored["seed"] == 7 and stored["settings"]["alpha"] == 0.2 and "numba" in stored["versions"]
    assert RunFolder(run.path).config == run.config and is_done(run)


@pytest.mark.parametrize("algorithm", ["qlearn", "sarsa"])
def test_an_interrupted_and_resumed_run_equals_an_uninterrupted_one(tmp_path, algorithm, monkeypatch):
    monkeypatch.setattr("sitl.agents.runs.folder._REPORT_S", -1.0)  # tells of each episode
    whole, parts = new(tmp_path / "whole", algorithm), new(tmp_path / "parts", algorithm)
    train(whole)
    for episodes in (11, 12, 25, None):
        train(RunFolder(parts.path), episodes)
        assert len(parts.episodes.rows()) == (episodes or 30)
    assert result(whole) == result(parts)


def test_a_killed_run_goes_on_from_its_last_checkpoint(tmp_path, monkeypatch):
    monkeypatch.setattr("sitl.agents.runs.folder._REPORT_S", -1.0)
    whole, killed = new(tmp_path / "whole"), new(tmp_path / "killed")
    train(whole)
    train(killed, 7)
    model = (killed.path / training.MODEL).read_bytes()
    train(RunFolder(killed.path), 17)
    (killed.path / training.MODEL).write_bytes(model)  # as if it had died before its next checkpoint,
    with open(killed.path / "episodes.csv", "a") as log:
        log.write("17,6")  # in the middle of a row
    train(RunFolder(killed.path))
    assert result(whole) == result(killed)


def test_checks_keep_the_best_table_and_change_nothing_else(tmp_path):
    run = new(tmp_path / "run", episodes=200)
    without = new(tmp_path / "without", episodes=200, settings={"check_every": 0})
    train(run)
    train(without)
    (rows, (model, best)), (other_rows, (other_model,)) = result(run), result(without)
    assert rows == other_rows and model == other_model and best["keys"] != model["keys"]
    last = Table.load(run.path / training.MODEL)
    kept = training.load_table(run.path)
    assert kept.visits.sum() < last.visits.sum()
    assert training.load_table(without.path).visits.sum() == last.visits.sum()
    best = read_arrays(run.path / training.BEST)
    player = Learner("qlearn", Settings.of(run.config.settings), kept)
    again = Checks(environments.make(run.config), player, run.path / "other.npz").score()
    assert again == best["score"] and best["episodes"] % 8 == 0


def test_a_longer_run_begins_like_a_shorter_one(tmp_path):
    short, long = new(tmp_path / "short"), new(tmp_path / "long", episodes=45)
    train(short)
    train(long)
    assert result(short) != result(long)
    short.extend(45, None)
    train(RunFolder(short.path))
    assert result(short) == result(long)


def test_seeds_differ_and_repeat(tmp_path):
    runs = [new(tmp_path / str(k), seed=seed) for k, seed in enumerate((1, 2, 1))]
    for run in runs:
        train(run)
    assert result(runs[0]) == result(runs[2]) != result(runs[1])


def test_steps_can_be_the_length(tmp_path):
    run = new(tmp_path / "run", episodes=None, steps=200)
    train(run)
    rows = run.episodes.rows()
    assert sum(row.steps for row in rows[:-1]) < 200 <= sum(row.steps for row in rows) and is_done(run)


def test_processes_give_what_one_process_gives(tmp_path):
    one, two = ([new(tmp_path / where / str(seed), seed=seed) for seed in range(3)] for where in ("one", "two"))
    reported = []
    assert train_all([run.path for run in one])
    assert train_all([run.path for run in two], 2, lambda index, rows: reported.append((index, len(rows))))
    assert [result(run) for run in one] == [result(run) for run in two]
    assert sum(count for _, count in reported) == 90 and {index for index, _ in reported} == {0, 1, 2}


def test_an_error_in_a_process_is_raised_here(tmp_path):
    good, bad = new(tmp_path / "good"), new(tmp_path / "bad", env_options={"world": "nowhere"})
    with pytest.raises(AgentError, match="nowhere"):
        train_all([good.path, bad.path], 2)


def test_a_process_that_dies_or_raises_what_cannot_be_pickled_is_reported():
    with pytest.raises(RuntimeError, match=r"a process .* died"):
        local.each(ray_works.die, [1, 2], 2)
    with pytest.raises(RuntimeError, match="OddError: this and that"):
        local.each(ray_works.fail_oddly, [1, 2], 2)


def test_items_not_begun_before_an_interrupt_have_no_result(tmp_path):
    runs = [new(tmp_path / str(seed), seed=seed, episodes=200_000) for seed in range(4)]
    reported = lambda index, message: isinstance(message, int) and signal.raise_signal(signal.SIGTERM)  # noqa: E731
    results = local.each(ray_works.train_eagerly, [run.path for run in runs], 2, reported)
    assert results[0] is False and results[2:] == [None, None]


SLOW = "import sys; from pathlib import Path; from sitl.agents.runs.training import train_all; " + (
    "print(train_all([Path(p) for p in sys.argv[2:]], int(sys.argv[1])))"
)


@pytest.mark.slow
@pytest.mark.parametrize("jobs", [1, 2])
def test_a_signal_ends_runs_after_an_episode(tmp_path, jobs):
    runs = [new(tmp_path / str(seed), seed=seed, episodes=200_000) for seed in range(2)]
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-c", SLOW, str(jobs), *(str(run.path) for run in runs)]
    process = subprocess.Popen(command, env=env, stdout=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 120.0
    while not (runs[0].path / training.MODEL).exists() and time.monotonic() < deadline:
        time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=60)
    assert out == "False\n"
    done = len(runs[0].episodes.rows())
    assert 0 < done < 200_000
    again = new(tmp_path / "again", episodes=done)
    train(again)
    assert result(again) == result(runs[0])


def test_logs_that_cannot_be_are_refused(tmp_path):
    log = EpisodeLog(tmp_path / "episodes.csv")
    assert log.rows() == []
    row = Episode(0, 5, 0.1 + 0.2, 0.9, 1, 3.0, 0.01)
    log.append([row])
    assert log.rows() == [row]
    with pytest.raises(AgentError, match="has 1 episodes"):
        log.keep(2)
    log.path.write_text("a,b\n1,2\n")
    with pytest.raises(AgentError, match="no log of episodes"):
        log.rows()


def test_folders_and_groups(tmp_path):
    for seed in (10, 2):
        new(folders.seed_folder(tmp_path / "group", seed), seed=seed)
    assert [run.config.seed for run in folders.find(tmp_path / "group")] == [2, 10]
    assert folders.common(folders.find(tmp_path / "group")).seed == 2
    with pytest.raises(AgentError, match="is a run already"):
        new(tmp_path / "group" / "seed-2")
    with pytest.raises(AgentError, match="group is a folder of runs"):
        new(tmp_path / "group")
    with pytest.raises(AgentError, match="seed-2 is a run already, which holds no others"):
        new(tmp_path / "group" / "seed-2" / "seed-0")
    new(tmp_path / "group" / "other", "sarsa")
    with pytest.raises(AgentError, match=r"seed-2 and .*x are not one group: they differ in algorithm, settings"):
        folders.common(
            [RunFolder(tmp_path / "group" / "seed-2"), new(tmp_path / "x", settings={"alpha": 0.1}, algorithm="sarsa")]
        )
    with pytest.raises(AgentError, match="neither a run"):
        folders.find(tmp_path / "nothing")


def test_configurations_that_cannot_be_are_refused(tmp_path):
    for fields in ({"episodes": 0}, {"seed": -1}, {"max_steps": 0}, {"episodes": None}):
        with pytest.raises(AgentError):
            config(**fields)
    (tmp_path / "config.json").write_text('{"algorithm": "qlearn"}')
    with pytest.raises(AgentError, match="does not describe a run"):
        RunFolder(tmp_path)


def test_models_of_other_environments_are_refused(tmp_path):
    run = new(tmp_path / "run")
    train(run)
    other = new(tmp_path / "other", env_options={"observation": "digits", "start": "random"})
    (other.path / training.MODEL).write_bytes((run.path / training.MODEL).read_bytes())
    other.episodes.append(run.episodes.rows())
    assert train_one(other.path, lambda rows: None, lambda: False)  # same spaces: it can be gone on with
    cliff = new(tmp_path / "cliff", env="CliffWalking-v1")
    (cliff.path / training.MODEL).write_bytes((run.path / training.MODEL).read_bytes())
    with pytest.raises(AgentError, match="digits"):
        train(cliff)
    np.savez(cliff.path / training.MODEL, keys=1)
    with pytest.raises(ResumeError, match="cannot be gone on with"):
        train(cliff)
