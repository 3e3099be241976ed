# SPDX-License-Identifier: BSD-3-Clause
"""Rehearsals of short runs: paired episodes, shares, refusals, reports, the commands."""

from __future__ import annotations

import csv
import math

import gymnasium as gym
import numpy as np
import pytest

from sitl.agents import recipes
from sitl.agents.errors import AgentError
from sitl.agents.rehearsal import rehearse as training
from sitl.agents.rehearsal.change import Change, is_covered
from sitl.agents.rehearsal.plan import Plan
from sitl.agents.rehearsal.rehearse import Rehearsed, Tried, rehearse, trials_of
from sitl.agents.rehearsal.report import write_report
from sitl.agents.rehearsal.transfer_ratio import advantage, transfer_ratio
from sitl.agents.rehearsal.trial import Trial, attempt, is_false_alarm, lidar_distance
from sitl.agents.report.group import Group
from sitl.agents.runs import folder as folders
from sitl.agents.runs.evaluation_plan import EvaluationPlan
from sitl.agents.runs.training import train_one
from sitl.envs.robots import boots as boots_of_vehicles
from sitl.envs.robots import in_fleet
from tests.agents.small_runs import CIRCUIT2, new

CHANGES = [
    Change("slow", "vehicle", set={"wheel_speed_max": 0.05}),
    Change("late", "latency", latency=0.6, episodes=2),
    Change("many rays", "sensors", options={"observation": "scan"}),
]
PLAN = """
[[change]]
name = "late"
group = "latency"
latency = 0.6
[[change]]
name = "noise"
group = "sensors"
set = { range_noise = 0.1 }
[training]
recipe = "RECIPE"
[randomise]
latency = [0.0, 0.2]
[randomise.scale]
wheel_radius_left = [0.95, 1.05]
"""
RECIPE = f"""
env = "{CIRCUIT2}"
algorithm = "sarsa"
episodes = 12
max_steps = 40
[settings]
check_every = 0
[evaluation]
episodes = 4
jitter = 0.1
"""


def told_nothing(message):
    pass


@pytest.fixture(scope="module")
def group(tmp_path_factory):
    """Two seeds of a short run."""
    path = tmp_path_factory.mktemp("runs") / "plain"
    plan = EvaluationPlan(episodes=5, jitter=0.1)
    for seed in (0, 1):
        new(folders.seed_folder(path, seed), seed=seed, evaluation=plan)
        train_one(folders.seed_folder(path, seed), told_nothing, lambda: False)
    return Group.load(path)


def test_trials_are_paired_and_repeat(group):
    counts = []
    one, two = (rehearse([group], CHANGES, seed=3, on_progress=lambda index, n: counts.append(n))[0] for _ in range(2))
    assert one.home.rewards.shape == (2, 5) and len(counts) == 2 * 2 * (5 + 5 + 2)
    assert np.array_equal(one.home.rewards, two.home.rewards)
    assert np.array_equal(one.tried[0].rewards, two.tried[0].rewards)
    assert one.tried[1].rewards.shape == (2, 2)
    same = rehearse([group], [Change("nothing", "vehicle", scale={"radius": 1.0})], seed=3)[0]
    assert np.array_equal(same.tried[0].rewards, same.home.rewards)


def test_what_a_policy_cannot_play_in_is_told(group):
    found = rehearse([group], CHANGES, episodes=1)[0]
    assert "the table is for" in found.tried[2].refused or "digits" in found.tried[2].refused
    assert found.transfer_ratios()[2] is None and not found.tried[0].refused


def test_at_home_it_must_play(tmp_path):
    new(tmp_path / "run", env_options={"world": "nowhere"})
    with pytest.raises(AgentError, match="run cannot be played at home: there is no model"):
        attempt(Trial(tmp_path / "run", None, 1), told_nothing, lambda: False)


@pytest.fixture(scope="module")
def driven(tmp_path_factory):
    """A run on a vehicle with an autopilot."""
    path = tmp_path_factory.mktemp("runs") / "driven"
    new(path, env="GazeboMazeErleRoverLIDAR-v0", episodes=1, max_steps=3)
    train_one(path, told_nothing, lambda: False)
    return Group.load(path)


def test_episodes_begin_with_as_many_boots_as_are_asked_for(driven, monkeypatch):
    asked = []
    monkeypatch.setattr(
        in_fleet, "draw", lambda boots, seed: asked.append(boots) or boots_of_vehicles.draw(boots, seed)
    )
    for boots, found in ((None, 1), (3, 3)):
        asked.clear()
        one = rehearse([driven], [Change("late", "latency", latency=0.2)], episodes=2, boots=boots)[0]
        assert len(one.home.boots) == 2 and one.home.boots == one.tried[0].boots
        assert {*one.home.boots} <= ({0} if found == 1 else {1, 2, 3})
        assert {*asked} == ({3} if boots else set()), "one boot is where each episode is anyway"
        assert not one.tried[0].seen


def test_the_report_says_that_one_boot_is_one_draw(driven, tmp_path):
    pytest.importorskip("matplotlib")
    rows = [np.full((1, 3), 5.0), np.zeros((1, 3)), np.zeros((1, 3))]
    for boots in ((), (0, 0, 0), (3, 9, 3)):
        home = Tried(*rows, boots=boots)
        text = write_report({"a": [Rehearsed("it", driven.runs, home, CHANGES[:1], [home])]}, tmp_path).read_text()
        assert ("All episodes of it begin with one and the same boot" in text) == (boots == (0, 0, 0))


def test_boots_that_there_cannot_be_are_refused(sitl, group, driven):
    code, _, error = sitl("rehearse", driven.runs[0].path, "--boots", 2000)
    assert code == 2 and "boots = 2000; a whole number, 1 .. 1024, is needed" in error
    code, _, error = sitl("rehearse", group.runs[0].path, "--boots", 3)
    assert code == 2 and "boots" in error


def test_an_interrupt_ends_it(group):
    assert attempt(Trial(group.runs[0].path, None, 5), told_nothing, lambda: True) is None


def test_domain_randomisation_is_no_part_of_home(tmp_path):
    wild = {"randomise": {"wheel_speed_max": [0.0, 0.0]}}
    for name, options in (("plain", {}), ("wild", wild)):
        new(tmp_path / name, env_options=options, episodes=1)
        train_one(tmp_path / name, told_nothing, lambda: False)
    table = (tmp_path / "plain" / "model.npz").read_bytes()
    (tmp_path / "wild" / "model.npz").write_bytes(table)
    homes = [attempt(Trial(tmp_path / name, None, 2), told_nothing, lambda: False) for name in ("plain", "wild")]
    assert homes[0] == homes[1]


def test_share_of_a_reward():
    rng = np.random.default_rng(1)
    home = rng.normal(100.0, 10.0, (3, 40))
    half = transfer_ratio(home, 0.5 * home)
    assert half == pytest.approx((0.5, 0.5, 0.5))  # paired: no spread at all
    mixed = transfer_ratio(home, home * rng.uniform(0.0, 1.0, home.shape))
    assert mixed.low < mixed.value < mixed.high and 0.4 < mixed.value < 0.6
    seeds = transfer_ratio(home, home * np.array([[1.0], [0.2], [0.6]]))
    assert seeds.high - seeds.low > 0.3  # the spread between seeds counts
    assert transfer_ratio(home, home[:, :7]).value == pytest.approx(1.0)
    assert math.isnan(transfer_ratio(-home, home).value)


def test_episodes_of_one_boot_count_as_one_draw():
    """Eight boots, of which the reward depends, and fifty episodes with each."""
    rng = np.random.default_rng(4)
    boots = rng.permutation(np.repeat(np.arange(1, 9), 50))
    of_boot = rng.normal(60.0, 10.0, 9)
    home, changed = np.full((2, 400), 100.0), np.tile(of_boot[boots] + rng.normal(0.0, 1.0, 400), (2, 1))
    apart = transfer_ratio(home, changed)
    together = transfer_ratio(home, changed, boots)
    expected = 0.01 * 1.96 * of_boot[1:].std() / math.sqrt(8.0)
    assert together.value == apart.value
    assert together.high - together.low == pytest.approx(2.0 * expected, rel=0.1)
    assert apart.high - apart.low < 0.3 * (together.high - together.low)
    above = advantage(home, np.full((1, 400), 50.0), changed, boots)
    assert above.high - above.low == pytest.approx(2.0 * expected, rel=0.1)
    for alone in (np.arange(400), np.zeros(400, np.int64)):
        assert transfer_ratio(home, changed, alone) == apart, "episodes are drawn"


def test_advantage_has_one_measure_for_both():
    rng = np.random.default_rng(2)
    home = np.full((2, 30), 100.0)
    first, other = rng.normal(60.0, 5.0, (2, 30)), rng.normal(50.0, 5.0, (3, 20))
    found = advantage(home, first, other)
    assert found.low < found.value < found.high < 0.0 and found.value == pytest.approx(-0.1, abs=0.03)
    own = np.full((3, 20), 50.0)
    assert transfer_ratio(own, other).value > transfer_ratio(home, first).value  # though it earns less
    assert advantage(home, first, first).value == 0.0


def test_what_training_covered_is_seen():
    home = {"start": "random", "randomise": None}
    drawn = {"mass": [1.0, 2.0], "latency": [0.0, 0.2]}
    heavy, late = {"randomise": {"mass": (1.5, 1.5)}}, {"latency": 0.2}
    assert is_covered({**home, **heavy}, home, drawn) and is_covered({**home, **heavy, **late}, home, drawn)
    assert not is_covered({**home, **heavy}, home, None)
    for other in ({"latency": 0.4}, {"world": "maze", **late}, {"randomise": {"mass": (1.5, 1.5), "grip": (1.0, 1.0)}}):
        assert not is_covered({**home, **other}, home, drawn)


def test_what_is_drawn_at_home_does_not_need_to_be_covered():
    home = {"randomise": None}
    windy = {"randomise": {"wind_speed": (0.0, 5.0), "mass": (1.5, 1.5)}}
    assert is_covered(windy, home, {"mass": [1.0, 2.0]})
    assert not is_covered(windy, home, {"grip": [1.0, 2.0]})
    assert not is_covered({"randomise": {"identified": True}}, home, {"mass": [1.0, 2.0]})
    assert not is_covered(windy, home, "identified")


def test_default_episodes_are_the_runs(group):
    assert {t.episodes for t in trials_of(group.runs, CHANGES[:1])} == {5}
    assert [t.episodes for t in trials_of(group.runs, CHANGES[1:2], 9)] == [9, 9, 2, 2]


def test_the_command_reports_runs_side_by_side(sitl, group, tmp_path):
    pytest.importorskip("matplotlib")
    (tmp_path / "plan.toml").write_text(PLAN)
    one, two = group.runs
    code, out, _ = sitl("rehearse", one.path, two.path, "--plan", "plan.toml", "--episodes", 3, "--out", "report")
    assert (code, out) == (0, "report/report.md\n")
    text = (tmp_path / "report" / "report.md").read_text()
    assert "seed-0: share" in text and "seed-1: crashes" in text and "of 3 |" in text and "-0 %" not in text
    names = {path.name for path in (tmp_path / "report").iterdir()}
    assert {"report.html", "rehearsal.csv", "episodes.csv"} < names and any(n.endswith(".png") for n in names)
    rows = list(csv.DictReader((tmp_path / "report" / "rehearsal.csv").open()))
    assert [row["change"] for row in rows] == 2 * ["home", "late", "noise"]
    assert len(list(csv.DictReader((tmp_path / "report" / "episodes.csv").open()))) == 2 * 3 * 3
    code, _, error = sitl("rehearse", one.path, "--only", "nose")
    assert code == 2 and "no change 'nose'" in error


def test_where_the_report_goes_is_seen_to_before_anything_is_played(sitl, group, tmp_path, monkeypatch):
    (tmp_path / "plan.toml").write_text(PLAN)
    monkeypatch.setattr("sitl.agents.cli.rehearse.with_bar", lambda *arguments: pytest.fail("it was played"))
    words = ("rehearse", group.runs[0].path, "--plan", "plan.toml", "--out", "plan.toml")
    assert sitl(*words) == (2, "", "plan.toml cannot be made: File exists")


def test_a_home_without_reward_is_told(group, tmp_path):
    pytest.importorskip("matplotlib")
    nothing = Tried(np.full((2, 3), -200.0), np.ones((2, 3)), np.zeros((2, 3)))
    found = Rehearsed("lost", group.runs, nothing, CHANGES[:1], [nothing])
    text = write_report({"a": [found]}, tmp_path / "new").read_text()
    assert "lost earned nothing (a mean reward of 0 or less): no share" in text
    assert "| slow | vehicle | -200 | - | 6 of 6 |" in text


def test_the_benchmark_trains_plain_and_randomised_and_goes_on(sitl, tmp_path):
    pytest.importorskip("matplotlib")
    (tmp_path / "tiny.toml").write_text(RECIPE)
    (tmp_path / "plan.toml").write_text(PLAN.replace("RECIPE", str(tmp_path / "tiny.toml")))
    words = ("benchmark", "rehearsal", "--only", "plan.toml", "--episodes", 2, "--out", "report")
    assert sitl(*words)[:2] == (0, "report/report.md\n")
    runs = {path.name: folders.find(path)[0] for path in (tmp_path / "report" / "runs").iterdir()}
    assert set(runs) == {"plan-plain", "plan-randomised"}
    drawn = runs["plan-randomised"].config.env_options["randomise"]
    assert drawn == {"wheel_radius_left": [0.03344, 0.03696], "latency": [0.0, 0.2]}
    times = [run.path.joinpath("model.npz").stat().st_mtime_ns for run in runs.values()]
    assert sitl(*words)[0] == 0
    assert times == [run.path.joinpath("model.npz").stat().st_mtime_ns for run in runs.values()]
    text = (tmp_path / "report" / "report.md").read_text()
    assert "| wheel_radius_left, latency |" in text and "randomised - plain |" in text and "one seed" in text
    rows = list(csv.DictReader((tmp_path / "report" / "rehearsal.csv").open()))
    above = {row["run"]: row["above_first"] for row in rows if row["change"] == "late"}
    assert above["plain"] == "" != above["randomised"]
    code, _, error = sitl(*words[:4], "plan.toml", *words[4:])
    assert code == 2 and "there are two plans 'plan'" in error


def test_recipes_of_a_plan(tmp_path):
    path = tmp_path / "tiny.toml"
    path.write_text(RECIPE)
    plan = Plan("p", (CHANGES[0],), training={"recipe": str(path), "steps": 500}, randomise={"latency": [0, 1]})
    plain, wild = training.recipes_of(plan).values()
    assert (plain.episodes, plain.steps, wild.options) == (None, 500, {"randomise": {"latency": [0.0, 1.0]}})
    assert recipes.load(path).options == plain.options == {}
    with pytest.raises(AgentError, match=r"needs training\.recipe"):
        training.recipes_of(Plan("p", (CHANGES[0],)))


def test_noise_that_calls_a_crash_is_told_apart(group):
    loud = [Change("loud", "sensors", set={"range_noise": 0.5}), Change("quiet", "sensors", set={"range_noise": 0.0})]
    found = rehearse([group], loud, episodes=5)[0]
    assert found.tried[0].false_alarms.sum() > 5
    assert found.tried[1].crashed.sum() > 0 == found.tried[1].false_alarms.sum()


@pytest.mark.parametrize("name, limit", [(CIRCUIT2, 0.2), ("GazeboMazeErleRoverLIDAR-v0", 1.5)])
def test_the_true_distance_is_what_a_lidar_without_noise_reads(name, limit):
    env = gym.make(name, observation="scan")
    env.reset(seed=1)
    while True:
        scan, _, terminated, _, _ = env.step(0)
        if scan.min() < 3.0:
            assert scan.min() - 0.3 < lidar_distance(env.unwrapped.robot) < scan.min() + 0.01
        if terminated:
            break
    assert scan.min() < limit and not is_false_alarm(env)
