# SPDX-License-Identifier: BSD-3-Clause
"""Trained policies that come with the package, for flight and driving tasks. The recipe of the same name trains each.

"NAME-discrete" is for the environment with discrete actions. If there is no recipe of that name, the recipe NAME
trained it, and lists the discrete id, too.
"""

from __future__ import annotations

from pathlib import Path

from sitl.envs.ids import task_of

from .. import recipes

_FOLDER = Path(__file__).parent
DISCRETE = "-discrete"


def names() -> tuple[str, ...]:
    """Their names."""
    return tuple(sorted(path.stem for path in _FOLDER.glob("*.npz")))


def find(text: str) -> Path:
    """Where a policy is: that of a shipped one's name, or the path itself; a path that is there comes first."""
    path = Path(text)
    return file(text) if not path.exists() and text in names() else path


def file(name: str) -> Path:
    """Where the policy of a name is kept."""
    return _FOLDER / f"{name}.npz"


def of_preset(preset: str) -> str:
    """What the policy of an environment is called, by the environment's preset (``sitl.envs.ids``), of any version."""
    task = task_of(preset)
    return task + DISCRETE if f"{task}{DISCRETE.removeprefix('-')}" in preset else task


def recipe_of(name: str) -> tuple[recipes.Recipe, str]:
    """The recipe that a policy of this name is learnt by, and the id of its environment.

    Raises:
        AgentError: there is no such recipe.
    """
    own = name in recipes.names()
    recipe = recipes.load(name if own else name.removesuffix(DISCRETE))
    return recipe, recipe.env if own or not name.endswith(DISCRETE) else recipe.also[0]
