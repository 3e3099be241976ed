# SPDX-License-Identifier: BSD-3-Clause
"""Recipes: their files, the runs that they make, ``sitl train --recipe`` and how such a run is evaluated."""

from __future__ import annotations

import json
import tomllib
from dataclasses import fields
from pathlib import Path

import gymnasium as gym
import pytest

from sitl.agents import algorithms, recipes
from sitl.agents import cli as agents_cli
from sitl.agents.errors import AgentError
from sitl.agents.recipes.recipe import KEYS
from sitl.agents.runs import folder as folders
from sitl.agents.runs.config import RunConfig
from sitl.agents.runs.evaluation_plan import EvaluationPlan
from tests.agents.small_runs import CIRCUIT2

SMALL = f"""
summary = "Short"
env = "{CIRCUIT2}"
algorithm = "sarsa"
episodes = 12
max_steps = 60
[options]
start = "random"
[settings]
alpha = 0.1
check_every = 6
check_episodes = 2
[evaluation]
episodes = 3
jitter = 0.1
max_steps = 40
options = {{ start = "original" }}
"""


@pytest.fixture
def small(tmp_path):
    path = tmp_path / "small.toml"
    path.write_text(SMALL)
    return path


def test_the_shipped_ones_can_be_used():
    assert {"circuit", "circuit2", "maze", "round"} <= set(recipes.names())
    for name in recipes.names():
        recipe = recipes.load(name)
        assert recipe.name == name and recipe.summary and all(gym.spec(env) for env in (recipe.env, *recipe.also))
        if recipe.algorithm in algorithms.TABULAR:
            assert recipe.config(3).seed == 3


def test_they_are_in_the_package():
    root = Path(agents_cli.__file__).parents[1]
    patterns = tomllib.loads((root.parents[1] / "pyproject.toml").read_text())["tool"]["setuptools"]["package-data"]
    packed = {path for pattern in patterns["sitl.agents"] for path in root.glob(pattern)}
    assert {path.stem for path in packed if path.parent.name == "recipes"} >= set(recipes.names())


def test_a_file_says_all_of_a_run(small):
    config = recipes.load(small).config(seed=4)
    assert (config.env, config.algorithm, config.seed, config.episodes, config.max_steps) == (
        CIRCUIT2, "sarsa", 4, 12, 60,
    )  # fmt: skip
    assert config.steps is None and config.env_options == {"start": "random"}
    assert config.settings["alpha"] == 0.1 and config.settings["gamma"] == 0.9
    assert config.evaluation == EvaluationPlan(3, 0.1, 40, {"start": "original"})


def test_single_things_are_replaced(small):
    config = recipes.load(small).config(steps=500, max_steps=30, options={"step_time": 0.3}, settings={"gamma": 0.5})
    assert (config.episodes, config.steps, config.max_steps) == (None, 500, 30)
    assert config.env_options == {"start": "random", "step_time": 0.3}
    assert (config.settings["alpha"], config.settings["gamma"]) == (0.1, 0.5)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("summary", "sumary", "'sumary' is not known; it is one of summary, env,.*did you mean 'summary'"),
        ('summary = "Short"', "alpha = 0.1", r"'alpha' is not known.*under \[settings\]"),
        (f'env = "{CIRCUIT2}"', "", "key 'env' is missing"),
        ('"sarsa"', '"sarse"', "algorithm 'sarse' is not known; it is one of qlearn"),
        ("episodes = 12", "episodes = 0", "episodes = 0; it must be a whole number from 1 on"),
        ("episodes = 12", "episodes = 1.5", "episodes = 1.5; it must be a whole number"),
        ("jitter", "jiter", "evaluation: key 'jiter' is not known; .*did you mean 'jitter'"),
        ("jitter = 0.1", "jitter = -1", "evaluation: jitter = -1; it must be a number 0 .. 1"),
        ('start = "random"', "start = 2020-01-01", "options has a date"),
        ("[options]", "[options", "small.toml: "),
    ],
)
def test_mistakes_in_a_file_are_told(small, old, new, message):
    small.write_text(SMALL.replace(old, new, 1))
    with pytest.raises(AgentError, match=message) as caught:
        recipes.load(small)
    assert str(small) in str(caught.value)


def test_a_setting_that_there_is_not(small):
    small.write_text(SMALL.replace("alpha", "alhpa"))
    with pytest.raises(AgentError, match=r"recipe small: setting 'alhpa' is not known.*did you mean 'alpha'"):
        recipes.load(small).config()


def test_names_that_there_are_not(tmp_path):
    with pytest.raises(AgentError, match=r"'circut' is not known; .*one of circuit.*did you mean 'circuit'"):
        recipes.load("circut")
    with pytest.raises(AgentError, match="there is no recipe"):
        recipes.load(tmp_path / "none.toml")


def test_a_run_keeps_its_evaluation_and_old_runs_load(small, tmp_path):
    config = recipes.load(small).config()
    path = tmp_path / "config.json"
    config.save(path)
    assert RunConfig.load(path) == config
    values = json.loads(path.read_text())
    assert not config.differences(config.with_(evaluation=EvaluationPlan()))
    del values["evaluation"]
    path.write_text(json.dumps(values))
    assert RunConfig.load(path).evaluation == EvaluationPlan(100, 0.0, None, {})
    path.write_text(json.dumps({**values, "evaluation": {"jiter": 1}}))
    with pytest.raises(AgentError, match=r"config.json: evaluation: key 'jiter'"):
        RunConfig.load(path)


def test_a_plan_is_changed_and_starts_of_ones_own_are_not_moved():
    plan = EvaluationPlan(3, 0.1, 40, {"start": "original", "world": "maze"})
    assert plan.changed() == plan
    assert plan.changed(5, max_steps=7, options={"world": "round"}) == EvaluationPlan(
        5, 0.1, 7, {"start": "original", "world": "round"}
    )
    assert plan.changed(options={"start": "turned"}).jitter == 0.0
    assert plan.changed(jitter=0.2, options={"start": "turned"}).jitter == 0.2


def test_train_and_evaluate_by_a_recipe(sitl, small):
    code, out, _ = sitl("train", "--recipe", small, "--seed", 5, "--set", "gamma=0.8", "--episodes", 8)
    assert (code, out) == (0, "runs/small\n")
    config = folders.find("runs/small")[0].config
    assert (config.seed, config.episodes, config.settings["gamma"], config.settings["alpha"]) == (5, 8, 0.8, 0.1)
    assert config.evaluation.episodes == 3
    words = ("train", "--recipe", small, "--seed", 5, "--set", "gamma=0.8", "--resume")
    assert sitl(*words, "--episodes", 10)[:2] == (0, "runs/small\n")
    assert len(folders.find("runs/small")[0].episodes.rows()) == 10

    code, out, _ = sitl("evaluate", "runs/small")
    assert code == 0 and out.startswith("runs/small: 3 episodes")
    assert sitl("evaluate", "runs/small")[:2] == (0, out)
    assert sitl("evaluate", "runs/small", "--jitter", 0.0)[1] != out
    assert "2 episodes" in sitl("evaluate", "runs/small", "--episodes", 2)[1]


def test_a_recipe_is_good_for_further_environments(small, tmp_path):
    further = "GazeboRoundTurtlebotLIDAR-v0"
    small.write_text(SMALL.replace("episodes = 12", f'also = ["{further}"]\nepisodes = 12', 1))
    recipe = recipes.load(small)
    assert recipe.config().env == CIRCUIT2 and recipe.config(env=further).env == further
    with pytest.raises(AgentError, match=f"learns in {CIRCUIT2} or {further}, not Other"):
        recipe.config(env="Other")
    small.write_text(SMALL.replace("episodes = 12", "also = [3]\nepisodes = 12", 1))
    with pytest.raises(AgentError, match=r"also = \[3\]; it must be a list of ids"):
        recipes.load(small)


def test_conflicts_are_refused(sitl, small, tmp_path):
    for words, message in (
        (("--recipe", small, "GazeboMazeTurtlebotLIDAR-v0"), "learns in GazeboCircuit2TurtlebotLIDAR-v0, not Gazebo"),
        (("--recipe", small, "--algo", "qlearn"), "trains with sarsa, not qlearn"),
        (("--recipe", "nothing"), "one of circuit"),
        (("--recipe", small, "--set", "alhpa=1"), "did you mean 'alpha'"),
    ):
        code, _, error = sitl("train", *words)
        assert code == 2 and message in error, (words, error)
    assert not (tmp_path / "runs").exists()


def test_the_page_names_every_key_and_its_example_is_one(tmp_path):
    page = (Path(__file__).parents[2] / "docs/learning.md").read_text().split("## Recipes")[1].split("\n## ")[0]
    table = "\n".join(line for line in page.splitlines() if line.startswith("| "))
    for key in (*KEYS, *(field.name for field in fields(EvaluationPlan))):
        assert f"`{key}`" in table or f"`[{key}]`" in table, key
    path = tmp_path / "example.toml"
    path.write_text(page.split("```toml\n")[1].split("```")[0])
    assert recipes.load(path).config().evaluation.options == {"start": "original"}
