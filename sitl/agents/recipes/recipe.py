# SPDX-License-Identifier: BSD-3-Clause
"""Recipes: what they hold, their files, and the runs that they want."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from sitl.core import code_in_files, documents
from sitl.errors import MissingExtra, did_you_mean

from .. import algorithms, environments
from ..errors import AgentError
from ..runs import folder as folders
from ..runs.config import MAX_STEPS, RunConfig, code_of, versions
from ..runs.curriculum import Stage, stages_of
from ..runs.evaluation_plan import EvaluationPlan
from ..runs.folder import RunFolder


@dataclass(frozen=True)
class Recipe:
    """A run without its seed.

    Raises:
        AgentError: no such algorithm, or a length that cannot be.
    """

    name: str
    """File name without the ending."""
    env: str
    """Id of the environment."""
    algorithm: str
    summary: str = ""
    """One line for reports and lists."""
    also: Sequence[str] = ()
    """Ids of further environments that it is good for."""
    episodes: int | None = None
    steps: int | None = None
    """Length of a run; both None: the algorithm's default."""
    max_steps: int = MAX_STEPS
    """Longest episode [steps]."""
    options: Mapping[str, Any] = field(default_factory=dict)
    """Options of the environment."""
    settings: Mapping[str, Any] = field(default_factory=dict)
    """Settings of the algorithm; the others have their defaults."""
    evaluation: EvaluationPlan = field(default_factory=EvaluationPlan)
    curriculum: Sequence[Stage] = ()
    """Worlds that follow on those of the options."""

    def __post_init__(self) -> None:
        module = algorithms.load(self.algorithm)
        length = self._length(module)
        RunConfig(self.env, self.algorithm, max_steps=self.max_steps, versions={}, **length)

    def _length(self, module: algorithms.Algorithm) -> dict[str, Any]:
        if self.episodes is None and self.steps is None:
            return {"episodes": None, "steps": None, **module.LENGTH}
        return {"episodes": self.episodes, "steps": self.steps}

    def config(
        self,
        seed: int = 0,
        episodes: int | None = None,
        steps: int | None = None,
        max_steps: int | None = None,
        options: Mapping[str, Any] | None = None,
        settings: Mapping[str, Any] | None = None,
        env: str | None = None,
    ) -> RunConfig:
        """A run by this recipe; what is given replaces what the recipe says, options and settings one by one.

        Raises:
            AgentError: a setting that the algorithm does not have or that cannot be, or another environment
                than the recipe's.
            MissingExtra: the algorithm needs what is not installed.
        """
        if env not in (None, self.env, *self.also):
            known = " or ".join((self.env, *self.also))
            raise AgentError(
                f"recipe {self.name} learns in {known}, not {env}; leave ENV out, or train without --recipe"
            )
        module = algorithms.load(self.algorithm)
        try:
            module.settings(self.algorithm, self.settings)
        except AgentError as error:
            raise AgentError(f"recipe {self.name}: {error}") from None
        length: dict[str, Any] = {"episodes": episodes, "steps": steps}
        if episodes is None and steps is None:
            length = self._length(module)
        return RunConfig(
            env=env or self.env,
            algorithm=self.algorithm,
            env_options={**self.options, **(options or {})},
            settings=module.settings(self.algorithm, {**self.settings, **(settings or {})}),
            seed=seed,
            max_steps=max_steps or self.max_steps,
            versions=versions(*module.LIBRARIES),
            evaluation=self.evaluation,
            curriculum=self.curriculum,
            **length,
        )


KEYS: dict[str, tuple[type, str]] = {
    "summary": (str, "text"),
    "env": (str, "text"),
    "algorithm": (str, "text"),
    "also": (list, "a list of ids"),
    "episodes": (int, "a whole number"),
    "steps": (int, "a whole number"),
    "max_steps": (int, "a whole number"),
    "options": (dict, "a table"),
    "settings": (dict, "a table"),
    "evaluation": (dict, "a table"),
    "curriculum": (list, "a list of tables"),
}
"""Key -> type of its value, and what that is called."""
_REQUIRED = ("env", "algorithm")


def read(path: Path) -> Recipe:
    """The recipe in a file.

    Raises:
        AgentError: there is none, or it cannot be used; the message names file, key and value.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise AgentError(f"there is no recipe {path}") from None
    except (OSError, ValueError) as error:
        raise AgentError(f"recipe {path} cannot be read: {error}") from None
    try:
        return _recipe(path.stem, documents.toml(text))
    except (tomllib.TOMLDecodeError, AgentError) as error:
        raise AgentError(f"recipe {path}: {error}") from None


def _recipe(name: str, values: dict[str, Any]) -> Recipe:
    for key, value in values.items():
        if key not in KEYS:
            hint = did_you_mean(key, KEYS)
            raise AgentError(
                f"key {key!r} is not known; it is one of {', '.join(KEYS)}{hint} (settings of the algorithm stand "
                "under [settings], options of the environment under [options])"
            )
        kind, called = KEYS[key]
        if not isinstance(value, kind) or isinstance(value, bool):
            raise AgentError(f"{key} = {value!r}; it must be {called}")
        try:
            json.dumps(value)
        except TypeError:
            raise AgentError(f"{key} has a date or a time, which no option or setting takes") from None
    for key in _REQUIRED:
        if key not in values:
            raise AgentError(f"key {key!r} is missing")
    plan, stages = EvaluationPlan.of(values.pop("evaluation", {})), stages_of(values.pop("curriculum", []))
    refused = code_in_files.refusal("it", _code(values, plan, stages))
    if refused is not None:
        raise AgentError(refused)
    return Recipe(name=name, evaluation=plan, curriculum=stages, **values)


def _code(values: dict[str, Any], plan: EvaluationPlan, stages: Sequence[Stage]) -> list[str]:
    """What of a recipe runs code of others; raises AgentError when ``also`` holds no ids."""
    also = values.get("also", [])
    if not all(isinstance(name, str) for name in also):
        raise AgentError(f"also = {also!r}; it must be a list of ids")
    return [
        *code_of(values["env"], values.get("options", {}), plan.options, *({"world": s.world} for s in stages)),
        *(code for n in also for code in code_of(n)),
    ]


_FOLDER = Path(__file__).parent


def names() -> tuple[str, ...]:
    """Names of the recipes that come with the program."""
    return tuple(sorted(path.stem for path in _FOLDER.glob("*.toml")))


def load(name: str | Path) -> Recipe:
    """A recipe by its name, or by the path of a .toml file.

    Raises:
        AgentError: no recipe of that name (the message lists those there are), or the file cannot be used.
    """
    if isinstance(name, Path) or name.endswith(".toml"):
        return read(Path(name))
    known = names()
    if name not in known:
        hint = did_you_mean(name, known)
        raise AgentError(f"recipe {name!r} is not known; it is a .toml file or one of {', '.join(known)}{hint}")
    return read(_FOLDER / f"{name}.toml")


def check_all(recipes: Sequence[Recipe], seeds: int) -> None:
    """Check that all recipes can be trained, before any training starts.

    Raises:
        MissingExtra: some need what is not installed; the message says which do not.
        AgentError: a recipe that cannot be used, or two of one name.
    """
    chosen = [recipe.name for recipe in recipes]
    for name in chosen:
        if chosen.count(name) > 1:
            raise AgentError(f"there are two recipes {name!r}; each needs a folder of its own")
    missing: dict[str, MissingExtra] = {}
    for recipe in recipes:
        try:
            config = recipe.config(seeds - 1)
            try:
                environments.try_all([config])
            except AgentError as error:
                raise AgentError(f"recipe {recipe.name}: {error}") from None
        except MissingExtra as error:
            missing[recipe.name] = error
    if missing:
        rest = [name for name in chosen if name not in missing]
        hint = f"; without: --only {' '.join(rest)}" if rest else ""
        raise MissingExtra(f"recipes {', '.join(missing)}: {next(iter(missing.values()))}{hint}")


def runs_of(out: Path, recipe: Recipe, seeds: int) -> list[RunFolder]:
    """The runs of a recipe, made where they are not there yet, and at least as long as it says.

    Raises:
        AgentError: there are other runs in their place.
    """
    root = out / "runs" / recipe.name
    return [RunFolder.ensure(folders.seed_folder(root, seed), recipe.config(seed)) for seed in range(seeds)]
