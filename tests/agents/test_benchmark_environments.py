# SPDX-License-Identifier: BSD-3-Clause
"""``sitl benchmark environments``: trains what is missing, plays it, writes a report with pictures."""

from __future__ import annotations

import argparse
import csv
import math

import gymnasium as gym
import numpy as np
import pytest

from sitl.agents import recipes
from sitl.agents.cli import benchmark
from sitl.agents.deep import library
from sitl.agents.errors import AgentError
from sitl.agents.evaluate import Evaluation, Played
from sitl.agents.recipes.recipe import Recipe, check_all, runs_of
from sitl.agents.report.driven import Driven, Trails, Whereabouts, facts, position_of, whereabouts
from sitl.agents.report.environments import drive_one, with_range
from sitl.agents.runs.evaluation_plan import EvaluationPlan
from sitl.agents.runs.training import train_one
from sitl.errors import MissingExtra
from sitl.worlds import load
from tests.agents.small_runs import CIRCUIT2, make

pytest.importorskip("matplotlib")
SMALL = f"""
env = "{CIRCUIT2}"
algorithm = "qlearn"
episodes = 12
max_steps = 60
[settings]
check_every = 6
check_episodes = 2
[evaluation]
episodes = 3
jitter = 0.1
"""


def bench(*words):
    top = argparse.ArgumentParser()
    benchmark.add_parser(top.add_subparsers(required=True))
    options = top.parse_args(["benchmark", "environments", *map(str, words)])
    return options.function(options)


def small(**fields):
    plan = EvaluationPlan(episodes=3, jitter=0.1)
    return Recipe("small", CIRCUIT2, "qlearn", episodes=5, max_steps=60, evaluation=plan, **fields)


def test_trains_plays_and_reports(tmp_path, capsys):
    path, out = tmp_path / "small.toml", tmp_path / "report"
    path.write_text(SMALL)
    assert bench("--only", path, "--seeds", 2, "--out", out) == 0
    assert capsys.readouterr().out == f"{out}/report.md\n"
    text = (out / "report.md").read_text()
    assert "laps an episode" in text and "(at 60 times)" in text and "digits (5)" in text
    assert "(small-trails.png)" in text and "forward, left, right" in text
    assert (out / "small-curve.png").stat().st_size > 10_000 < (out / "small-trails.png").stat().st_size
    rows = list(csv.DictReader((out / "environments.csv").open()))
    assert [(row["recipe"], row["seed"], row["played"], row["episodes"]) for row in rows] == [
        ("small", "0", "3", "12"), ("small", "1", "3", "12"),
    ]  # fmt: skip
    assert "left the world" in text and [row["left"] for row in rows] == ["0", "0"]
    assert 0.5 < float(rows[0]["farthest_m"]) < 15.0
    assert float(rows[0]["paper_wall_s"]) == pytest.approx(float(rows[0]["simulated_s"]) / 60.0, abs=0.1)

    logs = [(out / f"runs/small/seed-{seed}/episodes.csv").read_bytes() for seed in (0, 1)]
    assert bench("--only", path, "--seeds", 2, "--out", out) == 0
    assert logs == [(out / f"runs/small/seed-{seed}/episodes.csv").read_bytes() for seed in (0, 1)]


def test_an_interrupt_is_told(tmp_path, monkeypatch, capsys):
    (tmp_path / "small.toml").write_text(SMALL)
    monkeypatch.setattr(benchmark, "_train", lambda *arguments, **more: False)
    assert bench("--only", tmp_path / "small.toml", "--out", tmp_path / "out") == 130
    assert "the same command goes on" in capsys.readouterr().err
    assert not (tmp_path / "out/report.md").exists()


def test_runs_go_on_and_are_never_other_ones(tmp_path):
    assert [run.config.seed for run in runs_of(tmp_path, small(), 2)] == [0, 1]
    longer = Recipe("small", CIRCUIT2, "qlearn", episodes=9, max_steps=60)
    assert runs_of(tmp_path, longer, 1)[0].config.episodes == 9
    assert runs_of(tmp_path, small(), 1)[0].config.episodes == 9
    with pytest.raises(AgentError, match=r"seed-0 differs in settings; choose another --out"):
        runs_of(tmp_path, small(settings={"alpha": 0.3}), 1)


def test_what_is_not_installed_is_told_before_anything_is_trained(tmp_path, monkeypatch):
    monkeypatch.setattr(library.importlib.util, "find_spec", lambda name: None)
    deep = tmp_path / "deep.toml"
    deep.write_text(f'env = "{CIRCUIT2}"\nalgorithm = "ppo"\nsteps = 100\n')
    with pytest.raises(MissingExtra, match=r"recipes deep: .*gym-sitl\[rl\].*; without: --only round$"):
        bench("--only", "round", deep, "--out", tmp_path / "out")
    assert not (tmp_path / "out").exists()
    check_all([small()], 1)


@pytest.mark.parametrize(
    "fields", [{"options": {"world": "moon"}}, {"evaluation": EvaluationPlan(options={"world": "moon"})}]
)
def test_environments_that_cannot_be_are_told_before_anything_is_trained(fields):
    with pytest.raises(AgentError, match=r"recipe small: .*world 'moon' is not known"):
        check_all([Recipe("small", CIRCUIT2, "qlearn", **fields)], 1)


def test_playing_ends_after_an_episode_when_it_is_interrupted(tmp_path):
    run, reported = runs_of(tmp_path, small(), 1)[0], []
    train_one(run.path, lambda rows: None, lambda: False)
    assert drive_one((run.path, small()), reported.append, lambda: len(reported) == 2) is None and reported == [1, 1]
    assert len(drive_one((run.path, small()), reported.append, lambda: False).evaluation.episodes) == 3


def test_recipes_of_one_name_are_refused():
    with pytest.raises(AgentError, match="two recipes 'round'"):
        check_all([recipes.load("round"), recipes.load("round")], 1)


def test_trails_are_those_of_the_episodes():
    env = make(steps=4)
    noted = Trails(env)
    for _ in range(2):
        noted.reset(seed=1)
        for _ in range(4):
            noted.step(0)
    assert [trail.shape for trail in noted.trails] == [(5, 2), (5, 2)]
    np.testing.assert_array_equal(noted.trails[0], noted.trails[1])
    assert noted.trails[0][-1, 0] - noted.trails[0][0, 0] == pytest.approx(4 * 0.6 * 0.3, rel=0.05)


def test_who_shuttles_and_who_leaves_is_known():
    world = load("circuit2")
    x0, y0, x1, y1 = world.bounds
    there_and_back = np.array([(1.0, 1.0), (4.0, 5.0), (1.0, 1.0)])
    assert whereabouts(there_and_back + (x0, y0), world) == Whereabouts(5.0, False)
    away = np.array([(x1 - 1.0, y1), (x1 + 2.0, y1)])
    assert whereabouts(away, world) == Whereabouts(3.0, True)


def test_a_trail_is_where_a_vehicle_really_is():
    """Its pose is what its autopilot believes, which drifts."""
    env = make("GazeboMazeErleRoverLIDAR-v0")
    place = position_of(env)
    env.reset(seed=1, options={"pose": (3.0, 2.0, 0.5)})
    assert place() == pytest.approx((3.0, 2.0), abs=0.3)
    believed = env.unwrapped.robot.pose[0, :2]
    for _ in range(3):
        env.step(0)
    assert math.dist(place(), (3.0, 2.0)) > 0.05 and not np.array_equal(place(), believed)
    env.close()


def test_ranges_as_text():
    assert with_range([1.0, 3.0], ".1f") == "2.0 (1.0 .. 3.0)"
    assert with_range([5.0, 5.0], ".0f") == with_range([5.0], ".0f") == "5"
    assert with_range([99.0, 100.0, 100.0], ".3g") == "99.7 (99 .. 100)"


def test_a_goal_reached_has_not_left_the_world_and_parts_are_named():
    env = gym.make("sitl/RoverWaypoint-v0")
    found = facts(env, "digits")
    env.close()
    assert found.observation == "goal, velocity, last_action (9)" and found.action == "2 set-points"
    assert not whereabouts(np.array([[0.0, 0.0], [50.0, 0.0]]), found.world).left  # it has no walls
    played = [Played(1.0, 1, True, crashed, reached, 1.0, 0.0) for crashed, reached in ((0, 1), (1, 0), (0, 0))]
    out = Driven(Evaluation(tuple(played)), (), (Whereabouts(1.0, True),) * 3, found)
    assert out.left == 1
