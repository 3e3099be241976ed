# SPDX-License-Identifier: BSD-3-Clause
"""Policies that come with the program solve their environments, and play again to the last bit."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.baselines import campaign, entries, page, records, shipped
from sitl.agents import baselines, learnt, recipes
from sitl.agents.rollout import rollout
from sitl.envs import ids

LIMITED = {"copter-trajectory-discrete": "what limits it is its table of actions"}
"""Policies that solve fewer than nine of ten episodes -> what limits them, as the page says it."""


@pytest.mark.parametrize("name", baselines.names())
def test_it_is_of_a_recipe_and_in_the_table(name: str) -> None:
    config, (recipe, env) = learnt.load(baselines.find(name)).config, baselines.recipe_of(name)
    assert config.env in (env, *recipe.also) and ids.task_of({**ids.NEW, **ids.FIRST}[config.env].preset) in name
    assert (config.max_steps, config.algorithm) == (recipe.max_steps, recipe.algorithm)
    row = shipped.kept()[name]
    assert (row["env"], row["recipe"]) == (config.env, recipe.name)
    assert row["steps"] == recipe.steps
    assert row["solved"] + row["crashed"] <= row["episodes"]


def test_every_id_of_a_task_has_one_that_solves_nine_of_ten_episodes() -> None:
    results = shipped.kept()
    assert set(results) == {baselines.of_preset(listed.preset) for listed in ids.NEW.values()}
    below = {name for name, row in results.items() if row["solved"] < 0.9 * row["episodes"]}
    assert below == set(LIMITED)
    assert all(why in page.PAGE.read_text(encoding="utf-8") for why in LIMITED.values())


def test_a_shipped_training_is_up_to_date() -> None:
    """Of those that say which it is: with another recipe or environment, ``python -m benchmarks.baselines`` is due."""
    names = [name for name in baselines.names() if shipped.key_of(name)]
    found = campaign.campaign(names, records.FOLDER, Path("runs"), 5, (), None)
    for entry in found.chosen:
        training = found.training(entry, shipped.kept()[entry.name]["training"])
        assert training is not None and training["key"] == shipped.key_of(entry.name), entry.name


def test_the_page_shows_what_was_measured() -> None:
    text = page.PAGE.read_text(encoding="utf-8")
    found = campaign.campaign(entries.names(), records.FOLDER, Path("runs"), 5, (), None)
    for mark, table in page.tables(found).items():
        assert f"<!-- {mark} -->\n\n{table}\n\n<!-- /{mark} -->" in text, mark
    assert list(shipped.kept()) == list(baselines.names())


def test_a_variant_has_a_plain_recipe_of_the_same_task() -> None:
    variants = [name for name in recipes.names() if name.endswith(entries.ROBUST)]
    assert len(variants) >= 5
    for name in variants:
        one, plain = recipes.load(name), recipes.load(entries.plain_of(name))
        assert (one.env, one.algorithm, one.max_steps) == (plain.env, plain.algorithm, plain.max_steps)
        assert one.options.get("observation") == plain.options.get("observation")


@pytest.mark.parametrize("name", ["rover-waypoint", "rover-waypoint-discrete", "rover-slalom"])
def test_it_solves_its_environment_and_plays_again_to_the_last_bit(name: str) -> None:
    first, second = (rollout(baselines.find(name), episodes=16, seed=1000, robots=8) for _ in range(2))
    reached = "".join("1" if played.reached else "0" for played in first.episodes)
    assert reached == recorded(name)[:16]
    assert [played.reward for played in first.episodes] == [played.reward for played in second.episodes]


def recorded(name: str) -> str:
    """Which of a shipped policy's episodes succeeded, by its training's result; all of one that has none."""
    if not shipped.key_of(name):
        return 200 * "1"
    found = campaign.campaign([name], records.FOLDER, Path("runs"), 5, (), None)
    result = found.episodes(found.chosen[0], shipped.kept()[name]["training"], "nominal")
    assert result is not None
    return str(result["reached"])


def test_a_policy_of_a_table_of_actions_is_of_the_other_forms_recipe() -> None:
    recipe, env = baselines.recipe_of("copter-hover-discrete")
    assert (recipe.name, env) == ("copter-hover", "sitl/CopterHoverDiscrete-v1")
    recipe, env = baselines.recipe_of("copter-hover")
    assert (recipe.name, env) == ("copter-hover", "sitl/CopterHover-v1")


@pytest.mark.parametrize("name", baselines.names())
def test_it_is_found_by_its_environments_preset(name: str) -> None:
    listed = {**ids.NEW, **ids.FIRST}[learnt.load(baselines.find(name)).config.env]
    assert baselines.of_preset(listed.preset) == name


def test_a_path_that_is_there_comes_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert baselines.find("copter-hover").parent.name == "baselines"
    Path("copter-hover").mkdir()
    assert baselines.find("copter-hover") == Path("copter-hover")


@pytest.mark.parametrize("env", [*ids.NEW, *ids.FIRST])
def test_each_version_of_an_id_has_one(env: str) -> None:
    recipe, newest = baselines.recipe_of(baselines.of_preset({**ids.NEW, **ids.FIRST}[env].preset))
    assert env in (recipe.env, *recipe.also) and newest.removesuffix("-v1") == env[:-3]


def test_shares_have_wilsons_interval() -> None:
    assert shipped.share(200, 200) == "100.0 % (98.1 .. 100.0)"
    assert shipped.share(50, 100) == "50.0 % (40.4 .. 59.6)"
