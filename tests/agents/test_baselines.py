# SPDX-License-Identifier: BSD-3-Clause
"""Policies that come with the program solve their environments, and play again to the last bit."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks import baselines as table
from sitl.agents import baselines, learnt
from sitl.agents.rollout import rollout
from sitl.envs import ids


@pytest.mark.parametrize("name", baselines.names())
def test_it_is_of_a_recipe_and_in_the_table(name: str) -> None:
    config, (recipe, env) = learnt.load(baselines.find(name)).config, baselines.recipe_of(name)
    assert (config.env, config.max_steps, config.algorithm) == (env, recipe.max_steps, recipe.algorithm)
    row = table.kept()[name]
    assert (row["env"], row["recipe"], row["steps"]) == (env, recipe.name, recipe.steps)
    assert row["solved"] + row["crashed"] <= row["episodes"]


def test_every_id_of_a_task_has_one_that_solves_nine_of_ten_episodes() -> None:
    results = table.kept()
    assert {row["env"] for row in results.values()} == set(ids.FIRST)
    assert not [name for name, row in results.items() if row["solved"] < 0.9 * row["episodes"]]


def test_the_page_shows_what_was_measured() -> None:
    page, results = table.PAGE.read_text(encoding="utf-8"), table.kept()
    assert list(results) == list(baselines.names())
    assert table.table(results) in page and table.faults_table(results) in page


@pytest.mark.parametrize("name", ["rover-waypoint", "rover-waypoint-discrete", "rover-slalom"])
def test_it_solves_its_environment_and_plays_again_to_the_last_bit(name: str) -> None:
    first, second = (rollout(baselines.find(name), episodes=16, seed=1000, robots=8) for _ in range(2))
    assert all(played.reached and not played.crashed for played in first.episodes)
    assert [played.reward for played in first.episodes] == [played.reward for played in second.episodes]


def test_a_policy_of_a_table_of_actions_is_of_the_other_forms_recipe() -> None:
    recipe, env = baselines.recipe_of("copter-hover-discrete")
    assert (recipe.name, env) == ("copter-hover", "sitl/CopterHoverDiscrete-v0")
    recipe, env = baselines.recipe_of("copter-hover")
    assert (recipe.name, env) == ("copter-hover", "sitl/CopterHover-v0")


@pytest.mark.parametrize("name", baselines.names())
def test_it_is_found_by_its_environments_preset(name: str) -> None:
    env = learnt.load(baselines.find(name)).config.env
    assert baselines.of_preset(ids.FIRST[env].preset) == name
    assert baselines.of_preset(ids.NEW[env.replace("-v0", "-v1")].preset) == name


def test_a_path_that_is_there_comes_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert baselines.find("copter-hover").parent.name == "baselines"
    Path("copter-hover").mkdir()
    assert baselines.find("copter-hover") == Path("copter-hover")


def test_shares_have_wilsons_interval() -> None:
    assert table.share(200, 200) == "100.0 % (98.1 .. 100.0)"
    assert table.share(50, 100) == "50.0 % (40.4 .. 59.6)"
