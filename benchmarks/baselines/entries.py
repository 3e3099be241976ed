# SPDX-License-Identifier: BSD-3-Clause
"""Baselines by name: the recipe of each, what it is evaluated in, and the keys of its results."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from functools import cache

from sitl.agents import baselines, recipes
from sitl.agents.named_policies import RANDOM
from sitl.agents.recipes import Recipe
from sitl.agents.runs.config import RunConfig
from sitl.envs.ids import TASKS

from .conditions import SEED, named
from .records import digest

ROBUST = "-robust"
"""Ends the names of recipes that train in randomised conditions; results of the plain one stand beside theirs."""


@dataclass(frozen=True)
class Entry:
    """A baseline."""

    name: str
    recipe: Recipe
    env: str
    """Id of the environment."""
    plain: str
    """Its own name, or of a variant that of what it is a variant of."""
    steps: int | None = None
    """Steps of a training, in place of the recipe's: for trials."""

    @property
    def is_variant(self) -> bool:
        """Whether it is trained in other conditions than its id has."""
        return self.name != self.plain

    def training(self, seed: int) -> RunConfig:
        """The run that trains it."""
        return self.recipe.config(seed, env=self.env, steps=self.steps)

    def playing(self) -> RunConfig:
        """The run whose environment it is evaluated in: the plain recipe's."""
        return _playing(self.plain)

    def training_key(self, seed: int, env_digest: str) -> str:
        """Key of the result of a training."""
        recipe = self.recipe
        plan = recipe.evaluation
        parts = (
            self.env, recipe.algorithm, dict(recipe.options), dict(recipe.settings), recipe.max_steps,
            recipe.episodes, self.steps or recipe.steps, dict(plan.options), plan.max_steps,
            *([asdict(stage) for stage in recipe.curriculum],) * bool(recipe.curriculum),
        )  # fmt: skip
        return digest("training", parts, env_digest, seed)

    def playing_key(self, seed: int | str, what: str, env_digest: str) -> str:
        """Key of an evaluation of a training, or of the random policy (seed "random")."""
        condition = named(what)
        of = RANDOM if isinstance(seed, str) else self.training_key(seed, env_digest)
        played = (self.env, dict(self.playing().env_options), condition.described(), condition.episodes, SEED)
        return digest("episodes", of, played, env_digest)


@cache
def _playing(plain: str) -> RunConfig:
    recipe, env = baselines.recipe_of(plain)
    options = {**recipe.options, **recipe.evaluation.options}
    return RunConfig(env, recipe.algorithm, options, steps=1, max_steps=recipe.max_steps)


def names() -> tuple[str, ...]:
    """All baselines: one for each id of a task, then the variants."""
    plain = [preset + form for preset in TASKS for form in ("", baselines.DISCRETE)]
    return (*sorted(plain), *(name for name in recipes.names() if name.endswith(ROBUST)))


def plain_of(name: str) -> str:
    """The baseline that a name is a variant of; else the name itself."""
    return name.removesuffix(ROBUST)


@cache
def load(name: str, steps: int | None = None) -> Entry:
    """A baseline by its name.

    Raises:
        AgentError: there is no such recipe.
    """
    recipe, env = baselines.recipe_of(name)
    return Entry(name, recipe, env, plain_of(name), steps)
