# SPDX-License-Identifier: BSD-3-Clause
"""Policies that come with the program solve their environments, and play again to the last bit."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks import baselines as table
from sitl.agents import baselines, learnt, recipes
from sitl.agents.rollout import rollout

DOCS = Path(__file__).parents[2] / "docs"


@pytest.mark.parametrize("name", baselines.names())
def test_it_is_of_the_recipe_of_its_name_and_in_the_table(name: str) -> None:
    config, recipe = learnt.load(baselines.find(name)).config, recipes.load(name)
    assert (config.env, config.max_steps, config.algorithm) == (recipe.env, recipe.max_steps, recipe.algorithm)
    assert f"| `{config.env}` | `{name}` | {recipe.steps:,} |" in (DOCS / "baselines.md").read_text(encoding="utf-8")


def test_it_solves_its_environment_and_plays_again_to_the_last_bit() -> None:
    first, second = (rollout(baselines.find("rover-waypoint"), episodes=16, seed=1000, robots=8) for _ in range(2))
    assert all(played.reached and not played.crashed for played in first.episodes)
    assert [played.reward for played in first.episodes] == [played.reward for played in second.episodes]


def test_a_path_that_is_there_comes_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert baselines.find("copter-hover").parent.name == "baselines"
    Path("copter-hover").mkdir()
    assert baselines.find("copter-hover") == Path("copter-hover")


def test_shares_have_wilsons_interval() -> None:
    assert table.share(200, 200) == "100.0 % (98.1 .. 100.0)"
    assert table.share(50, 100) == "50.0 % (40.4 .. 59.6)"
