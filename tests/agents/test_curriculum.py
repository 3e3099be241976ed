# SPDX-License-Identifier: BSD-3-Clause
"""Runs that learn in one world after the other."""

from __future__ import annotations

import json
from types import SimpleNamespace

import pytest

from sitl.agents import environments, recipes
from sitl.agents.errors import AgentError
from sitl.agents.recipes.recipe import read
from sitl.agents.runs.config import RunConfig
from sitl.agents.runs.curriculum import Curriculum, Stage, stages_of
from sitl.agents.runs.folder import RunFolder
from sitl.agents.runs.training import train_one
from sitl.envs.vector import NavigateVector

RECIPE = """
env = "sitl/RoverParking-v1"
algorithm = "ppo"
steps = 400
max_steps = 25
[options]
world = "car_park:seed=1..3"
[[curriculum]]
after = 100
world = "car_park:seed=11..13"
[[curriculum]]
after = 250
world = ["car_park:seed=21", "car_park:seed=22..23"]
"""
STAGES = (Stage(100, "car_park:seed=11..13"), Stage(250, ("car_park:seed=21", "car_park:seed=22..23")))


def written(tmp_path, text=RECIPE):
    path = tmp_path / "parking.toml"
    path.write_text(text)
    return path


def test_a_recipe_has_it_and_a_run_keeps_it(tmp_path):
    found = read(written(tmp_path)).curriculum
    assert found == STAGES
    config, path = RunConfig("sitl/RoverParking-v1", "ppo", curriculum=found), tmp_path / "config.json"
    config.save(path)
    assert RunConfig.load(path) == config
    values = json.loads(path.read_text())
    del values["curriculum"]
    path.write_text(json.dumps(values))
    old = RunConfig.load(path)
    assert old.curriculum == () and old.differences(config) == ["curriculum"]


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("after = 250", "after = 100", "after = 100 follows after = 100; each stage must begin later"),
        ("after = 100", "after = 0", "after = 0; it must be a whole number of steps from 1 on"),
        ("after = 100", "after = true", "after = True; it must be a whole number"),
        ("after = 100", "from = 100", "curriculum: key 'from' is not known"),
        ("after = 100\n", "", "key 'after' is missing in"),
        ('world = "car_park:seed=11..13"', "world = 11", "world = 11; it must be a text, or a list of texts"),
        ('world = "car_park:seed=11..13"', "world = []", "it must be a text, or a list"),
        ('world = "car_park:seed=11..13"', 'world = "rooms.py"', r"rooms\.py"),
    ],
)
def test_what_cannot_be_is_refused_with_the_key(tmp_path, old, new, says):
    with pytest.raises(AgentError, match=says):
        read(written(tmp_path, RECIPE.replace(old, new)))


def test_a_stage_is_a_table(tmp_path):
    with pytest.raises(AgentError, match="each stage must be a table of after and world"):
        stages_of([100])
    with pytest.raises(AgentError, match="curriculum = 'rooms'; it must be a list of tables"):
        stages_of("rooms")


def test_each_stage_is_begun_once_and_stages_that_are_over_are_left_out():
    seen = []
    env = SimpleNamespace(unwrapped=SimpleNamespace(set_worlds=seen.append))
    curriculum = Curriculum(STAGES, env)
    for steps in (0, 99, 100, 101, 249):
        curriculum.follow(steps)
    assert seen == [STAGES[0].world]
    curriculum.follow(251)
    assert seen == [STAGES[0].world, STAGES[1].world]
    Curriculum(STAGES, env).follow(300)  # a run that is gone on with
    assert seen == [STAGES[0].world, STAGES[1].world, STAGES[1].world]


def test_an_environment_that_stays_in_its_world_is_refused():
    with pytest.raises(AgentError, match="has no set_worlds"):
        Curriculum(STAGES, SimpleNamespace(unwrapped=object()))
    Curriculum((), SimpleNamespace(unwrapped=object())).follow(10)


def test_worlds_that_a_stage_cannot_have_are_refused_before_anything_is_learnt(tmp_path):
    pytest.importorskip("stable_baselines3", reason="deep agents need the extra 'rl'")
    for world, says in (("car_park:seed=1,depth=2", "depth"), ("forest", "forest")):
        config = read(written(tmp_path, RECIPE.replace("car_park:seed=11..13", world))).config()
        with pytest.raises(AgentError, match=says):
            environments.try_all([config])


def test_a_run_learns_in_the_worlds_of_its_stages_and_repeats_when_it_is_broken_off(tmp_path, monkeypatch):
    pytest.importorskip("stable_baselines3", reason="deep agents need the extra 'rl'")
    from sitl.agents.deep import training
    from sitl.agents.runs.watch import Watch
    from tests.agents.deep_runs import weights

    entered: list[tuple[int, str]] = []
    original = NavigateVector.set_worlds

    def watched(self, world):
        entered.append((len(seen), str(world)))
        original(self, world)

    monkeypatch.setattr(NavigateVector, "set_worlds", watched)
    small = {"robots": 2, "width": 8, "batch": 16, "rollout": 16, "epochs": 1, "sectors": 8, "check_every": 0}
    config = read(written(tmp_path)).config(settings=small)
    seen: list[object] = []
    whole, parts = (RunFolder.create(tmp_path / name, config) for name in ("whole", "parts"))
    assert train_one(whole.path, lambda rows: None, lambda: False)
    assert [world for _, world in entered] == [str(stage.world) for stage in STAGES]
    entered.clear()
    training.train(parts, Watch(seen.extend, lambda: len(seen) >= 7))
    begun = len(seen)
    training.train(RunFolder(parts.path), Watch(seen.extend, lambda: False))
    assert 7 <= begun < len(seen)
    assert [world for _, world in entered] == [str(STAGES[k].world) for k in (0, 0, 1)]
    assert weights(parts) == weights(whole)
    assert [row[:3] for row in parts.episodes.rows()] == [row[:3] for row in whole.episodes.rows()]


def test_recipes_of_the_package_with_stages_end_in_the_worlds_of_their_evaluation():
    for recipe in map(recipes.load, recipes.names()):
        if recipe.curriculum:
            assert recipe.curriculum[-1].after < (recipe.steps or 0), recipe.name
            assert recipe.curriculum[-1].world == recipe.evaluation.options["world"], recipe.name
