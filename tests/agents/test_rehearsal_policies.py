# SPDX-License-Identifier: BSD-3-Clause
"""Rehearsals of policies that are no run: baselines by name, files; on identified vehicles of the right kind."""

from __future__ import annotations

import csv
import dataclasses
from pathlib import Path

import pytest

from sitl import vehicles
from sitl.agents import baselines
from sitl.agents.errors import AgentError
from sitl.agents.rehearsal.change import Change
from sitl.agents.rehearsal.policies import group_of, run_of
from sitl.agents.rehearsal.trial import Trial, attempt
from sitl.agents.runs.folder import RunFolder
from tests.agents.small_runs import new


@pytest.fixture
def rover(tmp_path):
    """File of a rover with intervals, as `sitl identify` writes it."""
    known = vehicles.load("erle_rover")
    path = tmp_path / "mine.toml"
    path.write_text(vehicles.to_toml(dataclasses.replace(known, intervals={"speed_max": (0.5, 1.7)})))
    return path


def test_a_baseline_is_rehearsed_by_its_name_on_an_identified_vehicle(sitl, rover, tmp_path):
    words = ("rehearse", "rover-waypoint", "--airframe", rover, "--episodes", 2, "--boots", 1)
    code, out, err = sitl(*words, "--only", "least speed_max", "--only", "greatest speed_max")
    assert (code, err) == (0, "")
    assert out.strip() == "reports/rehearsal/report.md"
    with open(tmp_path / "reports/rehearsal/rehearsal.csv") as file:
        rows = {row["change"]: float(row["mean_reward"]) for row in csv.DictReader(file)}
    assert list(rows) == ["home", "least speed_max", "greatest speed_max"]
    assert rows["least speed_max"] < rows["home"], "a third of the speed arrives later"
    table = (tmp_path / "reports/rehearsal/report.md").read_text()
    assert f"| {rows['least speed_max']:.1f} |" in table, "rewards of 17.3 and 17.1 are told apart"


def test_a_policys_file_is_its_run():
    run = run_of(baselines.file("copter-hover"))
    assert (run.config.env, run.config.algorithm) == ("sitl/CopterHover-v1", "ppo")
    late = attempt(Trial(run.path, Change("late", "latency", latency=0.2), 1, boots=1), lambda _: None, lambda: False)
    assert late is not None and len(late.rewards) == 1 and not late.refused


def test_what_is_no_policy_is_named(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(AgentError, match=r"copter-hovr is not there: a run's folder.*did you mean 'copter-hover'"):
        group_of(Path("copter-hovr"), "mine")
    with pytest.raises(AgentError, match=r"neither a run nor a folder of runs"):
        group_of(tmp_path, "mine")
    (tmp_path / "mine.npz").write_bytes(b"no")
    with pytest.raises(AgentError, match=r"mine.npz is no file of a policy"):
        group_of(tmp_path / "mine.npz", "mine")


def test_an_airframe_of_another_kind_is_refused_before_anything_is_played(sitl, rover, tmp_path):
    code, _, err = sitl("rehearse", "copter-hover", "--airframe", rover)
    assert code == 2
    assert "mine.toml' is a rover; the policy's environment sitl/CopterHover-v1 has a copter" in err
    new(tmp_path / "turtle")
    code, _, err = sitl("rehearse", "turtle", "--airframe", rover)
    assert code == 2 and "has robot turtlebot, which has no airframe" in err
    assert not (tmp_path / "reports").exists()


def test_a_run_that_was_trained_on_the_file_is_rehearsed_without_saying_so_twice(sitl, rover, tmp_path, monkeypatch):
    monkeypatch.delenv("SITL_ALLOW_CODE", raising=False)
    config = run_of(baselines.file("rover-waypoint")).config
    RunFolder.create(tmp_path / "run", config.with_(env_options={**config.env_options, "frame": str(rover)}))
    monkeypatch.delenv("SITL_ALLOW_CODE", raising=False)
    assert "names code that would be run" in sitl("rehearse", "run")[2]
    err = sitl("rehearse", "run", "--airframe", rover, "--episodes", 1)[2]
    assert "names code" not in err and "run" in err, "it has no model, which is the next thing that is missed"
